"""The preview of a pasted table or matrix: the reading of each cell, without a grading."""

from dataclasses import dataclass, replace

from service.catalogue import Exercise
from service.expressions import AngleUnit, Kind, Note
from service.expressions.errors import Span
from service.grading.reading.entry import Entry, Reader
from service.grading.reading.pasted import placed
from service.grading.reading.pasted_table import read_pasted_table, table_entry
from service.grading.samples import draw
from service.grids import GridCell, GridError, read_grid
from service.kinematics.chain import COLUMNS


@dataclass(frozen=True, slots=True)
class Problem:
    """The reason why a text or a cell cannot be read, and the repaired cell, if one is near."""

    code: str
    message: str
    span: Span
    suggestion: str | None = None


@dataclass(frozen=True, slots=True)
class CellPreview:
    """The reading of one cell as normal text, LaTeX and MathML; or the problem with it.

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
    """The reading of a pasted text: its rows, or the problem with it as a whole.

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
    """The reading of ``text`` as the answer to a part, exactly as grading reads it.

    The part says whether a table is pasted or a matrix. A matrix of any size is read: grading
    checks the size. Raises LookupError for a part that does not exist.
    """
    spec = exercise.part(part)
    if spec is None:
        raise LookupError(f"exercise {exercise.id!r} has no part {part!r}")
    reader = Reader.of(exercise, draw(exercise, text), angle_unit)
    try:
        if spec.pasted_as == "table":
            return _table(text, reader)
        return _matrix(text, "angle" if spec.pasted_as == "angles" else "number", reader)
    except GridError as error:
        return PastedPreview(problem=Problem(error.code, error.message, error.span))


def _table(text: str, reader: Reader) -> PastedPreview:
    table = read_pasted_table(text, reader)
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
            entry = table_entry(cell, column, header, reader)
            cells.append(_cell(entry, cell, (str(i + 1), column)))
        rows.append(tuple(cells))
    notes = tuple(
        Note(finding.code, finding.hint, finding.span or (0, 0)) for finding in table.findings
    )
    return PastedPreview(tuple(rows), notes)


def _matrix(text: str, quantity: Kind, reader: Reader) -> PastedPreview:
    grid = read_grid(text)
    rows = tuple(
        tuple(
            _cell(placed(reader.read(cell.text, quantity), cell), cell, (str(i + 1), str(j + 1)))
            for j, cell in enumerate(row)
        )
        for i, row in enumerate(grid.rows)
    )
    return PastedPreview(rows, grid.notes)


def _cell(entry: Entry, cell: GridCell, place: tuple[str, str]) -> CellPreview:
    empty = CellPreview(*place, cell.whole, cell.text)
    if not cell.text:
        return empty
    if entry.expression is None:
        [finding] = entry.findings
        span = finding.span or cell.whole
        problem = Problem(finding.code, finding.hint, span, finding.suggestion)
        return replace(empty, problem=problem)
    expression = entry.expression
    return replace(
        empty,
        text=expression.text(),
        latex=expression.latex(),
        mathml=expression.mathml(),
        symbols=tuple(sorted(expression.symbols)),
        notes=tuple(Note(f.code, f.hint, f.span or cell.whole) for f in entry.findings),
    )
