"""A list of values as handed in, JSON or pasted text -> its entries and their numbers."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from service.expressions import Expression, Kind
from service.expressions.errors import counted
from service.grading.feedback import Finding, UnreadableAnswerError, reading_error, reading_note
from service.grading.reading.entry import MISSING, Entry, Reader, entry_values
from service.grading.reading.pasted import from_grid_error, pasted_grid, placed
from service.grids import GridCell, GridError
from service.kinematics.transforms import Numbers


@dataclass(frozen=True, slots=True)
class StudentValues:
    """A list of values as read: entries, and numbers ``(n, SAMPLES)``, NaN where there are none."""

    entries: list[Entry]
    quantities: Sequence[Kind]
    values: Numbers

    @property
    def expressions(self) -> list[Expression | None]:
        """The expressions of the values; None where nothing could be read."""
        return [entry.expression for entry in self.entries]


def read_list(
    answer: object, quantities: Sequence[Kind], reader: Reader, *, planar: bool = False
) -> StudentValues:
    """The values of a list, one for each quantity asked for.

    A list may also be a column (a list of lists of one), a row in a list of its own, or pasted
    text. Values that were left off at the end are missing. A ``planar`` answer may have one 0 more,
    as in [x, y, 0]: it is left aside, with a note. Raises UnreadableAnswerError where there is no
    list of the length asked for.
    """
    if isinstance(answer, str):
        entries = _pasted(answer, quantities, reader, planar=planar)
    else:
        entries = _listed(answer, quantities, reader, planar=planar)
    return StudentValues(entries, quantities, entry_values(entries, quantities, reader.samples))


def _listed(
    answer: object, quantities: Sequence[Kind], reader: Reader, *, planar: bool
) -> list[Entry]:
    values = _flat(answer)
    left_aside = planar and len(values) == len(quantities) + 1 and _is_zero(values[-1])
    if left_aside:
        values = values[:-1]
    is_nested = all(isinstance(value, list) for value in values)
    if is_nested or len(values) > len(quantities):
        raise UnreadableAnswerError(_wrong_shape(len(quantities), 0 if is_nested else len(values)))
    padded = [*values, *[None] * (len(quantities) - len(values))]
    entries = [reader.read(raw, quantity) for raw, quantity in zip(padded, quantities, strict=True)]
    return _with_note(entries) if left_aside else entries


def _is_zero(raw: object) -> bool:
    if isinstance(raw, str):
        return raw.strip() == "0"
    return isinstance(raw, int | float) and not isinstance(raw, bool) and raw == 0


def _with_note(entries: Sequence[Entry], span: tuple[int, int] | None = None) -> list[Entry]:
    """The entries with the note on the last of them that a 0 behind it was left aside."""
    *before, last = entries
    note = replace(_ZERO_LEFT_ASIDE, span=span)
    return [*before, replace(last, findings=(*last.findings, note))]


def _flat(answer: object) -> list[object]:
    """The values of a list, of a column or of a single row; none for anything else."""
    if not isinstance(answer, list):
        return []
    if len(answer) == 1 and isinstance(answer[0], list):
        return answer[0]
    if all(isinstance(value, list) and len(value) == 1 for value in answer):
        return [value[0] for value in answer]
    return answer


def _pasted(text: str, quantities: Sequence[Kind], reader: Reader, *, planar: bool) -> list[Entry]:
    if not text.strip():
        return [MISSING] * len(quantities)
    try:
        rows = pasted_grid(text, reader).rows
    except GridError as error:
        entries = None
        if error.code in _OF_TABLES:
            entries = _taken_apart(text, quantities, reader, planar=planar)
        if entries is None:
            raise UnreadableAnswerError(_from_grid_error(error, len(quantities))) from error
        return entries
    cells: Sequence[GridCell] = rows[0] if len(rows) == 1 else [row[0] for row in rows]
    is_list = len(rows) == 1 or all(len(row) == 1 for row in rows)
    left_aside = planar and len(cells) == len(quantities) + 1 and _is_zero(cells[-1].text)
    if not is_list or len(cells) > len(quantities) + left_aside:
        entries = None if is_list else _taken_apart(text, quantities, reader, planar=planar)
        if entries is None:
            found = len(cells) if is_list else 0
            raise UnreadableAnswerError(_wrong_shape(len(quantities), found))
        return entries
    entries = [
        placed(reader.read(cell.text, quantity), cell)
        for cell, quantity in zip(cells, quantities, strict=False)
    ]
    if left_aside:
        return _with_note(entries, cells[-1].whole)
    return entries + [MISSING] * (len(quantities) - len(entries))


def _taken_apart(
    text: str, quantities: Sequence[Kind], reader: Reader, *, planar: bool
) -> list[Entry] | None:
    """The values of a text with one on each line, or with semicolons or commas between them.

    None where there are not as many as asked for, or nothing can be read of any.
    """
    for pieces in (_lines(text), _split(text, ";"), _split(text, ",")):
        parts = [_stripped(at, piece) for at, piece in pieces if piece.strip()]
        left_aside = planar and len(parts) == len(quantities) + 1 and _is_zero(parts[-1][1])
        if len(parts) != len(quantities) + left_aside:
            continue
        entries = [
            _shifted(reader.read(part, quantity), at)
            for (at, part), quantity in zip(parts, quantities, strict=False)
        ]
        if any(entry.readable or entry.findings[0].suggestion for entry in entries):
            at, zero = parts[-1]
            return _with_note(entries, (at, at + len(zero))) if left_aside else entries
    return None


def _stripped(at: int, piece: str) -> tuple[int, str]:
    """A piece of text without the blanks around it, and its place without them."""
    return at + len(piece) - len(piece.lstrip()), piece.strip()


def _lines(text: str) -> Iterator[tuple[int, str]]:
    """The lines of a text, each with the place where it begins."""
    at = 0
    for line in text.splitlines(keepends=True):
        yield at, line.rstrip("\r\n")
        at += len(line)


def _split(text: str, separator: str) -> Iterator[tuple[int, str]]:
    """The pieces between separators, each with its place; brackets around all are left out.

    No pieces where [c1 -s1, 0] might be three values, as in MATLAB.
    """
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
    """The [start, end) of what stands in the brackets around all of a text; else of the text."""
    start, end = len(text) - len(text.lstrip()), len(text.rstrip())
    depth = 0
    for at in range(start, end):
        depth += (text[at] in "([{") - (text[at] in ")]}")
        if not depth:
            return (start + 1, end - 1) if at == end - 1 and at > start else (start, end)
    return start, end


def _shifted(entry: Entry, by: int) -> Entry:
    """The entry with its spans counted from the start of the whole text."""
    findings = tuple(
        replace(finding, span=(finding.span[0] + by, finding.span[1] + by))
        if finding.span
        else finding
        for finding in entry.findings
    )
    return replace(entry, findings=findings)


# A blank and a sign with none behind it: in MATLAB's brackets a new value begins there.
_NEW_VALUE = re.compile(r"[^\s,;(\[{*/^+-]\s+[-+−–][^\s]")

# Refusals that speak of tables, and the sentence that a list gets in their place.
_OF_TABLES = {
    "no_grid": "",
    "named_values": "",
    "too_many_rows": "",
    "too_many_columns": "",
    "ambiguous_separators": "",
    "ambiguous_columns": "Here a space may separate two values or stand inside one.",
    "mixed_separators": "Inside a value, write a*b and a - b, not a b and a -b.",
}

_ZERO_LEFT_ASIDE = reading_note(
    "zero_left_aside", "Only two values are asked for; the third, 0, was ignored."
)


def _wrong_shape(count: int, found: int) -> Finding:
    """The finding that an answer is no such list; ``found`` counts the values of one too long."""
    return reading_error(
        "wrong_shape",
        f"Write a list of {counted(count)}{f'; yours has {found}' if found else ''}.",
    )


def _from_grid_error(error: GridError, count: int) -> Finding:
    """The finding that a pasted text is no list, without a word of rows and columns."""
    finding = from_grid_error(error)
    if error.code not in _OF_TABLES:
        return finding
    message = (
        f"Write a list of {counted(count)}, with commas between them or one on each line. "
        f"{_OF_TABLES[error.code]}"
    )
    return replace(finding, hint=message.strip())
