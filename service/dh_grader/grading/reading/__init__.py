"""Read answers in JSON or pasted text; each cell becomes an entry.

This file has the preview: what the reader has understood, without a judgement. The other files
read: `entries` one cell, `table`, `matrices` and `lists` what holds them, `pasted_table` a text.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Final

from dh_grader.catalogue import Exercise, PartSpec
from dh_grader.catalogue.kinds import (
    COORDINATES,
    FRAME_CELLS,
    FramesSpec,
    LinkTransformsSpec,
    ScrewAxesSpec,
    frame_labels,
)
from dh_grader.expressions import AngleUnit, Kind, Note
from dh_grader.expressions.errors import Span
from dh_grader.grading.numbers import draw
from dh_grader.grading.reading.entries import Entry, Reader, pasted_grid, placed
from dh_grader.grading.reading.headers import METRES, Header
from dh_grader.grading.reading.lists import pasted_frames
from dh_grader.grading.reading.matrices import grids_in_order, screw_grid
from dh_grader.grading.reading.pasted_table import entries_of, read_pasted_table
from dh_grader.grading.report import Finding, UnreadableAnswerError, WorkBudget
from dh_grader.kinematics import COLUMNS
from dh_grader.pasting import Grid, GridCell, GridError
from dh_grader.regex import regex
from dh_grader.translations import say

_DECIMAL_COMMA: Final = regex(r"[-+−–]?\s{0,4}\d{1,12},\d{1,12}")
# A number, other than 0, that is a whole term of a sum.
_TERM: Final = regex(
    r"((?:^|(?<=[-+]\s)|(?<=^-))(?=[\d.]*[1-9])\d{1,20}(?:\.\d{1,20})?)(?=$|\s[-+]\s)"
)
_WORK_LIMIT: Final = say("The formulas are too long together: some are shown as text only.")


@dataclass(frozen=True, slots=True)
class Problem:
    """The reason why a text or a cell cannot be read, and a repaired text if there is one."""

    code: str
    message: str
    span: Span
    suggestion: str | None = None


@dataclass(frozen=True, slots=True)
class CellPreview:
    """How one cell is read, as plain text, LaTeX and MathML; or why the cell cannot be read.

    ``row`` and ``column`` are labels as in a report: "1", "2" …, and "a", "alpha", "d", "theta" or
    the column's number. ``span`` is the cell's [start, end) in the pasted text, and ``typed`` the
    text there. ``entry`` is the text that means the same in a single field; it differs from
    ``typed`` if the column's header has a unit. An empty cell has neither a reading nor a problem.
    A cell beyond the work budget has no LaTeX and no MathML.
    """

    row: str
    column: str
    span: Span
    typed: str
    entry: str = ""
    text: str = ""
    latex: str = ""
    mathml: str = ""
    symbols: tuple[str, ...] = ()
    notes: tuple[Note, ...] = ()
    problem: Problem | None = None


@dataclass(frozen=True, slots=True)
class PastedPreview:
    """How a pasted text is read: its rows, or the problem with the whole text.

    All spans are [start, end) in the pasted text. Rows are in the order in which they are graded;
    columns of a table are a, alpha, d, theta.
    """

    rows: tuple[tuple[CellPreview, ...], ...] = ()
    notes: tuple[Note, ...] = ()
    problem: Problem | None = None

    @property
    def ok(self) -> bool:
        """True if every cell that is not empty could be read."""
        return self.problem is None and not any(cell.problem for row in self.rows for cell in row)


def preview_pasted(
    text: str, exercise: Exercise, part: str, angle_unit: AngleUnit = "radians"
) -> PastedPreview:
    """Read ``text`` as the answer to a part, exactly as grading reads it.

    The part decides whether the text is a table, a matrix or several matrices. The size of a matrix
    is checked only by grading. Raises LookupError for a part that does not exist.
    """
    spec = _part(exercise, part)
    reader = Reader.of(exercise, draw(exercise, text), angle_unit)
    try:
        preview = _preview(text, exercise, spec, reader)
    except GridError as error:
        return PastedPreview(problem=Problem(error.code, error.message, error.span))
    except UnreadableAnswerError as error:
        finding = error.finding
        return PastedPreview(problem=Problem(finding.code, finding.hint, finding.span or (0, 0)))
    if all(cell.mathml or not cell.text for row in preview.rows for cell in row):
        return preview
    note = Note("work_limit", _WORK_LIMIT, (0, len(text)))
    return replace(preview, notes=(*preview.notes, note))


def preview_entries(
    entries: Sequence[tuple[str, Kind]],
    exercise: Exercise,
    part: str,
    angle_unit: AngleUnit = "radians",
) -> tuple[CellPreview, ...]:
    """Read single entries of a part; each is a pair: a text, and the expected quantity.

    The entries share one work budget, as in a submission. The previews have empty labels. Raises
    LookupError for a part that does not exist.
    """
    spec = _part(exercise, part)
    reader = Reader.of(exercise, draw(exercise, part), angle_unit)
    in_table = spec.pasted_as == "table"
    return tuple(
        _read(
            reader.read(text, quantity, in_table=in_table),
            CellPreview("", "", (0, len(text)), text, text),
            reader.budget,
        )
        for text, quantity in entries
    )


def _part(exercise: Exercise, part: str) -> PartSpec:
    spec = exercise.part(part)
    if spec is None:
        raise LookupError(f"exercise {exercise.id!r} has no part {part!r}")
    return spec


def _preview(text: str, exercise: Exercise, spec: PartSpec, reader: Reader) -> PastedPreview:
    if spec.pasted_as == "table":
        return _table(text, reader)
    if isinstance(spec, LinkTransformsSpec):
        return _matrices(text, exercise.robot.tables[spec.convention].labels, reader)
    if isinstance(spec, FramesSpec):
        return _frames(text, frame_labels(exercise.robot, spec.convention), reader)
    if isinstance(spec, ScrewAxesSpec):
        numbers = spec.numbers(exercise.joints)
        grid = screw_grid(text, numbers, reader).with_empty_rows(len(numbers))
    else:
        grid = pasted_grid(text, reader)
        # Transforms and rotations are square.
        if spec.kind in ("transform", "rotation"):
            grid = grid.with_empty_rows(max(map(len, grid.rows)))
    quantity: Kind = "angle" if spec.pasted_as == "angles" else "number"
    return PastedPreview(_rows(grid, quantity, reader), grid.notes)


def _table(text: str, reader: Reader) -> PastedPreview:
    table = read_pasted_table(text, reader)
    rows: list[tuple[CellPreview, ...]] = []
    for i, (row, entries) in enumerate(zip(table.rows, entries_of(table, reader), strict=True)):
        if row.problem:
            span = row.problem.span or row.cells[0].whole
            problem = Problem(row.problem.code, row.problem.hint, span)
            typed = text[slice(*span)]
            rows.append((CellPreview(str(i + 1), "", span, typed, problem=problem),))
            continue
        cells = (
            _cell(entry, cell, (str(i + 1), column), reader.budget)
            for entry, cell, column in zip(entries, row.cells, COLUMNS, strict=True)
        )
        rows.append(
            tuple(
                replace(cell, entry=_alone(cell, header, reader)) if header.unit else cell
                for cell, header in zip(cells, table.headers, strict=True)
            )
        )
    return PastedPreview(tuple(rows), _notes(table.findings))


def _alone(cell: CellPreview, header: Header, reader: Reader) -> str:
    # The text means, without the header, what the cell means below the header.
    if cell.problem and _DECIMAL_COMMA.fullmatch(cell.typed):
        # The repair of 135,0 would lose the unit.
        if header.angle_unit and header.angle_unit != reader.angle_unit:
            return f"{cell.typed}{'°' if header.angle_unit == 'degrees' else ' rad'}"
        if header.metres and header.metres != METRES.get(reader.length_unit or ""):
            return f"{cell.typed} {header.unit}"
    if header.angle_unit == "radians" and reader.angle_unit == "degrees" and cell.text:
        return _TERM.sub(r"\1rad", cell.text)
    return cell.text or cell.entry


def _matrices(text: str, labels: Sequence[str], reader: Reader) -> PastedPreview:
    # Labels are such as A2.3.
    grids, findings = grids_in_order(text, labels, reader)
    rows: list[tuple[CellPreview, ...]] = []
    notes = list(_notes(findings))
    for label, grid in zip(labels, grids, strict=True):
        if isinstance(grid, GridError):
            problem = Problem(grid.code, grid.message, grid.span)
            typed = text[slice(*grid.span)]
            rows.append((CellPreview(f"A{label}", "", grid.span, typed, problem=problem),))
        elif grid is not None:
            square = grid.with_empty_rows(max(map(len, grid.rows)))
            rows += _rows(square, "number", reader, f"A{label}.")
            notes += grid.notes
    return PastedPreview(tuple(rows), tuple(notes))


def _frames(text: str, labels: Sequence[str], reader: Reader) -> PastedPreview:
    # Joints and directions are shown as they were typed.
    found = pasted_frames(text, labels, reader)

    def preview(place: tuple[str, str], cell: GridCell) -> CellPreview:
        if place[1] in COORDINATES:
            return _cell(placed(reader.read(cell.text, "length"), cell), cell, place, reader.budget)
        return CellPreview(*place, cell.whole, cell.text, cell.text)

    rows = (
        tuple(preview((label, name), cell) for name, cell in zip(FRAME_CELLS, row, strict=True))
        for label, row in found.items()
    )
    return PastedPreview(tuple(rows))


def _rows(
    grid: Grid, quantity: Kind, reader: Reader, name: str = ""
) -> tuple[tuple[CellPreview, ...], ...]:
    return tuple(
        tuple(
            _cell(
                placed(reader.read(cell.text, quantity), cell),
                cell,
                (f"{name}{i + 1}", str(j + 1)),
                reader.budget,
            )
            for j, cell in enumerate(row)
        )
        for i, row in enumerate(grid.rows)
    )


def _notes(findings: Iterable[Finding]) -> tuple[Note, ...]:
    return tuple(Note(each.code, each.hint, each.span or (0, 0)) for each in findings)


def _cell(entry: Entry, cell: GridCell, place: tuple[str, str], budget: WorkBudget) -> CellPreview:
    return _read(entry, CellPreview(*place, cell.whole, cell.text, cell.text), budget)


def _read(entry: Entry, empty: CellPreview, budget: WorkBudget) -> CellPreview:
    if not empty.typed:
        return empty
    if entry.expression is None:
        [finding] = entry.findings
        span = finding.span or empty.span
        problem = Problem(finding.code, finding.hint, span, finding.suggestion)
        return replace(empty, problem=problem)
    expression = entry.expression
    latex, mathml = "", ""
    if budget.printed > 0:
        latex, mathml = expression.latex(), expression.mathml()
        budget.printed -= len(mathml)
    return replace(
        empty,
        text=expression.text(),
        latex=latex,
        mathml=mathml,
        symbols=tuple(sorted(expression.symbols)),
        notes=tuple(Note(f.code, f.hint, f.span or empty.span) for f in entry.findings),
    )
