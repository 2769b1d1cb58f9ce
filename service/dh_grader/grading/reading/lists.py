"""Read lists of values, with or without names, and of frames on joint axes; JSON or pasted text.

This file knows which place of a list a name means. How a single value is read is in ``entries.py``;
whether it is right is not known here.
"""

import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial
from typing import Final

import numpy as np

from dh_grader.catalogue.kinds import FRAME_CELLS
from dh_grader.expressions import LIMITS, Expression, Kind, LeftSide, Symbol, Vocabulary, characters
from dh_grader.expressions.vocabulary import normal_form
from dh_grader.grading.numbers import Samples
from dh_grader.grading.reading.entries import (
    MISSING,
    Entry,
    Places,
    Reader,
    arranged,
    entry_values,
    from_grid_error,
    name_of,
    pasted_grid,
    placed,
    refuse_other_lengths,
    unreadable,
    with_order_note,
)
from dh_grader.grading.report import (
    Finding,
    UnreadableAnswerError,
    Verdict,
    reading_error,
    reading_note,
)
from dh_grader.kinematics import Numbers
from dh_grader.pasting import FULL_WIDTH, GridCell, GridError
from dh_grader.regex import regex
from dh_grader.translations import paragraph, say

# --- Read a list of values, from JSON or pasted text, as entries and their numbers


@dataclass(frozen=True, slots=True)
class ListNames:
    """The names that the values of a list may have.

    ``labels`` are the expected names and ``quantities`` the expected quantities, in order.
    ``places`` maps the plain form of each name to places; ``coordinates`` maps x, y and z to
    places.
    """

    labels: tuple[str, ...]
    quantities: tuple[Kind, ...]
    places: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    coordinates: Mapping[str, tuple[int, ...]] = field(default_factory=dict)

    def places_of(self, names: Sequence[LeftSide | None], vocabulary: Vocabulary) -> list[Places]:
        """Return the places in the list that each name may mean; None if a name means no place."""
        words = [_words(name.name) if name else [] for name in names]
        letters = [letter for each in words if (letter := _coordinate(each))]
        # x_1 and y_1 are coordinates in frame 1, but x_1 and x_2 are numbered values.
        of_frames = 1 < len(letters) == len(set(letters))
        return [
            self._places(name.name, each, self.quantities[i], vocabulary, of_frames=of_frames)
            if name
            else None
            for i, (name, each) in enumerate(zip(names, words, strict=True))
        ]

    def _places(
        self,
        name: str,
        words: Sequence[str],
        quantity: Kind,
        vocabulary: Vocabulary,
        *,
        of_frames: bool,
    ) -> Places:
        key = "".join(words)
        if key in self.places:
            return self.places[key]
        symbol = _symbol(name, vocabulary)
        if symbol is not None and symbol.name in self.places:
            return self.places[symbol.name]
        letter = _coordinate(words)
        if letter and letter in self.coordinates and (of_frames or not words[-1].isdigit()):
            return self.coordinates[letter]
        return () if symbol is not None and _is_another(symbol, quantity) else None


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
ZERO_TAIL: Final[Tail] = ("0",)
ONE_TAIL: Final[Tail] = ("1",)

# A name and a colon at the start of a line: "x: l1 c1".
_NAME_WITH_COLON = regex(r"(?m)^([ \t]*[^\W\d][\w{}^]{0,20}[ \t]{0,3}):(?![:=])")

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


def read_list(
    answer: object, names: ListNames, reader: Reader, tails: Sequence[Tail] = ()
) -> StudentValues:
    """Read a list of values, one for each of the expected ``names``.

    A list may also be a column (a list of lists with one value each), a row within a list, or
    pasted text. Values with names are sorted: ``y = 2, x = 1`` is read as x = 1, y = 2; a value
    with the name of another place is unreadable. Omitted values at the end are missing. One of the
    ``tails`` may follow the values, as in [x, y, 0]; it is ignored, with a note. Raises
    UnreadableAnswerError if there is no list of the expected length.
    """
    if isinstance(answer, dict):
        answer = _by_keys(answer, names, reader)
    if isinstance(answer, str):
        # All replacements keep the length, so that spans stay valid.
        answer = _NAME_WITH_COLON.sub(r"\1=", answer.translate(FULL_WIDTH))
        answer = _as_written_out(answer)
        entries = _values_in_text(_in_round_brackets(answer), names, reader, tails)
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


def _values_in_text(
    text: str, names: ListNames, reader: Reader, tails: Sequence[Tail]
) -> list[Entry]:
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

# A vector in angle brackets. Groups: blanks, opening bracket, values, closing bracket, blanks.
_IN_ANGLE_BRACKETS = regex(
    r"(\s*)(<|⟨|\\langle(?![A-Za-z]))([^<>⟨⟩|]+)(>|⟩|\\rangle(?![A-Za-z]))(\s*)"
)

_LATEX_BLANK = regex(r"\\(?:q?quad(?![A-Za-z])|[,;:! ])")

# A blank and a sign directly before a value: in MATLAB's brackets a new value begins there.
_NEW_VALUE = regex(r"[^\s,;(\[{*/^+-]\s+[-+−–][^\s]")


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


# --- Find the places in a list that a name such as x, p_y, φ or pitch means


_STYLE: Final = regex(
    r"\\(?:mathrm|mathbf|mathit|mathsf|text|boldsymbol|bm|vec)(?![a-z])|\\begin\{[a-z]+\*?\}"
    r"|\b(?:let|const|var|double|float|auto)\s"
)
# The name of x(q1, q2) is x, without the arguments.
_ARGUMENTS: Final = regex(r"[(\[][^()\[\]]*[^\W\d][^()\[\]]*[)\]]")
_GREEK: Final = regex(f"[{characters.CLASS}]")
_WORD: Final = regex(r"[a-z]+|[0-9]+")
# x, p_x, px, x_e, x_{ee}, but not xy.
_COORDINATE: Final = regex(r"(?:[a-w]|pos)?([xyz])|([xyz])(?:e|ee|ef|eff|end|p|o|n|t|tcp|tip|tool)")
_NO_MARKS: Final = str.maketrans("", "", "{}$*^' ")


@lru_cache(maxsize=256)
def names_of_coordinates(letters: str) -> ListNames:
    """Return the names of a point's coordinates, expected in the order of ``letters``."""
    lengths: tuple[Kind, ...] = tuple("length" for _ in letters)
    return ListNames((*letters,), lengths, coordinates=_by_letter(letters))


@lru_cache(maxsize=256)
def names_of_components(
    components: tuple[tuple[str, Kind], ...], vocabulary: Vocabulary
) -> ListNames:
    """Return the names of a vector's components, each given as (name, quantity)."""
    names = tuple(name for name, _ in components)
    keys: dict[str, list[int]] = {}
    for i, name in enumerate(names):
        symbol = _symbol(name, vocabulary)
        for key in {"".join(_words(name)), symbol.name if symbol else ""} - {""}:
            keys.setdefault(key, []).append(i)
    letters = [_coordinate(_words(name)) for name in names]
    known = [letter for letter in letters if letter]
    # In (v_x, ω_x) x is ambiguous, and a single z is not a point.
    is_point = len(known) > 1 and len(set(known)) == len(known)
    return ListNames(
        names,
        tuple(quantity for _, quantity in components),
        {key: tuple(places) for key, places in keys.items()},
        _by_letter(letters) if is_point else {},
    )


@lru_cache(maxsize=256)
def names_of_angles(turns: str, *, fixed: bool) -> ListNames:
    """Return the names of three angles about the axes ``turns``, which are fixed or moving."""
    # Textbooks differ in the order of α and γ (about fixed axes), of φ and ψ (about three different
    # axes), and of roll and yaw. So each of these names has two possible places.
    is_euler = turns[0] == turns[2]
    inner, outer = (1,), (0, 2)
    places: dict[str, tuple[int, ...]] = {"beta": inner, "theta": inner}
    places |= dict.fromkeys(("alpha", "gamma"), outer) if fixed else {"alpha": (0,), "gamma": (2,)}
    places |= {"phi": (0,), "psi": (2,)} if is_euler else dict.fromkeys(("phi", "psi"), outer)
    if not is_euler:
        about_y = turns.index("Y")
        others = tuple(i for i in range(3) if i != about_y)
        places |= {"pitch": (about_y,), "roll": others, "yaw": others}
    first, second, third = list(turns.lower())
    # Translators: a part of "This is named `phi`, but the first angle, about z, is asked for here".
    labels = (
        say("the first angle, about {axis},", axis=first),
        say("the second angle, about {axis},", axis=second),
        say("the third angle, about {axis},", axis=third),
    )
    coordinates = {} if is_euler else _by_letter(turns.lower())
    return ListNames(labels, ("angle",) * 3, places, coordinates)


def _by_letter(letters: Iterable[str | None]) -> dict[str, tuple[int, ...]]:
    listed = list(letters)
    return {axis: tuple(i for i, each in enumerate(listed) if each == axis) for axis in "xyz"}


def _is_another(symbol: Symbol, quantity: Kind) -> bool:
    # An angle where a length is expected, or vice versa.
    return quantity != "number" and symbol.kind != "number" and symbol.kind != quantity


def _words(name: str) -> list[str]:
    # In small letters, Greek letters spelled out.
    plain = _GREEK.sub(lambda found: f" {characters.NAMES[found[0]]} ", _plain(name)).lower()
    words = _WORD.findall(plain.replace("\\var", "\\"))
    # A leading superscript is a frame: {}^0 p_x.
    return words[1:] if len(words) > 1 and words[0].isdigit() else words


def _plain(name: str) -> str:
    return unicodedata.normalize("NFKC", _ARGUMENTS.sub(" ", _STYLE.sub(" ", name)))


def _symbol(name: str, vocabulary: Vocabulary) -> Symbol | None:
    plain = _plain(name)
    return vocabulary.by_name.get(normal_form(plain.translate(_NO_MARKS)))


def _coordinate(words: Sequence[str]) -> str | None:
    # x for p_x and x_e; None unless there is just one coordinate.
    found = [match[1] or match[2] for word in words if (match := _COORDINATE.fullmatch(word))]
    return found[0] if len(found) == 1 else None


# --- Read a list of frames on joint axes, from JSON or a pasted table
#
# A frame is its joint axis, the direction of z, its origin, and the direction of x. A direction is
# a name such as ``+x`` or ``-z0``, or a vector of any length.


LABEL: Final = "frame"
_BASE_AXES: Final = "xyz"
# x, +x, - x0, -X_0, +x_{0}: a direction of the base frame.
_DIRECTION: Final = regex(r"([+-]?)\s?([xyzXYZ])_?(?:0|\{0\})?")
_JOINT: Final = regex(r"(?:(?:joint|axis|z|j)[ _]?)?([0-9]{1,3})", re.IGNORECASE)
_DIGIT: Final = regex(r"[0-9]")
_MINUS: Final = str.maketrans({"\u2212": "-", "\u2013": "-", "\u2080": "0"})
# A longer text is no name; a longer vector is refused before it is split.
_LONGEST_NAME: Final = 16
_LONGEST_VECTOR: Final = 600


@dataclass(frozen=True, slots=True)
class Direction:
    """A direction as read: the entries of a vector, or the name of a base direction.

    ``name`` is the axis and the sense of a base direction, such as (1, -1) for -y.
    """

    entries: tuple[Entry, ...] = ()
    name: tuple[int, int] | None = None

    @property
    def unread(self) -> Entry | None:
        """The first entry that could not be read, or None."""
        return next((entry for entry in self.entries if not entry.readable), None)

    def values(self, samples: Samples) -> Numbers | None:
        """Return the vector at ``count`` samples, ``(count, 3)``, or None if it was not read."""
        if self.name is not None:
            axis, sense = self.name
            return np.tile(sense * np.eye(3)[axis], (samples.count, 1))
        if self.unread is not None:
            return None
        return entry_values(self.entries, ("number",) * 3, samples).T


# The entry of a name that was read without being a formula.
_READ: Final = Entry(None)


@dataclass(frozen=True, slots=True)
class JointNumber:
    """The number of a joint axis as read.

    ``number`` is None if the cell has no whole number; ``entry`` has the reason.
    """

    number: int | None
    entry: Entry = _READ


@dataclass(frozen=True, slots=True)
class StudentFrame:
    """A frame as read from a student's answer."""

    axis: JointNumber
    z: Direction
    origin: tuple[Entry, Entry, Entry]
    x: Direction

    @property
    def entries(self) -> tuple[Entry, ...]:
        """All entries that were read as formulas."""
        return (*self.z.entries, *self.origin, *self.x.entries)


_NO_FRAME: Final = StudentFrame(
    JointNumber(None, MISSING), Direction((MISSING,)), (MISSING,) * 3, Direction((MISSING,))
)


def read_frames(answer: object, labels: Sequence[str], reader: Reader) -> tuple[StudentFrame, ...]:
    """Read the frames with these labels, in order. Raises UnreadableAnswerError."""
    if isinstance(answer, str):
        return _frames_in_text(answer, labels, reader)
    if isinstance(answer, Mapping):
        answer = answer.get("rows", [answer])
    if not isinstance(answer, list):
        raise UnreadableAnswerError(_WRONG_SHAPE)
    rows = [_cells_of(row) for row in answer]
    named = [
        str(row[LABEL]) if isinstance(row, Mapping) and LABEL in row else None for row in answer
    ]
    found = dict(_numbered(named, labels))
    return tuple(
        _frame(rows[found[label]], reader) if label in found else _NO_FRAME for label in labels
    )


def _numbered(named: Sequence[str | None], labels: Sequence[str]) -> list[tuple[str, int]]:
    # Rows without names are in order.
    if len(named) > len(labels):
        raise UnreadableAnswerError(_TOO_MANY)
    if any(name is None for name in named):
        return list(zip(labels, range(len(named)), strict=False))
    if len(set(named)) < len(named) or not set(named) <= set(labels):
        raise UnreadableAnswerError(_WRONG_LABELS)
    return [(str(name), i) for i, name in enumerate(named)]


def _cells_of(row: object) -> tuple[object, ...]:
    if row is None:
        return (None,) * len(FRAME_CELLS)
    if isinstance(row, Mapping):
        if not row.keys() <= _KEYS:
            raise UnreadableAnswerError(_WRONG_SHAPE)
        origin = row.get("origin", [row.get(name) for name in FRAME_CELLS[2:5]])
        row = [row.get("axis"), row.get("z"), origin, row.get("x")]
    if not isinstance(row, list):
        raise UnreadableAnswerError(_WRONG_SHAPE)
    if len(row) == len(FRAME_CELLS) - 2:
        row = [*row[:2], *_three(row[2]), row[3]]
    if len(row) != len(FRAME_CELLS):
        raise UnreadableAnswerError(_WRONG_SHAPE)
    return tuple(row)


_KEYS: Final = frozenset({LABEL, "origin", *FRAME_CELLS})


def _three(point: object) -> Sequence[object]:
    if isinstance(point, str) and point.strip():
        point = _components(point) or [point]
    if point is None or point == "":
        return [None] * 3
    if not isinstance(point, list) or len(point) != 3:
        raise UnreadableAnswerError(_WRONG_SHAPE)
    return point


def _frames_in_text(text: str, labels: Sequence[str], reader: Reader) -> tuple[StudentFrame, ...]:
    try:
        found = pasted_frames(text, labels, reader)
    except GridError as error:
        raise UnreadableAnswerError(from_grid_error(error)) from error
    return tuple(
        _pasted_frame(found[label], reader) if label in found else _NO_FRAME for label in labels
    )


def pasted_frames(
    text: str, labels: Sequence[str], reader: Reader
) -> Mapping[str, Sequence[GridCell]]:
    """Return the six cells of each frame in a pasted table, by the frame's label.

    Raises GridError or UnreadableAnswerError.
    """
    grid = pasted_grid(text, reader)
    rows = [row for row in grid.rows if not _is_header(row)]
    width = len(FRAME_CELLS)
    if not rows or any(len(row) not in (width, width + 1) for row in rows):
        raise UnreadableAnswerError(_WRONG_TEXT)
    named = [row[0].text.strip(" {}") if len(row) > width else None for row in rows]
    return {label: rows[i][-width:] for label, i in _numbered(named, labels)}


def _is_header(row: Sequence[GridCell]) -> bool:
    return any("axis" in text and not _DIGIT.search(text) for text in (c.text.lower() for c in row))


def _frame(cells: Sequence[object], reader: Reader) -> StudentFrame:
    axis, z, *origin, x = cells
    first, second, third = (reader.read(each, "length") for each in origin)
    return StudentFrame(
        _joint(axis, reader), _direction(z, reader), (first, second, third), _direction(x, reader)
    )


def _pasted_frame(cells: Sequence[GridCell], reader: Reader) -> StudentFrame:
    frame = _frame([cell.text for cell in cells], reader)
    joint, z, *origin, x = cells
    first, second, third = (
        placed(entry, cell) for entry, cell in zip(frame.origin, origin, strict=True)
    )

    def moved(direction: Direction, cell: GridCell) -> Direction:
        entries = (_whole(entry, cell) for entry in direction.entries)
        return replace(direction, entries=tuple(entries))

    axis = replace(frame.axis, entry=_whole(frame.axis.entry, joint))
    return StudentFrame(axis, moved(frame.z, z), (first, second, third), moved(frame.x, x))


def _whole(entry: Entry, cell: GridCell) -> Entry:
    findings = tuple(replace(each, span=cell.whole) for each in entry.findings)
    return replace(entry, findings=findings)


def _joint(raw: object, reader: Reader) -> JointNumber:
    if isinstance(raw, str) and len(raw) <= _LONGEST_NAME:
        if named := _JOINT.fullmatch(raw.strip()):
            return JointNumber(int(named[1]))
    elif isinstance(raw, int) and not isinstance(raw, bool) and abs(raw) < 1000:
        return JointNumber(raw)
    entry = reader.read(raw, "number")
    if entry.expression is None:
        return JointNumber(None, entry)
    return JointNumber(None, unreadable(_NO_JOINT))


def _direction(raw: object, reader: Reader) -> Direction:
    if isinstance(raw, str):
        plain = raw.translate(_MINUS).strip()
        if not plain:
            return Direction((MISSING,))
        named = _DIRECTION.fullmatch(plain) if len(plain) <= _LONGEST_NAME else None
        if named:
            sense = -1 if named[1] == "-" else 1
            return Direction(name=(_BASE_AXES.index(named[2].lower()), sense))
        raw = _components(raw)
    elif raw is None:
        return Direction((MISSING,))
    if not isinstance(raw, list) or len(raw) != 3:
        return Direction((unreadable(_NO_DIRECTION),))
    entries = tuple(reader.read(each, "number") for each in raw)
    return Direction(tuple(_without_span(entry) for entry in entries))


def _without_span(entry: Entry) -> Entry:
    # The spans count from the start of the component, not of the cell.
    findings = tuple(replace(each, span=None, suggestion=None) for each in entry.findings)
    return replace(entry, findings=findings)


def _components(text: str) -> list[object] | None:
    if len(text) > _LONGEST_VECTOR:
        return None
    inner = text.strip()
    if inner[:1] in "[(" and inner[-1:] in "])":
        inner = inner[1:-1]
    parts: list[object] = []
    depth, start = 0, 0
    for i, character in enumerate(inner):
        depth += (character in "([") - (character in ")]")
        if character in ",;" and depth == 0:
            parts.append(inner[start:i])
            start = i + 1
    parts.append(inner[start:])
    return parts if len(parts) == 3 else None


def unread_verdict(entries: Sequence[Entry]) -> Verdict | None:
    """Return the verdict on a cell that could not be read; None if it was read."""
    return next((entry.verdict for entry in entries if not entry.readable), None)


def _reading(message: str) -> Finding:
    return reading_error("wrong_shape", message)


_WRONG_SHAPE: Final = _reading(
    say('One row for each frame is asked for: {{"axis": …, "z": …, "origin": [x, y, z], "x": …}}.')
)
_WRONG_TEXT: Final = _reading(
    say(
        "One row for each frame is asked for: its number, joint axis, z, the three "
        "coordinates of its origin, and x."
    )
)
_TOO_MANY: Final = _reading(say("There are more rows than frames on joint axes."))
_WRONG_LABELS: Final = _reading(say("Each row must have the number of another asked frame."))
_NO_JOINT: Final = _reading(say("Write the number of a joint."))
_NO_DIRECTION: Final = _reading(
    say(
        "Write a direction of the base frame with its sign, or a vector with three "
        "components and commas between them."
    )
)
