"""Read submitted screw axes as a row of six numbers (ω; v) for each joint."""

# Students write them as the rows or the columns of one matrix, as named vectors (``S1 = […]``), as
# named halves (``w1 = […], v1 = […]``), or as a table with a column for ω and one for v.

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

from service.expressions import Note
from service.grading.reading.entry import Reader
from service.grading.reading.matrices.matrix_names import indices_of, places_of
from service.grading.reading.pasted import pasted_grid, pasted_grids
from service.grids import Grid, GridCell, GridError, SourceText
from service.regex import regex
from service.translations import say

WIDTH: Final = 6
_HALF: Final = 3

# A transposed vector is the same axis. Its mark is replaced by blanks, so that spans stay valid.
_TRANSPOSED: Final = regex(
    r"(?<=[\])}])[ \t]*(?:\^[ \t]*(?:\{[ \t]*)?(?:\\(?:top|intercal)(?![A-Za-z])"
    r"|(?:\\(?:mathrm|mathsf|text)[ \t]*\{?[ \t]*)?T(?![A-Za-z]))[ \t]*\}{0,2}"
    r"|\.T(?!\w)|\.?'|\.transpose\(\))"
)
# Numbers in round or curly brackets after a name: S1 = (0, 0, 1, 0, 0, 0).
_BRACKETED: Final = regex(
    r"(?<=[=:])([ \t]*)[({]((?:[^(){}\[\]]|\([^(){}\[\]]{0,60}\)){1,400})[)}]"
)
_COMMA: Final = regex(r",")
_STYLE: Final = regex(r"\\(?:hat|vec|bar|tilde|bm|boldsymbol|mathbf|mathrm|mathit|text)")
_OMEGA: Final = regex(r"\\?omega|[ωw]")
_VELOCITY: Final = regex(r"v")
# The names of ω and v within a longer header: "axis ω", "angular velocity".
_IN_HEADER: Final = (
    regex(r"omega|ω|angular|(?<![a-z])w(?![a-z])"),
    regex(r"linear|(?<![a-z])v(?![a-z])"),
)


def screw_grid(text: str, numbers: range, reader: Reader) -> Grid:
    """Return the screw axes of the joints ``numbers`` in a pasted text, each a row of six cells.

    A matrix of another form is returned unchanged. Raises GridError if there is no matrix.
    """
    # Vectors are ordered by the numbers in their names, if they have any.
    plain = _plain(text)
    try:
        grid = pasted_grid(plain, reader)
    except GridError:
        vectors = _of_vectors(plain, numbers, reader)
        if vectors is None:
            raise
        return vectors
    widths = {len(row) for row in grid.rows}
    if widths == {WIDTH}:
        return grid
    if len(grid.rows) == WIDTH and widths == {len(numbers)}:
        return _of_columns(grid)
    return _of_halves_in_cells(grid, numbers) or _of_vectors(plain, numbers, reader) or grid


def screw_rows(answer: object, numbers: range) -> object:
    """Return the rows of a JSON answer; an answer of another form is returned unchanged."""
    # An axis may have its halves as [ω, v] or {"omega": ω, "v": v}. A single axis needs no list
    # around it.
    if isinstance(answer, dict):
        places = _places(list(answer), numbers)
        if places is None:
            return answer
        rows: list[object] = [None] * len(numbers)
        for place, axis in zip(places, answer.values(), strict=True):
            rows[place] = axis
        answer = rows
    if not isinstance(answer, list):
        return answer
    if len(numbers) == 1 and len(answer) > 1:
        answer = [answer]
    if len(numbers) != WIDTH == len(answer) and _is_table(answer, len(numbers)):
        return [list(axis) for axis in zip(*answer, strict=True)]
    return [_one_axis(axis) for axis in answer]


def _is_table(rows: Sequence[object], width: int) -> bool:
    return all(isinstance(row, list) and len(row) == width for row in rows)


def _one_axis(axis: object) -> object:
    if isinstance(axis, Mapping):
        halves = {_half(str(name)): half for name, half in axis.items()}
        axis = [halves[0], halves[1]] if len(axis) == 2 and halves.keys() == {0, 1} else axis
    if isinstance(axis, list) and len(axis) == 2 and _is_table(axis, _HALF):
        return [*axis[0], *axis[1]]
    if isinstance(axis, list) and len(axis) == WIDTH and _is_table(axis, 1):
        return [number for [number] in axis]
    return axis


def _plain(text: str) -> str:
    text = _TRANSPOSED.sub(lambda found: " " * len(found[0]), text)
    return _BRACKETED.sub(_in_square_brackets, text)


def _in_square_brackets(found: re.Match[str]) -> str:
    return f"{found[1]}[{found[2]}]" if "," in found[2] else found[0]


def _of_columns(grid: Grid) -> Grid:
    notes = (*grid.notes, columns_as_axes(grid))
    return replace(grid, rows=tuple(zip(*grid.rows, strict=True)), notes=notes)


def columns_as_axes(grid: Grid) -> Note:
    """Return the note that the columns of a matrix were read as the screw axes."""
    place = grid.rows[0][0].whole[0], grid.rows[-1][-1].whole[1]
    return Note("columns_as_axes", say("The columns were read as the axes."), place)


def _of_halves_in_cells(grid: Grid, numbers: range) -> Grid | None:
    # Rows are ordered by their numbers, if they have any. None if a header names another vector,
    # such as q.
    rows = [[(cell, _vector_in(cell)) for cell in row] for row in grid.rows]
    header = None if any(vector for _, vector in rows[0]) else rows.pop(0)
    if not rows or any(sum(bool(vector) for _, vector in row) != 2 for row in rows):
        return None
    halves: tuple[int | None, ...] = (0, 1)
    if header is not None:
        columns = zip(header, rows[0], strict=False)
        names = [name.text for (name, _), (_, vector) in columns if vector]
        halves = tuple(map(_half_of_column, names)) if any(names) else halves
    if set(halves) != {0, 1}:
        return None
    axes = []
    for row in rows:
        vectors = [vector for _, vector in row if vector]
        axes.append([*vectors[halves.index(0)], *vectors[halves.index(1)]])
    labels = ["" if row[0][1] else row[0][0].text for row in rows]
    if any(map(indices_of, labels)):
        placed = _placed(labels, axes, numbers)
        return None if placed is None else replace(grid, rows=tuple(map(tuple, placed)))
    return replace(grid, rows=tuple(map(tuple, axes)))


def _half_of_column(name: str) -> int | None:
    # 0 for ω, 1 for v.
    half = _half(name)
    if half is None:
        plain = name.lower()
        named = [i for i, half_name in enumerate(_IN_HEADER) if half_name.search(plain)]
        half = named[0] if len(named) == 1 else None
    return half


def _vector_in(cell: GridCell) -> list[GridCell]:
    # Such as (0, 0, 1); [] for any other cell.
    if cell.text[:1] not in ("(", "[") or cell.text[-1:] not in (")", "]"):
        return []
    numbers = cell.cut(1, len(cell.text) - 1).split(_COMMA)
    return [number.strip() for number in numbers] if len(numbers) == _HALF else []


def _of_vectors(text: str, numbers: range, reader: Reader) -> Grid | None:
    try:
        found = pasted_grids(text, reader)
    except GridError:
        return None
    names = [each.name.text for each in found]
    vectors = [_cells(each.grid) for each in found if isinstance(each.grid, Grid)]
    if len(vectors) != len(found):
        return None
    if all(len(vector) == WIDTH for vector in vectors):
        rows = _placed(names, vectors, numbers)
    elif all(len(vector) == _HALF for vector in vectors):
        rows = _of_halves(names, vectors, numbers)
    else:
        return None
    return None if rows is None else Grid("vectors", tuple(map(tuple, rows)))


def _of_halves(
    names: Sequence[str], vectors: Sequence[Sequence[GridCell]], numbers: range
) -> list[Sequence[GridCell]] | None:
    # All names count in the same way. None if the names contradict each other.
    halves = [_half(name) for name in names]
    places, _ = places_of([indices_of(name) for name in names], numbers)
    found = dict(zip(zip(places, halves, strict=True), vectors, strict=True))
    if set(halves) != {0, 1} or None in places or len(found) < len(vectors):
        return None
    empty = [SourceText.of("")] * _HALF
    return [
        [*found.get((i + 1, 0), empty), *found.get((i + 1, 1), empty)] for i in range(len(numbers))
    ]


def _cells(grid: Grid) -> list[GridCell]:
    # [] for a matrix that does not have the rows ω and v.
    heights, widths = len(grid.rows), {len(row) for row in grid.rows}
    if heights == 1 or widths == {1} or (heights == 2 and widths == {_HALF}):
        return [cell for row in grid.rows for cell in row]
    return []


def _placed(
    names: Sequence[str], vectors: Sequence[Sequence[GridCell]], numbers: range
) -> list[Sequence[GridCell]] | None:
    # None if the names contradict each other.
    places = _places(names, numbers)
    if places is None:
        return None
    by_place = dict(zip(places, vectors, strict=True))
    width = len(vectors[0])
    return [by_place.get(i, [SourceText.of("")] * width) for i in range(len(numbers))]


def _places(names: Sequence[str], numbers: range) -> list[int] | None:
    # If all names are empty, the places are in the given order. None if a place is unknown or
    # taken.
    if not names or len(names) > len(numbers):
        return None
    if not any(names):
        return [*range(len(names))]
    found, _ = places_of([indices_of(name) for name in names], numbers)
    places = [place - 1 for place in found if place is not None]
    return places if len(set(places)) == len(names) else None


def _half(name: str) -> int | None:
    # 0 for a name of ω (hat omega_1, w2), 1 for a name of v (v_3).
    plain = _STYLE.sub("", name).lstrip("{ $").lower()
    if _OMEGA.match(plain):
        return 0
    return 1 if _VELOCITY.match(plain) else None
