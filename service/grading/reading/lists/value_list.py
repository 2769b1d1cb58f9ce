"""Read a list of values, from JSON or pasted text, as entries and their numbers."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Final

from service.expressions import LIMITS, Expression, Kind, LeftSide
from service.grading.feedback import Finding, UnreadableAnswerError, reading_error, reading_note
from service.grading.reading.entry import MISSING, Entry, Reader, entry_values, unreadable
from service.grading.reading.lists.component_names import ListNames
from service.grading.reading.pasted import from_grid_error, pasted_grid, placed
from service.grading.reading.unit_comments import refuse_other_lengths
from service.grading.reading.written_names import arranged, name_of, with_order_note
from service.grids import FULL_WIDTH, GridCell, GridError
from service.kinematics.transforms import Numbers
from service.regex import regex
from service.translations import paragraph, say


@dataclass(frozen=True, slots=True)
class StudentValues:
    """A list as read: n entries, and their numbers ``(n, SAMPLES)``, NaN if unreadable."""

    entries: list[Entry]
    quantities: Sequence[Kind]
    values: Numbers

    @property
    def expressions(self) -> list[Expression | None]:
        """The expressions of the values; None for a value that could not be read."""
        return [entry.expression for entry in self.entries]


# Figures that may follow the expected values: the third coordinate of a point in the plane, or the
# 1 of homogeneous coordinates.
Tail = tuple[str, ...]
PLANAR: Final[Tail] = ("0",)
HOMOGENEOUS: Final[Tail] = ("1",)


def read_list(
    answer: object, names: ListNames, reader: Reader, tails: Sequence[Tail] = ()
) -> StudentValues:
    """Read a list of values, one for each of the expected ``names``.

    Values with names are sorted: ``y = 2, x = 1`` is read as x = 1, y = 2. Raises
    UnreadableAnswerError if there is no list of the expected length.
    """
    # One of the ``tails`` may follow the values, as in [x, y, 0].
    # A list may also be a column (a list of lists with one value each), a row within a list, or
    # pasted text. Omitted values at the end are missing. A value with the name of another place is
    # unreadable. A tail is ignored, with a note.
    if isinstance(answer, dict):
        answer = _by_keys(answer, names, reader)
    if isinstance(answer, str):
        # All replacements keep the length, so that spans stay valid.
        answer = _NAME_WITH_COLON.sub(r"\1=", answer.translate(FULL_WIDTH))
        answer = _as_written_out(answer)
        entries = _pasted(_in_round_brackets(answer), names, reader, tails)
    else:
        entries = _listed(answer, names, reader, tails)
    quantities = names.quantities
    return StudentValues(entries, quantities, entry_values(entries, quantities, reader.samples))


def _by_keys(answer: Mapping[str, object], names: ListNames, reader: Reader) -> list[object]:
    # Each key must mean exactly one place, and no two keys the same place.
    count = len(names.quantities)
    if not 0 < len(answer) <= count:
        raise UnreadableAnswerError(_wrong_shape(count, 0))
    keys = [LeftSide(key[: LIMITS.characters], (0, 0)) for key in answer]
    values: list[object] = [None] * count
    taken: set[int] = set()
    for places, value in zip(
        names.places_of(keys, reader.vocabulary), answer.values(), strict=True
    ):
        if places is None or len(places) != 1 or places[0] in taken:
            raise UnreadableAnswerError(_wrong_shape(count, 0))
        values[places[0]] = value
        taken.add(places[0])
    return values


# A value to be read, and a function that moves the spans of its entry to the whole pasted text.
_Written = tuple[object, Callable[[Entry], Entry]]


def _read(written: Sequence[_Written], names: ListNames, reader: Reader) -> list[Entry]:
    quantities = names.quantities
    written = [*written, *[_LEFT_OFF] * (len(quantities) - len(written))]
    raws = [raw for raw, _ in written]
    found = arranged(raws, names.labels, names.places_of, reader.vocabulary)
    if found is None:
        return [
            place(reader.read(raw, quantity))
            for (raw, place), quantity in zip(written, quantities, strict=True)
        ]
    entries = []
    for i, quantity in zip(found.order, quantities, strict=True):
        raw, place = written[i]
        wrong = found.misnamed.get(i)
        entries.append(place(unreadable(wrong) if wrong else reader.read(raw, quantity)))
    if found.misnamed:
        return entries
    return [*with_order_note(entries, say("The values were ordered by their names."))]


def _as_it_is(entry: Entry) -> Entry:
    return entry


_LEFT_OFF: _Written = (None, _as_it_is)


def _listed(answer: object, names: ListNames, reader: Reader, tails: Sequence[Tail]) -> list[Entry]:
    count = len(names.quantities)
    values = [answer] if count == 1 and not isinstance(answer, list) else _flat(answer)
    left_aside = _left_aside(values, count, reader, tails)
    values = values[: len(values) - len(left_aside)]
    is_nested = all(isinstance(value, list) for value in values)
    if is_nested or len(values) > count:
        raise UnreadableAnswerError(_wrong_shape(count, 0 if is_nested else len(values)))
    entries = _read([(raw, _as_it_is) for raw in values], names, reader)
    return _with_notes(entries, [(figure, None) for figure in left_aside])


def _left_aside(
    values: Sequence[object], count: int, reader: Reader, tails: Sequence[Tail]
) -> Tail:
    following = values[count:]
    for tail in tails:
        if len(tail) == len(following) and all(map(partial(_is_figure, reader), following, tail)):
            return tail
    return ()


def _is_figure(reader: Reader, raw: object, figure: str) -> bool:
    # A 0 may have a name, as in z = 0.
    if isinstance(raw, str):
        plain = _LATEX_BLANK.sub("", raw)
        name = name_of(plain, reader.vocabulary) if figure == "0" else None
        return (plain[name.span[1] :] if name else plain).strip() == figure
    return isinstance(raw, int | float) and not isinstance(raw, bool) and raw == int(figure)


def _with_notes(
    entries: Sequence[Entry], left_aside: Sequence[tuple[str, tuple[int, int] | None]]
) -> list[Entry]:
    *before, last = entries
    notes = [replace(_LEFT_ASIDE[figure], span=span) for figure, span in left_aside]
    return [*before, replace(last, findings=(*last.findings, *notes))]


def _flat(answer: object) -> list[object]:
    if not isinstance(answer, list):
        return []
    if len(answer) == 1 and isinstance(answer[0], list):
        return answer[0]
    if all(isinstance(value, list) and len(value) == 1 for value in answer):
        return [value[0] for value in answer]
    return answer


def _in_round_brackets(text: str) -> str:
    # <l1 c1, l1 s1> becomes (l1 c1, l1 s1); no character moves.
    found = _IN_ANGLE_BRACKETS.fullmatch(text)
    if not found:
        return text
    pieces = ("(".ljust(len(found[2])), found[3], ")".rjust(len(found[4])))
    return f"{found[1]}{''.join(pieces)}{found[5]}"


def _as_written_out(text: str) -> str:
    # A transposed list is the same list. Removed text becomes blanks, so that spans stay valid.
    for pattern in (_FENCE, _FENCE_AFTER):
        text = pattern.sub(lambda found: _LETTER.sub(" ", found[0]), text, count=1)
    raised = _TRANSPOSED.search(text, max(0, len(text) - _LONGEST_END))
    plain = f"{text[: raised.start()]:{len(text)}}" if raised else text
    name = _NAME_BEFORE.match(plain)
    bare = f"{'':{name.end()}}{plain[name.end() :]}" if name else plain
    start, end = _inside(bare)
    bracket = bare[start - 1 : start]
    if bracket == "[" and not bare[end + 1 :].strip():
        return plain
    if bracket in {"(", "{"} and len([*_split(bare, ";")]) > 1:
        return f"{'':{start}}{bare[start:end]:{len(bare) - start}}"
    if bracket in {"(", "{"} and len([*_split(bare, ",")]) > 1:
        return bare
    return plain if raised and plain.count("\\begin") == 1 else text


def _pasted(text: str, names: ListNames, reader: Reader, tails: Sequence[Tail]) -> list[Entry]:
    count = len(names.quantities)
    if not text.strip():
        return [MISSING] * count
    try:
        refuse_other_lengths(text, names.quantities, reader)
        rows = pasted_grid(text, reader).rows
    except GridError as error:
        entries = None
        if error.code in _OF_TABLES:
            entries = _split_values(text, names, reader, tails)
        if entries is None:
            raise UnreadableAnswerError(_from_grid_error(error, count)) from error
        return entries
    cells: Sequence[GridCell] = rows[0] if len(rows) == 1 else [row[0] for row in rows]
    is_list = len(rows) == 1 or all(len(row) == 1 for row in rows)
    left_aside = _left_aside([cell.text for cell in cells], count, reader, tails)
    if not is_list or len(cells) > count + len(left_aside):
        entries = None if is_list else _split_values(text, names, reader, tails)
        if entries is None:
            raise UnreadableAnswerError(_wrong_shape(count, len(cells) if is_list else 0))
        return entries
    written = [(cell.text, partial(placed, cell=cell)) for cell in cells[:count]]
    entries = _read(written, names, reader)
    places = [cell.whole for cell in cells[count:]]
    return _with_notes(entries, [*zip(left_aside, places, strict=True)])


def _split_values(
    text: str, names: ListNames, reader: Reader, tails: Sequence[Tail]
) -> list[Entry] | None:
    # None if the number of values is not the expected number, or if no value can be read.
    count = len(names.quantities)
    for pieces in (_lines(text), _split(text, ";"), _split(text, ",")):
        parts = [_stripped(at, piece) for at, piece in pieces if piece.strip()]
        left_aside = _left_aside([part for _, part in parts], count, reader, tails)
        if len(parts) != count + len(left_aside):
            continue
        written = [(part, partial(_shifted, by=at)) for at, part in parts[:count]]
        entries = _read(written, names, reader)
        if any(entry.readable or entry.findings[0].suggestion for entry in entries):
            places = [(at, at + len(part)) for at, part in parts[count:]]
            return _with_notes(entries, [*zip(left_aside, places, strict=True)])
    return None


def _stripped(at: int, piece: str) -> tuple[int, str]:
    return at + len(piece) - len(piece.lstrip()), piece.strip()


def _lines(text: str) -> Iterator[tuple[int, str]]:
    at = 0
    for line in text.splitlines(keepends=True):
        yield at, line.rstrip("\r\n")
        at += len(line)


def _split(text: str, separator: str) -> Iterator[tuple[int, str]]:
    # Yield nothing for a text such as [c1 -s1, 0], which has three values in MATLAB.
    start, end = _inside(text)
    if text[:start].strip() == "[" and _NEW_VALUE.search(text):
        return
    depth, begin = 0, start
    for at in range(start, end):
        depth += (text[at] in "([{") - (text[at] in ")]}")
        if text[at] == separator and not depth:
            yield begin, text[begin:at]
            begin = at + 1
    yield begin, text[begin:end]


def _inside(text: str) -> tuple[int, int]:
    # The [start, end) of the text without the brackets around all of it.
    start, end = len(text) - len(text.lstrip()), len(text.rstrip())
    depth = 0
    for at in range(start, end):
        depth += (text[at] in "([{") - (text[at] in ")]}")
        if not depth:
            return (start + 1, end - 1) if at == end - 1 and at > start else (start, end)
    return start, end


def _shifted(entry: Entry, by: int) -> Entry:
    findings = tuple(
        replace(finding, span=(finding.span[0] + by, finding.span[1] + by))
        if finding.span
        else finding
        for finding in entry.findings
    )
    return replace(entry, findings=findings)


# The lines of a code fence around a text.
_FENCE = regex(r"\A\s*(?:```|~~~)[\w+-]{0,20}[ \t]*\n(?=[\s\S]*(?:```|~~~)\s*\Z)")
_FENCE_AFTER = regex(r"(?<=\n)[ \t]*(?:```|~~~)\s*\Z")
_LETTER = regex(r"\S")
# The sign of a transpose after a bracket, at the end of a text.
_TRANSPOSED = regex(
    r"(?:(?<=[\])])|(?<=matrix\})|(?<=array\}))"
    r"(?:\s?\^\s?\{?\s?(?:T|\\top|⊤|\\intercal)\s?\}?|[ᵀ⊤]|\.?'|\.T)\s{0,8}[;.]?\s{0,8}\Z"
)
_LONGEST_END = 40
# The name of a vector before its bracket: p = (…).
_NAME_BEFORE = regex(r"\s*[^\W\d][\w{}^,]{0,20}[ \t]{0,3}:?=[ \t]{0,3}(?=[(\[{])")

# A name and a colon at the start of a line: "x: l1 c1".
_NAME_WITH_COLON = regex(r"(?m)^([ \t]*[^\W\d][\w{}^]{0,20}[ \t]{0,3}):(?![:=])")

# A vector in angle brackets. Groups: blanks, opening bracket, values, closing bracket, blanks.
_IN_ANGLE_BRACKETS = regex(
    r"(\s*)(<|⟨|\\langle(?![A-Za-z]))([^<>⟨⟩|]+)(>|⟩|\\rangle(?![A-Za-z]))(\s*)"
)

_LATEX_BLANK = regex(r"\\(?:q?quad(?![A-Za-z])|[,;:! ])")

# A blank and a sign directly before a value: in MATLAB's brackets a new value begins there.
_NEW_VALUE = regex(r"[^\s,;(\[{*/^+-]\s+[-+−–][^\s]")

# The codes of errors whose messages are about tables, and the sentence for a list instead.
_OF_TABLES = {
    "no_grid": "",
    "named_values": "",
    "too_many_rows": "",
    "too_many_columns": "",
    "ambiguous_separators": "",
    "ambiguous_columns": say("Here a space may separate two values or stand inside one."),
    "mixed_separators": say("Inside a value, write a*b and a - b, not a b and a -b."),
}

_LEFT_ASIDE = {
    "0": reading_note(
        "zero_left_aside", say("Only two values are asked for; the third, 0, was ignored.")
    ),
    "1": reading_note(
        "homogeneous_one", say("The 1 at the end, of homogeneous coordinates, was ignored.")
    ),
}


def _wrong_shape(count: int, found: int) -> Finding:
    # ``found`` is the number of values if there are too many, else 0.
    message = say("Write a list of {number} values.", number=count)
    if count == 1:
        message = say("Write one number or one formula here.")
    elif found:
        message = say(
            "Write a list of {number} values; yours has {found}.", number=count, found=found
        )
    return reading_error("wrong_shape", message)


def _from_grid_error(error: GridError, count: int) -> Finding:
    finding = from_grid_error(error)
    if error.code not in _OF_TABLES:
        return finding
    if count == 1:
        return _wrong_shape(count, 0)
    message = say(
        "Write a list of {number} values, with commas between them or one on each line.",
        number=count,
    )
    return replace(finding, hint=paragraph(message, _OF_TABLES[error.code]))
