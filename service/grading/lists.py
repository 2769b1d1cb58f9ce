"""Reading handed-in lists of values, and what is wrong with the shape of one."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from service.expressions import Kind
from service.expressions.grids import Cell, GridError, read_grid
from service.grading.entries import MISSING, Entry, Reader
from service.grading.findings import Finding
from service.grading.matrices import UnreadableMatrixError
from service.grading.pasted import from_grid_error, placed


def read_list(answer: object, quantities: Sequence[Kind], reader: Reader) -> list[Entry]:
    """The entries of a list, one for each quantity asked for.

    A column, a list of lists of one, or a row in a list of its own will do, and pasted text. Values
    that were left off at the end are missing. Raises UnreadableMatrixError where there is no list
    of the length asked for.
    """
    if isinstance(answer, str):
        return _pasted(answer, quantities, reader)
    values = _flat(answer)
    if not values or len(values) > len(quantities):
        raise UnreadableMatrixError(_wrong_shape(len(quantities)))
    padded = [*values, *[None] * (len(quantities) - len(values))]
    return [reader.read(raw, quantity) for raw, quantity in zip(padded, quantities, strict=True)]


def _flat(answer: object) -> list[object]:
    """The values of a list, of a column or of a single row; none for anything else."""
    if not isinstance(answer, list):
        return []
    if len(answer) == 1 and isinstance(answer[0], list):
        return answer[0]
    if all(isinstance(value, list) and len(value) == 1 for value in answer):
        return [value[0] for value in answer]
    return answer


def _pasted(text: str, quantities: Sequence[Kind], reader: Reader) -> list[Entry]:
    if not text.strip():
        return [MISSING] * len(quantities)
    try:
        rows = read_grid(text).rows
    except GridError as error:
        by_lines = _by_lines(text, quantities, reader)
        if by_lines is not None:
            return by_lines
        raise UnreadableMatrixError(from_grid_error(error)) from error
    cells: Sequence[Cell] = rows[0] if len(rows) == 1 else [row[0] for row in rows]
    is_list = len(rows) == 1 or all(len(row) == 1 for row in rows)
    if not is_list or len(cells) > len(quantities):
        raise UnreadableMatrixError(_wrong_shape(len(quantities)))
    entries = [
        placed(reader.read(cell.text, quantity), cell)
        for cell, quantity in zip(cells, quantities, strict=False)
    ]
    return entries + [MISSING] * (len(quantities) - len(entries))


def _by_lines(text: str, quantities: Sequence[Kind], reader: Reader) -> list[Entry] | None:
    """One value on each line, where there are as many lines as values asked for."""
    lines = [(at, line) for at, line in _lines(text) if line.strip()]
    if len(lines) != len(quantities):
        return None
    entries = [
        _shifted(reader.read(line, quantity), at)
        for (at, line), quantity in zip(lines, quantities, strict=True)
    ]
    return entries if any(entry.readable for entry in entries) else None


def _lines(text: str) -> Iterator[tuple[int, str]]:
    """The lines of a text, each with the place where it begins."""
    at = 0
    for line in text.splitlines(keepends=True):
        yield at, line.rstrip("\r\n")
        at += len(line)


def _shifted(entry: Entry, by: int) -> Entry:
    """The entry with its spans counted from the start of the whole text."""
    findings = tuple(
        replace(finding, span=(finding.span[0] + by, finding.span[1] + by))
        if finding.span
        else finding
        for finding in entry.findings
    )
    return replace(entry, findings=findings)


def _wrong_shape(count: int) -> Finding:
    return Finding(
        "wrong_shape",
        f"This answer is a list of {count} values, such as [{', '.join(['…'] * count)}].",
        reading=True,
    )
