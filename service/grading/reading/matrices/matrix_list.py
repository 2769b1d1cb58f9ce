"""Read several matrices in one pasted text, and order them by the link numbers in their names."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from service.expressions.vocabulary.symbols import normal_form
from service.grading.feedback import Finding, UnreadableAnswerError, reading_error, reading_note
from service.grading.reading.entry import Reader
from service.grading.reading.matrices.matrix import (
    Quantities,
    StudentMatrix,
    matrix_of_entries,
    matrix_of_grid,
    unreadable_matrix,
)
from service.grading.reading.matrices.matrix_names import (
    indices_of,
    is_changed,
    is_product,
    places_of,
)
from service.grading.reading.pasted import (
    from_grid_error,
    grids_as_written,
    pasted_grids,
    quoted,
)
from service.grading.reading.unit_comments import refuse_other_lengths
from service.grids import Grid, GridError, NamedGrid, SourceText
from service.translations import listed, say


def read_matrices(
    text: str, labels: Sequence[str], quantities: Quantities, reader: Reader
) -> list[StudentMatrix]:
    """Read the matrices of a pasted text, one for each label.

    Raises UnreadableAnswerError if the matrices cannot be found or identified.
    """
    # The entries of an absent matrix are missing.
    # Matrices are identified by their names, if they have any. An unreadable matrix affects only
    # itself.
    if not text.strip():
        return [matrix_of_entries([], quantities, reader) for _ in labels]
    grids, notes = grids_in_order(text, labels, reader)
    matrices = [_matrix(grid, quantities, reader) for grid in grids]
    return [with_notes(matrices[0], notes), *matrices[1:]]


def grids_in_order(
    text: str, labels: Sequence[str], reader: Reader
) -> tuple[list[Grid | GridError | None], list[Finding]]:
    """Return the grid for each label (an error if unreadable, None if absent), and notes.

    Raises UnreadableAnswerError if the matrices cannot be found or identified.
    """
    try:
        refuse_other_lengths(text, ["length"], reader)
        grids = pasted_grids(text, reader)
    except GridError as error:
        raise UnreadableAnswerError(from_grid_error(error, text)) from error
    errors = [each.grid for each in grids if isinstance(each.grid, GridError)]
    if len(errors) == len(grids):
        raise UnreadableAnswerError(_no_matrices(errors[0], labels))
    matrices, values = _without_values(grids, labels, reader)
    places, notes = _places(matrices, labels)
    notes += values
    by_place = {place: each.grid for place, each in zip(places, matrices, strict=True)}
    return _noted_once([by_place.get(place) for place in range(len(labels))]), notes


def places_in_list(
    answer: Sequence[object], labels: Sequence[str], reader: Reader
) -> tuple[list[int], list[Finding]]:
    """Return the place of each matrix in a list, by the matrix's name, and notes on the places.

    Raises UnreadableAnswerError if the names contradict each other.
    """
    places = [*range(len(answer))]
    named = [_named(each, reader) for each in answer]
    written = [i for i, each in enumerate(named) if each is not None]
    if not any(each.name.text for each in named if each is not None):
        return places, []
    try:
        found, notes = _places([each for each in named if each is not None], labels)
    except UnreadableAnswerError as error:
        raise UnreadableAnswerError(replace(error.finding, span=None)) from error
    taken = dict(zip(written, found, strict=True))
    left = iter([place for place in range(len(labels)) if place not in found])
    places = [taken[i] if taken.get(i) is not None else next(left) for i in places]
    return places, [replace(note, span=None) for note in notes]


def _named(answer: object, reader: Reader) -> NamedGrid | None:
    nameless = NamedGrid(SourceText.of(""), GridError("no_grid", "", (0, 0)))
    if not isinstance(answer, str):
        return None if answer is None else nameless
    try:
        grids = grids_as_written(answer, reader)
    except GridError:
        return nameless if answer.strip() else None
    matrices = [each for each in grids if isinstance(each.grid, Grid)]
    return matrices[0] if len(matrices) == 1 else nameless


def _noted_once(grids: list[Grid | GridError | None]) -> list[Grid | GridError | None]:
    noted: set[str] = set()
    found: list[Grid | GridError | None] = []
    for each in grids:
        grid = each
        if isinstance(grid, Grid):
            grid = replace(grid, notes=tuple(n for n in grid.notes if n.code not in noted))
            noted |= {note.code for note in grid.notes}
        found.append(grid)
    return found


def _matrix(grid: Grid | GridError | None, quantities: Quantities, reader: Reader) -> StudentMatrix:
    if grid is None:
        return matrix_of_entries([], quantities, reader)
    try:
        if isinstance(grid, GridError):
            raise UnreadableAnswerError(from_grid_error(grid))
        return matrix_of_grid(grid, quantities, reader)
    except UnreadableAnswerError as error:
        return unreadable_matrix(error.finding, quantities, reader)


def with_notes(matrix: StudentMatrix, notes: Sequence[Finding]) -> StudentMatrix:
    """Return the matrix with more notes on how it was read."""
    return replace(matrix, findings=(*matrix.findings, *notes))


def _places(
    grids: Sequence[NamedGrid], labels: Sequence[str]
) -> tuple[list[int | None], list[Finding]]:
    # Places count from 0; the place of an ignored matrix is None.
    texts, count = [each.name.text for each in grids], len(labels)
    changed = [is_changed(text) for text in texts]
    products = [is_product(text) and not is_changed(text) for text in texts]
    names = [
        () if product or other else indices_of(text)
        for text, product, other in zip(texts, products, changed, strict=True)
    ]
    first = int(labels[0])
    named, unusual = places_of(names, range(first, first + count))
    found = [None if place is None else place - 1 for place in named]
    for i, place in enumerate(found):
        if place is not None and place in found[:i]:
            raise UnreadableAnswerError(_same_name(grids[i], f"A{labels[place]}"))
    asked_for = _asked_for(labels)
    complete = len(set(found) - {None}) == count
    notes: list[Finding] = []
    for i, place in enumerate(found):
        if place is None and (complete or products[i]):
            notes.append(_left_aside(grids[i], asked_for))
        elif place is None:
            if names[i] or changed[i] or i >= count or i in found:
                raise UnreadableAnswerError(_unknown(grids[i], len(grids), asked_for))
            found[i] = i
    placed = [place for place in found if place is not None]
    if any(a > b for a, b in pairwise(placed)):
        notes.append(
            _note(
                "matrix_order", say("The matrices were put in the order of their names."), grids[0]
            )
        )
    if unusual:
        notes.append(_note("matrix_names", say(unusual, matrices=asked_for), grids[0]))
    return found, notes


def _without_values(
    grids: Sequence[NamedGrid], labels: Sequence[str], reader: Reader
) -> tuple[list[NamedGrid], list[Finding]]:
    matrices = [each for each in grids if not _is_value(each, reader)]
    notes = [_left_aside(each, _asked_for(labels)) for each in grids if _is_value(each, reader)]
    return matrices, notes


def _is_value(each: NamedGrid, reader: Reader) -> bool:
    if not isinstance(each.grid, GridError) or each.grid.code != "no_grid":
        return False
    name = each.name.text
    return is_product(name) or normal_form(name) in reader.vocabulary.by_name


def _asked_for(labels: Sequence[str]) -> str:
    # "A1 and A2", "A1 to A6".
    first, last = f"A{labels[0]}", f"A{labels[-1]}"
    if len(labels) == 2:
        return listed((first, last))
    # Translators: matrices or other things in a row, such as "A1 to A6".
    return say("{first} to {last}", first=first, last=last)


def _no_matrices(error: GridError, labels: Sequence[str]) -> Finding:
    if error.code != "no_grid":
        return from_grid_error(error)
    message = say(
        "Write {matrices}, each with its name before it, such as {matrix} = […], as MATLAB, "
        "Python, Mathematica, Maxima or LaTeX write them.",
        matrices=_asked_for(labels),
        matrix=f"A{labels[0]}",
    )
    return reading_error("wrong_shape", message, error.span)


def _note(code: str, message: str, named: NamedGrid) -> Finding:
    return reading_note(code, message, named.name.whole)


def _left_aside(named: NamedGrid, asked_for: str) -> Finding:
    message = say(
        "A matrix without a name was ignored: {matrices} are asked for.", matrices=asked_for
    )
    if named.name.text:
        message = say(
            "{name} was ignored: {matrices} are asked for.",
            name=quoted(named.name.text),
            matrices=asked_for,
        )
    return _note("matrix_left_aside", message, named)


def _same_name(named: NamedGrid, label: str) -> Finding:
    message = say(
        "Two matrices are called {matrix}: give each matrix the number of its link.", matrix=label
    )
    return reading_error("duplicate_matrix", message, named.name.whole)


def _unknown(named: NamedGrid, count: int, asked_for: str) -> Finding:
    if not named.name.text:
        message = say(
            "{number} matrices stand here. Give {matrices} their names.",
            number=count,
            matrices=asked_for,
        )
        return reading_error("wrong_shape", message, _place(named))
    message = say(
        "Which link is {name}? Call the matrices {matrices}.",
        name=quoted(named.name.text),
        matrices=asked_for,
    )
    return reading_error("unknown_matrix", message, _place(named))


def _place(named: NamedGrid) -> tuple[int, int]:
    if named.name.text or isinstance(named.grid, GridError):
        return named.name.whole
    return named.grid.rows[0][0].whole[0], named.grid.rows[-1][-1].whole[1]
