"""Read matrices: one, several by their names, or screw axes; JSON or pasted text.

This file knows which rows and columns an answer has, and what the names of matrices and of their
entries mean. How a single entry is read is in ``entries.py``.
"""

import re
import unicodedata
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, pairwise
from typing import Final

import numpy as np

from dh_grader.expressions import Expression, Kind, LeftSide, Note, Vocabulary
from dh_grader.expressions.vocabulary import normal_form
from dh_grader.grading.numbers import Samples
from dh_grader.grading.reading.entries import (
    MISSING,
    UNREADABLE,
    Entry,
    FoundAnswer,
    Reader,
    entry_values,
    from_grid_error,
    from_note,
    grids_as_written,
    misnamed_value,
    name_of,
    pasted_grid,
    pasted_grids,
    place_of,
    placed,
    quoted,
    read_once,
    refuse_other_lengths,
    unreadable,
)
from dh_grader.grading.report import (
    Finding,
    UnreadableAnswerError,
    Verdict,
    reading_error,
    reading_note,
)
from dh_grader.kinematics import Numbers
from dh_grader.pasting import Grid, GridCell, GridError, NamedGrid, SourceText
from dh_grader.pasting.matrices import ANY_SIZE
from dh_grader.regex import regex
from dh_grader.translations import listed, say, template

# --- Read a submitted matrix, nested lists or pasted text, as entries and their values


Quantities = Sequence[Sequence[Kind]]


@dataclass(frozen=True, slots=True)
class StudentMatrix:
    """A matrix as read: its entries and their values ``(rows, columns, SAMPLES)``.

    A value is NaN if its entry is unreadable or undefined. ``findings`` are notes on how the whole
    matrix was read.
    """

    entries: list[list[Entry]]
    quantities: Quantities
    values: Numbers
    findings: tuple[Finding, ...] = ()

    @property
    def expressions(self) -> list[Expression | None]:
        """The expressions of the entries, row by row; None for an unreadable entry."""
        return [entry.expression for row in self.entries for entry in row]

    @property
    def with_zeros(self) -> Numbers:
        """The values, with 0 in empty entries."""
        empty = [[entry.verdict is Verdict.MISSING for entry in row] for row in self.entries]
        return np.where(np.array(empty)[..., None], 0.0, self.values)

    def values_at(self, samples: Samples) -> Numbers:
        """Return the values of the entries at these samples (random joint values)."""
        return matrix_values(self.entries, self.quantities, samples)


def read_matrix(answer: object, quantities: Quantities, reader: Reader) -> StudentMatrix:
    """Read the matrix in a nested list or a pasted text.

    Omitted rows at the end are missing. A row of the wrong length is unreadable, because its
    entries are ambiguous. Raises UnreadableAnswerError if there are no rows, or too many.
    """
    if isinstance(answer, str) and answer.strip():
        return _pasted(answer, quantities, reader)
    return matrix_of_entries(_entries(answer, quantities, reader), quantities, reader)


def matrix_of_grid(grid: Grid, quantities: Quantities, reader: Reader) -> StudentMatrix:
    """Read the matrix in a pasted grid. Raises UnreadableAnswerError if its size is wrong."""
    cells = _matrix_cells(grid, quantities)
    if cells is None:
        span = grid.rows[0][0].whole[0], grid.rows[-1][-1].whole[1]
        raise UnreadableAnswerError(_of_wrong_size(grid.size, quantities, span))
    matrix = matrix_of_entries(_of_cells(cells, quantities, reader), quantities, reader)
    return replace(matrix, findings=tuple(map(from_note, grid.notes)))


def unreadable_matrix(finding: Finding, quantities: Quantities, reader: Reader) -> StudentMatrix:
    """Return an unreadable matrix; its first entry has the message."""
    entries = [_unreadable_row(None, kinds) for kinds in quantities]
    entries[0] = _unreadable_row(finding, quantities[0])
    return matrix_of_entries(entries, quantities, reader)


def matrix_of_entries(
    entries: list[list[Entry]], quantities: Quantities, reader: Reader
) -> StudentMatrix:
    """Return the matrix with these rows; omitted rows at the end are missing."""
    entries = [*entries, *([MISSING] * len(row) for row in quantities[len(entries) :])]
    return StudentMatrix(entries, quantities, matrix_values(entries, quantities, reader.samples))


def matrix_values(entries: list[list[Entry]], quantities: Quantities, samples: Samples) -> Numbers:
    """Return the values of a matrix's entries, ``(rows, columns, SAMPLES)``; NaN if unreadable."""
    flat = entry_values(list(chain(*entries)), list(chain(*quantities)), samples)
    return flat.reshape(len(entries), len(quantities[0]), -1)


def _entries(answer: object, quantities: Quantities, reader: Reader) -> list[list[Entry]]:
    if isinstance(answer, str):
        return []
    if not isinstance(answer, list) or not answer or len(answer) > len(quantities):
        raise UnreadableAnswerError(_of_wrong_size("", quantities))
    return [_row(row, i, quantities, reader) for i, row in enumerate(answer)]


def _row(row: object, i: int, quantities: Quantities, reader: Reader) -> list[Entry]:
    kinds = quantities[i]
    if _is_empty(row):
        return [MISSING] * len(kinds)
    if not isinstance(row, list) or len(row) != len(kinds):
        return _of_wrong_length(len(row) if isinstance(row, list) else None, len(kinds))
    return [_entry(raw, (i, j), quantities, reader) for j, raw in enumerate(row)]


def _is_empty(row: object) -> bool:
    entries = row if isinstance(row, list) else [row]
    return all(each is None or (isinstance(each, str) and not each.strip()) for each in entries)


def _entry(raw: object, place: tuple[int, int], quantities: Quantities, reader: Reader) -> Entry:
    # An entry with the name of another place is unreadable.
    i, j = place
    entry = reader.read(raw, quantities[i][j])
    if entry.findings:
        size = len(quantities), len(quantities[0])
        wrong = misnamed_entry(raw, place, size, reader.vocabulary)
        return unreadable(wrong) if wrong else entry
    return entry


def _of_wrong_size(
    found: str, quantities: Quantities, span: tuple[int, int] | None = None
) -> Finding:
    # ``found`` is "" if there is no matrix.
    rows, columns = len(quantities), len(quantities[0])
    message = say("Write {rows} rows with {columns} entries each.", rows=rows, columns=columns)
    if found:
        message = say(
            "Write {rows} rows with {columns} entries each; yours is {size}.",
            rows=rows,
            columns=columns,
            size=found,
        )
    return reading_error("wrong_shape", message, span)


def _of_wrong_length(
    found: int | None, wanted: int, span: tuple[int, int] | None = None
) -> list[Entry]:
    # ``found`` is None if the row is not a list.
    message = say("Write {wanted} entries in this row.", wanted=wanted)
    if found is not None:
        message = say(
            "Write {wanted} entries in this row; it has {found}.", wanted=wanted, found=found
        )
    return _unreadable_row(reading_error("row_length", message, span), [""] * wanted)


def _unreadable_row(finding: Finding | None, cells: Sequence[object]) -> list[Entry]:
    # Only the first entry has the finding, so that it is shown once.
    first = unreadable(finding) if finding else UNREADABLE
    return [first, *[UNREADABLE] * (len(cells) - 1)]


def _pasted(text: str, quantities: Quantities, reader: Reader) -> StudentMatrix:
    def find(piece: str, reader: Reader) -> FoundAnswer | None:
        cells = _matrix_cells(_grid(piece, quantities, reader), quantities)
        if cells is None or [len(row) for row in cells] != [len(row) for row in quantities]:
            return None
        texts = tuple("".join(cell.text.split()) for row in cells for cell in row)
        entries = tuple(chain.from_iterable(_of_cells(cells, quantities, reader)))
        return FoundAnswer(texts, entries, (*chain.from_iterable(quantities),), is_whole=True)

    def is_one(grid: Grid) -> bool:
        return _matrix_cells(grid, quantities) is not None

    try:
        grid, notes = read_once(
            text, lambda piece: _grid(piece, quantities, reader), is_one, find, reader
        )
    except GridError as error:
        raise UnreadableAnswerError(from_grid_error(error, text)) from error
    return matrix_of_grid(replace(grid, notes=(*grid.notes, *notes)), quantities, reader)


def _grid(text: str, quantities: Quantities, reader: Reader) -> Grid:
    refuse_other_lengths(text, chain.from_iterable(quantities), reader)
    return pasted_grid(text, reader)


def _matrix_cells(grid: Grid, quantities: Quantities) -> Sequence[Sequence[GridCell]] | None:
    # None if the grid has another size.
    height, width = len(quantities), len(quantities[0])
    grid = grid.with_empty_rows(height).without_half_row(height)
    if grid.format == ANY_SIZE and height == width:
        grid = replace(grid, rows=tuple(row[:width] for row in grid.rows[:height]))
    if len(grid.rows) > height or all(len(row) != width for row in grid.rows):
        return None
    return grid.rows


def _of_cells(
    cells: Sequence[Sequence[GridCell]], quantities: Quantities, reader: Reader
) -> list[list[Entry]]:
    return [_pasted_row(row, i, quantities, reader) for i, row in enumerate(cells)]


def _pasted_row(
    row: Sequence[GridCell], i: int, quantities: Quantities, reader: Reader
) -> list[Entry]:
    width = len(quantities[i])
    if len(row) != width:
        return _of_wrong_length(len(row), width, place_of(row))
    return [
        placed(_entry(cell.text, (i, j), quantities, reader), cell) for j, cell in enumerate(row)
    ]


# --- Find the matrix entry that a name means, as in T(1,4) = l1 c1 and r_12 = -s1


# Letters that name matrices; p_12 and l_12 are not matrix entries. If the index is in brackets, the
# letter may have frames: T_0^4(1,4).
_LETTER: Final = r"\\?(?:[a-z]+\s*\{\s*)?(?<![a-z])[aghjmrt]\s*\}?"
_GLUED: Final = regex(rf"{_LETTER}_?\{{?\s*([1-9])\s*,?\s*([1-9])\s*\}}?")
_IN_BRACKETS: Final = regex(
    rf"{_LETTER}[\s_^{{}}0-9]*(?:[({{]\s*([0-9]{{1,2}})\s*,\s*([0-9]{{1,2}})\s*[)}}]"
    r"|\[\s*([0-9]{1,2})\s*(?:,|\]\s*\[)\s*([0-9]{1,2})\s*\])"
)


def misnamed_entry(
    raw: object, place: tuple[int, int], size: tuple[int, int], vocabulary: Vocabulary
) -> Finding | None:
    """Return a finding if a value has the name of a matrix entry other than ``place``.

    ``place`` counts from 0; ``size`` is the matrix's rows and columns. Indices in square brackets
    may count from 0.
    """
    name = name_of(raw, vocabulary)
    if name is None or normal_form(name.name) in vocabulary.by_name:
        return None
    named = _places_named(name)
    if place in named or not any(i < size[0] and j < size[1] for i, j in named):
        return None
    row, column = place
    return misnamed_value(name, say("row {row}, column {column}", row=row + 1, column=column + 1))


def _places_named(name: LeftSide) -> list[tuple[int, int]]:
    plain = unicodedata.normalize("NFKC", name.name).lower()
    found = _GLUED.fullmatch(plain) or _IN_BRACKETS.fullmatch(plain)
    if found is None:
        return []
    row, column = (int(each) for each in found.groups() if each is not None)
    from_one = (row - 1, column - 1)
    counts = [from_one, (row, column)] if name.name.endswith("]") else [from_one]
    return [(i, j) for i, j in counts if i >= 0 and j >= 0]


# --- Read several matrices in one pasted text, and order them by the link numbers in their names


def read_matrices(
    text: str, labels: Sequence[str], quantities: Quantities, reader: Reader
) -> list[StudentMatrix]:
    """Read the matrices of a pasted text, one for each label.

    Matrices are identified by their names, if they have any. The entries of an absent matrix are
    missing, and an unreadable matrix affects only itself. Raises UnreadableAnswerError if the
    matrices cannot be found or identified.
    """
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
    places, notes = _places_of_matrices(matrices, labels)
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
        found, notes = _places_of_matrices([each for each in named if each is not None], labels)
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


def _places_of_matrices(
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
        return reading_error("wrong_shape", message, _span_of(named))
    message = say(
        "Which link is {name}? Call the matrices {matrices}.",
        name=quoted(named.name.text),
        matrices=asked_for,
    )
    return reading_error("unknown_matrix", message, _span_of(named))


def _span_of(named: NamedGrid) -> tuple[int, int]:
    if named.name.text or isinstance(named.grid, GridError):
        return named.name.whole
    return named.grid.rows[0][0].whole[0], named.grid.rows[-1][-1].whole[1]


# --- Find the place of a link transform by its name, such as A_2, T_{12}, {}^{1}T_2 or "Link 2"


_COMMAND: Final = regex(r"\\[A-Za-z]{1,20}")
# The arguments of A_2(q_2), in contrast to the indices of A(2) and A{2}.
_ARGUMENTS: Final = regex(r"\([^()]{0,40}[A-Za-zθ\\][^()]{0,40}\)")
_INDEX: Final = regex(r"\d{1,4}|(?<![a-z])(?:ee|EE|e|E|n|tool|TCP)(?![A-Za-z])")

_CHANGED: Final = regex(
    r"(?i:inv|transp)|['’′]|\.T(?![A-Za-z])|\\top(?![a-z])|\\intercal"
    # The T in {}^T A is a frame and not a transpose.
    r"|(?<![\s{}^])\s?\^\s?\{?\s?(?:-|T(?!\w)|\\(?:mathrm|text|mathsf)\s?\{?\s?T)"
    r"|\}(?<!\{\})\^\s?\{?\s?(?:-|T(?!\w))"
)
_PRODUCT: Final = regex(r"[*@]|\\(?:cdot|times)(?![a-z])")
# Two matrices, as in A_1 A_2, but not two frames of one matrix, as in T_{0 TCP}.
_SIDE_BY_SIDE: Final = regex(
    r"(?<![\^_])(?<![\^_]\{)[A-Z]\s?_?\{?\d+\}?[\s_^{}\d]*(?!EE?|TCP)[A-Z](?![A-Za-z])"
)

# The indices in the name of a matrix, as they are written.
Indices = tuple[str, ...]
# The place of a matrix, counted from 1; None if its indices do not give one.
_Place = int | None


def indices_of(name: str) -> Indices:
    r"""Return the indices in a name: "1" and "2" for ^1T_2, "0" and "e" for ^0T_e."""
    return tuple(_INDEX.findall(_COMMAND.sub(" ", _ARGUMENTS.sub(" ", name))))


def is_changed(name: str) -> bool:
    """True if a name means an inverse or a transpose: inv(A1), A1', A_1^{-1}."""
    return _CHANGED.search(name) is not None


def is_product(name: str) -> bool:
    """True if a name means a product of matrices: A1*A2, A_1 A_2."""
    plain = _ARGUMENTS.sub(" ", name)
    return (_PRODUCT.search(plain) or _SIDE_BY_SIDE.search(_COMMAND.sub(" ", plain))) is not None


def places_of(names: Sequence[Indices], numbers: range) -> tuple[tuple[_Place, ...], str]:
    """Return the place (or None) of each named link transform, and a note on unusual counting.

    ``numbers`` are the robot's own numbers of its links. There are several ways to count: by the
    robot's numbers or from 1, A0 may be the first link, and 12 may be the twelfth link or the link
    between frames 1 and 2. The way that gives the most link transforms is chosen, of equal ways the
    first. The note is empty for usual counting.
    """
    from_one = range(1, len(numbers) + 1)
    readings = [
        (tuple(_place_among(way(name, counted[-1]), counted) for name in names), unusual)
        for counted, ways in ((numbers, _WAYS[:2]), (from_one, _WAYS))
        for way, unusual in ways
    ]
    return max(readings, key=lambda reading: len(set(reading[0]) - {None}))


def _place_among(number: int | None, numbers: range) -> _Place:
    return numbers.index(number) + 1 if number is not None and number in numbers else None


def _number(index: str, last: int) -> int:
    return int(index) if index.isdigit() else last


def _by_number(name: Indices, last: int) -> int | None:
    # A_2 has the link's number, T^1_2 the link's two frames.
    numbers = [_number(index, last) for index in name]
    if len(numbers) == 1 and (len(name[0]) == 1 or name[0][0] != "0"):
        return numbers[0]
    if len(numbers) == 2 and abs(numbers[0] - numbers[1]) == 1:
        return max(numbers)
    return None


def _by_frames(name: Indices, last: int) -> int | None:
    # T_{12} and T_{910} have the link's two frames in one number.
    if len(name) == 1 and len(name[0]) > 1 and name[0].isdigit():
        links = range(1, last + 1)
        return next((i for i in links if name[0] in (f"{i - 1}{i}", f"{i}{i - 1}")), None)
    return _by_number(name, last)


def _from_zero(name: Indices, last: int) -> int | None:
    # The first link is A_0.
    return int(name[0]) + 1 if len(name) == 1 and name[0].isdigit() else _by_number(name, last)


def _from_frame_one(name: Indices, last: int) -> int | None:
    # The first link is T_{12}.
    pair = tuple(name[0]) if len(name) == 1 and name[0].isdigit() else name
    numbers = [_number(index, last + 1) for index in pair]
    return min(numbers) if len(numbers) == 2 and abs(numbers[0] - numbers[1]) == 1 else None


def _by_last_frame(name: Indices, last: int) -> int | None:
    # All names start from frame 0: T_{02} is the second matrix.
    pair = tuple(name[0]) if len(name) == 1 else name
    return _number(pair[1], last) if len(pair) == 2 and pair[0] == "0" else None


# Ways to count, the most usual first, each with the template of its note. A way gives the number
# of a link; the number of the last link is its second argument.
_WAYS: Final[tuple[tuple[Callable[[Indices, int], int | None], str], ...]] = (
    (_by_number, ""),
    (_by_frames, ""),
    (_from_zero, template("The names count from 0; the matrices were read as {matrices}.")),
    (_by_last_frame, ""),
    (
        _from_frame_one,
        template("The names count frames from 1; the matrices were read as {matrices}."),
    ),
)


# --- Read submitted screw axes as a row of six numbers (ω; v) for each joint
#
# Students write them as the rows or the columns of one matrix, as named vectors (``S1 = […]``), as
# named halves (``w1 = […], v1 = […]``), or as a table with a column for ω and one for v.


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

    Vectors are ordered by the numbers in their names, if they have any. A matrix of another form is
    returned unchanged. Raises GridError if there is no matrix.
    """
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
    """Return the rows of a JSON answer; an answer of another form is returned unchanged.

    An axis may have its halves as [ω, v] or {"omega": ω, "v": v}. A single axis needs no list
    around it.
    """
    if isinstance(answer, dict):
        places = _places_of_axes(list(answer), numbers)
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
    vectors = [_cells_of_vector(each.grid) for each in found if isinstance(each.grid, Grid)]
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


def _cells_of_vector(grid: Grid) -> list[GridCell]:
    # [] for a matrix that does not have the rows ω and v.
    heights, widths = len(grid.rows), {len(row) for row in grid.rows}
    if heights == 1 or widths == {1} or (heights == 2 and widths == {_HALF}):
        return [cell for row in grid.rows for cell in row]
    return []


def _placed(
    names: Sequence[str], vectors: Sequence[Sequence[GridCell]], numbers: range
) -> list[Sequence[GridCell]] | None:
    # None if the names contradict each other.
    places = _places_of_axes(names, numbers)
    if places is None:
        return None
    by_place = dict(zip(places, vectors, strict=True))
    width = len(vectors[0])
    return [by_place.get(i, [SourceText.of("")] * width) for i in range(len(numbers))]


def _places_of_axes(names: Sequence[str], numbers: range) -> list[int] | None:
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
