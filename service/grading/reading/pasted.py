"""Pasted text: its refusals as findings, and the places of its cells in the whole text."""

from collections.abc import Sequence
from dataclasses import replace

from service.grading.feedback import Finding
from service.grading.reading.entry import Entry, Reader
from service.grading.work_budget import MAX_PASTED
from service.grids import (
    GRID_LIMITS,
    Grid,
    GridCell,
    GridError,
    NamedGrid,
    RobotTable,
    read_grid,
    read_grids,
    read_robot,
)


def pasted_grid(text: str, reader: Reader) -> Grid:
    """The table or matrix in a pasted text.

    Raises GridError where there is none, and where the texts of a submission are too long.
    """
    _charge(text, reader)
    return read_grid(text)


def pasted_robot(text: str, reader: Reader) -> RobotTable | None:
    """The DH table of a robot that a pasted script describes; None for any other text.

    Raises GridError where its table is not certain, and as ``pasted_grid``.
    """
    robot = read_robot(text)
    if robot is not None:
        _charge(text, reader)
    return robot


def pasted_grids(text: str, reader: Reader) -> tuple[NamedGrid, ...]:
    """The matrices in a pasted text, each with its name. Raises GridError as ``pasted_grid``."""
    _charge(text, reader)
    return read_grids(text)


def _charge(text: str, reader: Reader) -> None:
    if len(text) <= GRID_LIMITS.characters:
        reader.budget.pasted -= len(text)
    if reader.budget.pasted < 0:
        message = f"The pasted texts have more than {MAX_PASTED:,} characters together."
        raise GridError("too_long", message, (0, len(text)))


def from_grid_error(error: GridError) -> Finding:
    """The finding that a pasted text is no table or matrix."""
    code = "wrong_shape" if error.code == "no_grid" else error.code
    return Finding(code, error.message, span=error.span, reading=True)


def placed(entry: Entry, cell: GridCell) -> Entry:
    """The entry with its spans moved from the cell to the text that it was pasted in."""
    if not entry.findings:
        return entry
    findings = tuple(
        replace(finding, span=cell.span(*finding.span) if finding.span else cell.whole)
        for finding in entry.findings
    )
    return replace(entry, findings=findings)


def place_of(cells: Sequence[GridCell]) -> tuple[int, int]:
    """The place of cells that stand side by side, in the whole text."""
    return cells[0].whole[0], max(cells[0].whole[1], cells[-1].whole[1])


def quoted(text: str) -> str:
    """A cell's text, so that it can be quoted in a message."""
    shown = "".join(filter(str.isprintable, text))
    short = shown if len(shown) <= 30 else shown[:29] + "…"
    return f"`{short}`" if shown == text else f"`{short}` (with an invisible character in it)"
