"""How a whole pasted table or matrix is read, cell by cell, without grading it."""

from dataclasses import dataclass, replace

from service.catalogue import Exercise
from service.expressions import AngleUnit, ExpressionError, Kind, Note, read
from service.expressions.errors import Span
from service.grading.reading.column_headers import QUANTITIES
from service.grading.reading.entry import Entry, Reader
from service.grading.reading.pasted import length_unit, placed, read_pasted_table, table_entry
from service.grading.samples import draw
from service.grids import GridCell, GridError, read_grid
from service.kinematics.chain import COLUMNS


@dataclass(frozen=True, slots=True)
class Problem:
    """Why a text or a cell cannot be read; ``suggestion`` is the repaired cell, if one is near."""

    code: str
    message: str
    span: Span
    suggestion: str | None = None


@dataclass(frozen=True, slots=True)
class CellPreview:
    """How one cell reads: normal text, LaTeX and MathML as typed; or the problem with it.

    ``row`` and ``column`` are labels as in a report: "1", "2" …, and "a", "alpha", "d", "theta" or
    the column's number. ``span`` is the cell's [from, to) in the pasted text, ``typed`` what stands
    there. A cell left empty is neither read nor a problem.
    """

    row: str
    column: str
    span: Span
    typed: str
    text: str = ""
    latex: str = ""
    mathml: str = ""
    symbols: tuple[str, ...] = ()
    notes: tuple[Note, ...] = ()
    problem: Problem | None = None


@dataclass(frozen=True, slots=True)
class PastedPreview:
    """How a pasted text reads: its rows, or the problem with it as a whole.

    Rows stand in the order in which they are graded, the columns of a table as a, alpha, d, theta.
    All spans are [from, to) in the pasted text.
    """

    rows: tuple[tuple[CellPreview, ...], ...] = ()
    notes: tuple[Note, ...] = ()
    problem: Problem | None = None

    @property
    def ok(self) -> bool:
        """Whether every cell that holds something was read."""
        return self.problem is None and not any(cell.problem for row in self.rows for cell in row)


def preview_pasted(
    text: str, exercise: Exercise, part: str, angle_unit: AngleUnit = "radians"
) -> PastedPreview:
    """How ``text``, pasted as the answer to a part, is read: as grading reads it, to the letter.

    A table for a part of kind ``dh_table``, else a matrix of any size; whether it has the size
    that is asked for is for grading to say. Raises LookupError for a part that does not exist, and
    nothing that depends on the text.
    """
    spec = exercise.part(part)
    if spec is None:
        raise LookupError(f"exercise {exercise.id!r} has no part {part!r}")
    reader = Reader(exercise.vocabulary, draw(exercise, text), angle_unit)
    try:
        if spec.kind == "dh_table":
            return _table(text, exercise, reader)
        return _matrix(text, "angle" if spec.kind == "euler_angles" else "number", reader)
    except GridError as error:
        return PastedPreview(problem=Problem(error.code, error.message, error.span))


def _table(text: str, exercise: Exercise, reader: Reader) -> PastedPreview:
    table = read_pasted_table(text, reader)
    unit = length_unit(exercise)
    rows: list[tuple[CellPreview, ...]] = []
    for i, row in enumerate(table.rows):
        if row.problem:
            span = row.problem.span or row.cells[0].whole
            problem = Problem(row.problem.code, row.problem.hint, span)
            typed = text[slice(*span)]
            rows.append((CellPreview(str(i + 1), "", span, typed, problem=problem),))
            continue
        cells = []
        for cell, column, header in zip(row.cells, COLUMNS, table.headers, strict=True):
            entry = table_entry(cell, column, header, reader, unit)
            own = replace(reader, angle_unit=header.angle_unit or reader.angle_unit)
            cells.append(_cell(entry, cell, (str(i + 1), column), QUANTITIES[column], own))
        rows.append(tuple(cells))
    notes = tuple(
        Note(finding.code, finding.hint, finding.span or (0, 0)) for finding in table.findings
    )
    return PastedPreview(tuple(rows), notes)


def _matrix(text: str, quantity: Kind, reader: Reader) -> PastedPreview:
    grid = read_grid(text)
    rows = tuple(
        tuple(
            _cell(
                placed(reader.read(cell.text, quantity), cell),
                cell,
                (str(i + 1), str(j + 1)),
                quantity,
                reader,
            )
            for j, cell in enumerate(row)
        )
        for i, row in enumerate(grid.rows)
    )
    return PastedPreview(rows, grid.notes)


def _cell(
    entry: Entry, cell: GridCell, place: tuple[str, str], quantity: Kind, reader: Reader
) -> CellPreview:
    empty = CellPreview(*place, cell.whole, cell.text)
    if not cell.text:
        return empty
    if entry.expression is None:
        [finding] = entry.findings
        suggestion = _suggestion(cell.text, quantity, reader)
        span = finding.span or cell.whole
        return replace(empty, problem=Problem(finding.code, finding.hint, span, suggestion))
    expression = entry.expression
    return replace(
        empty,
        text=expression.text(),
        latex=expression.latex(),
        mathml=expression.mathml(),
        symbols=tuple(sorted(expression.symbols)),
        notes=tuple(Note(f.code, f.hint, f.span or cell.whole) for f in entry.findings),
    )


def _suggestion(text: str, quantity: Kind, reader: Reader) -> str | None:
    try:
        read(text, reader.vocabulary, quantity=quantity, angle_unit=reader.angle_unit)
    except ExpressionError as error:
        return error.suggestion
    return None
