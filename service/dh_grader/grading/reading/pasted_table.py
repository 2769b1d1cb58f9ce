"""Read a pasted DH table as rows of entries, and marks of the cells of a table.

This file knows which rows and columns of a text belong to a table, and in which units they are.
What a single header says is in ``headers.py``; how a text is cut into cells, in ``pasting``.
"""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from itertools import chain, pairwise
from typing import Final, Literal, TypeAlias

import numpy as np

from dh_grader.expressions import Expression
from dh_grader.expressions.errors import Note, Span
from dh_grader.expressions.vocabulary import Binary, Node, Number
from dh_grader.grading.numbers import EXACT_VALUE, SAME_FACTOR
from dh_grader.grading.reading.entries import (
    CONVERTS_LENGTHS,
    Arrangement,
    Entry,
    FoundAnswer,
    Reader,
    comments,
    comments_and_captions,
    from_note,
    pasted_grid,
    pasted_robot,
    place_of,
    placed,
    quoted,
    read_once,
    refuse_corrections,
    side_by_side,
    units_in,
    unreadable,
    with_absent_variables,
)
from dh_grader.grading.reading.headers import (
    ANGLE_UNITS,
    ASIDE,
    LABEL,
    LENGTH_OR_LABEL,
    METRES,
    OFFSET,
    QUANTITIES,
    SHOWN,
    THETA_OFFSET,
    Header,
    in_order,
    in_plain_words,
    is_label,
    is_wordy,
    label_place,
    read_header,
)
from dh_grader.grading.reading.table_cells import arranged_row, first_number, row_entries
from dh_grader.grading.report import Finding, Verdict, reading_error, reading_note
from dh_grader.kinematics import COLUMNS, THETA, CellIndex, D
from dh_grader.pasting import Grid, GridCell, GridError, RobotTable
from dh_grader.pasting.around import check_sentences, left_aside, may_correct
from dh_grader.pasting.remarks import may_change
from dh_grader.pasting.source import joined, line_number
from dh_grader.regex import regex
from dh_grader.translations import listed, say, say_count

# --- Read a pasted table: its headers, and the rows below them
#
# Spans count in the whole pasted text.


# The place of a column in the pasted rows, and its header.
_Column: TypeAlias = tuple[int, Header]
# If a text has several tables, each has at least this many rows.
_FEWEST_ROWS: Final = 2
_OFFSETS: Final = (OFFSET, THETA_OFFSET)


@dataclass(frozen=True, slots=True)
class PastedRow:
    """The cells of one row in the order a, α, d, θ.

    A row of the wrong length has a ``problem``, and one cell in all four places. ``named`` is the
    arrangement of the cells by their names, None if no name contradicts its column. ``aside`` are
    the texts in columns that are ignored, such as the type of the joint.
    """

    cells: tuple[GridCell, ...]
    problem: Finding | None = None
    named: Arrangement | None = None
    aside: tuple[str, ...] = ()

    @property
    def texts(self) -> list[str]:
        """The texts of the cells."""
        return [cell.text for cell in self.cells]


@dataclass(frozen=True, slots=True)
class PastedTable:
    """A table's rows in the order of its joints, and the header of each column.

    ``is_named`` is true if the columns have headers, or names in a script or a comment.
    ``convention`` is the convention that a script names, or None. ``grid`` has the cells as they
    were pasted.
    """

    rows: tuple[PastedRow, ...]
    headers: tuple[Header, ...]
    findings: tuple[Finding, ...] = ()
    is_named: bool = True
    convention: str | None = None
    grid: Grid | None = None


def read_pasted_table(text: str, reader: Reader, order: Sequence[str] = COLUMNS) -> PastedTable:
    """Read the rows of a pasted DH table; columns without names are in ``order``.

    Raises GridError if there is no table, or if there are several that differ.
    """

    def find(piece: str, reader: Reader) -> FoundAnswer | None:
        table = _read_one(piece, reader, order)
        if any(row.problem for row in table.rows) or len(table.rows) < _FEWEST_ROWS:
            return None
        units = [header.unit for header in table.headers]
        texts = [
            f"{text} {unit}"
            for row in table.rows
            for text, unit in zip(row.texts, units, strict=True)
        ]
        entries = tuple(chain.from_iterable(entries_of(table, reader)))
        is_whole = len(table.rows) >= len(reader.vocabulary.joints)
        quantities = (*QUANTITIES.values(),) * len(table.rows)
        return FoundAnswer(tuple(texts), entries, quantities, is_whole, is_table=True)

    def is_one(table: PastedTable) -> bool:
        return len(table.rows) <= len(reader.vocabulary.joints)

    table, notes = read_once(
        text, lambda piece: _read_one(piece, reader, order), is_one, find, reader
    )
    return replace(table, findings=(*table.findings, *map(from_note, notes)))


def _read_one(text: str, reader: Reader, order: Sequence[str]) -> PastedTable:
    robot = pasted_robot(text, reader)
    grid = robot.grid if robot else pasted_grid(text, reader, of_table=True)
    table = table_of_robot(robot, reader) if robot else table_of(grid, reader, order, comments=text)
    refuse_other_units(text, table.headers, reader)
    return replace(table, grid=grid)


def table_of(
    grid: Grid, reader: Reader, order: Sequence[str] = COLUMNS, comments: str = ""
) -> PastedTable:
    """Read the rows of a pasted DH table.

    Columns are identified by their headers. Without headers there must be four columns, or five if
    the first column has row numbers; their order is the order that a comment in the text
    ``comments`` names, or else ``order``. Rows are ordered by their labels, if they have any.
    Raises GridError if the columns cannot be identified.
    """
    findings: tuple[Finding, ...] = ()
    if _has_parameters_in_rows(grid):
        grid, findings = _turned(grid)
    grid = with_units_in_headers(_without_names_above(grid, reader))
    found = _found_headers(grid.rows[0], reader)
    if found is not None:
        grid = _without_repeated_headers(grid, len(reader.vocabulary.joints))
    headings = int(found is not None)
    fewest = headings + len(reader.vocabulary.joints)
    grid = _without_remarks_below(grid.without_half_row(fewest), fewest, reader)
    named = None if found is not None else columns_in_comments(comments)
    if found is None:
        columns, labels, more = _columns_in_order(grid, order, named)
    else:
        found = _with_meanings(found)
        columns, labels, more = _columns_by_headers(grid.rows[0], found)
    if labels is None:
        grid = grid.with_empty_rows(fewest)
    grid = _without_rows_of_no_joint(grid, headings, fewest, labels, reader)
    body = grid.rows[headings:]
    findings = (*findings, *more)
    if not body:
        raise GridError(
            "no_rows",
            say("There are headers here, but no rows below them."),
            place_of(grid.rows[0]),
        )
    width = len(grid.rows[0]) if found is not None else max(map(len, body))
    rows = tuple(_row(row, columns, width, reader, found or ()) for row in body)
    if labels is not None:
        labelled, more = in_order([row[labels] if labels < len(row) else row[0] for row in body])
        rows = tuple(rows[i] for i in labelled)
        findings = (*findings, *more)
    notes = tuple(map(from_note, grid.notes))
    headers = tuple(header for _, header in columns)
    return PastedTable(rows, headers, (*notes, *findings), bool(found or named))


def table_of_robot(robot: RobotTable, reader: Reader) -> PastedTable:
    """Return the DH rows of the robot in a pasted script; the angles of its links are in radians.

    Raises GridError if the table has headers that cannot be identified.
    """
    if robot.has_headers:
        return table_of(robot.grid, reader)
    unit = "" if reader.angle_unit == "radians" else "rad"
    headers = tuple(
        Header(column, unit if QUANTITIES[column] == "angle" else "") for column in COLUMNS
    )
    rows = tuple(
        _row(row, tuple(enumerate(headers)), len(COLUMNS), reader) for row in robot.grid.rows
    )
    notes = tuple(map(from_note, robot.grid.notes))
    return PastedTable(rows, headers, notes, convention=robot.convention)


def entries_of(table: PastedTable, reader: Reader) -> list[tuple[Entry, ...]]:
    """Return the four entries of each row of a pasted table."""
    first = first_number([row.texts for row in table.rows], reader.vocabulary)
    return [
        _row_entries(row, None if first is None else first + i, table.headers, reader)
        for i, row in enumerate(table.rows)
    ]


def _row_entries(
    row: PastedRow, number: int | None, headers: Sequence[Header], reader: Reader
) -> tuple[Entry, ...]:
    if row.problem:
        return (unreadable(row.problem),) * len(COLUMNS)
    cells = row.cells
    return row_entries(
        row.texts,
        row.named,
        number,
        lambda i: _entry(cells[i], COLUMNS[i], headers[i], reader),
        lambda i, entry: placed(entry, cells[i]),
        reader.vocabulary,
    )


def _entry(cell: GridCell, column: str, header: Header, reader: Reader) -> Entry:
    if header.angle_unit:
        reader = replace(reader, angle_unit=header.angle_unit)
    # A repaired length is in the unit of the header.
    own = replace(reader, length_unit=header.unit) if header.metres else reader
    entry = own.read(cell.text, QUANTITIES[column], in_table=True)
    if header.metres and header.metres != METRES.get(reader.length_unit or ""):
        entry = in_unit(entry, header, reader)
    return placed(entry, cell)


def _row(
    row: Sequence[GridCell],
    columns: Sequence[_Column],
    width: int,
    reader: Reader,
    found: Sequence[Header | None] = (),
) -> PastedRow:
    if len(row) != width:
        message = say_count(
            "The row {row} has {values} value, but the table has {columns} columns. Write one "
            "value in each column; where a parameter is 0, write 0.",
            "The row {row} has {values} values, but the table has {columns} columns. Write one "
            "value in each column; where a parameter is 0, write 0.",
            count=len(row),
            row=quoted(", ".join(cell.text for cell in row)),
            values=len(row),
            columns=width,
        )
        finding = reading_error("row_length", message, place_of(row))
        return PastedRow((row[0],) * len(COLUMNS), finding)
    cells = [row[place] for place, _ in columns]
    aside = []
    for cell, header in zip(row, found, strict=False):
        if header and header.column == ASIDE:
            if may_change(cell.text, of_cell=True):
                raise may_correct(cell)
            aside.append(cell.text)
        if header and header.column in _OFFSETS and cell.text.strip("-– "):
            j = THETA if header.column == THETA_OFFSET else _moving(cells, reader)
            cells[j] = _sum(cells[j], cell)
    named = arranged_row([cell.text for cell in cells], reader.vocabulary)
    ordered = tuple(cells[i] for i in named.order) if named else tuple(cells)
    return PastedRow(ordered, named=named, aside=tuple(aside))


def _moving(cells: Sequence[GridCell], reader: Reader) -> int:
    """Return the column of the joint variable: d if θ is a number and d is none, else θ."""
    d, theta = (
        reader.read(cells[j].text, QUANTITIES[COLUMNS[j]], in_table=True).expression
        for j in (D, THETA)
    )
    turns = theta is None or theta.symbols
    return THETA if turns or (d is not None and not d.symbols) else D


def _sum(cell: GridCell, offset: GridCell) -> GridCell:
    if not cell.text.strip("-– "):
        return offset
    nothing = offset.cut(0, 0)
    return joined([cell, nothing.spelled(" + ("), offset, nothing.spelled(")")], cell.at)


def _note(code: str, message: str, cell: GridCell) -> Finding:
    return reading_note(code, message, cell.whole)


# --- Turn a table on its side, and leave out what is above, below and between its rows


# The most rows above the headers that do not belong to the table.
_MOST_NAMES: Final = 3
_WHOLE: Final = regex(r"\d{1,12}")
_SHORT: Final = regex(r"\d{1,4}")
_WORD: Final = regex(r"[^\W\d_]{3}")

_DASHES: Final = "-–—−─/ "
_DIGIT: Final = regex(r"\d")
_BASE: Final = regex(
    r"(?<![a-z])(?:base|basis|world|ground|inertial|origin|reference|welt|boden|ursprung|referenz"
    r"|mundo|suelo|origen|referencia|monde|sol|origine|bati)(?![a-z])|基座|基坐标|基底|世界|原点"
)


def _has_parameters_in_rows(grid: Grid) -> bool:
    # The rows are named a, α, d and θ; a row of joint numbers may precede them.
    rows = grid.rows[len(grid.rows) - len(COLUMNS) :]
    if len(grid.rows) > len(COLUMNS) + 1 or len({len(row) for row in grid.rows}) > 1:
        return False
    headers = [read_header(row[0].text) for row in rows]
    return sorted(header.column for header in headers if header) == sorted(COLUMNS)


def _turned(grid: Grid) -> tuple[Grid, tuple[Finding, ...]]:
    message = say("The parameters stand in rows, so each column was read as the row of a joint.")
    note = _note("parameters_in_rows", message, grid.rows[-len(COLUMNS)][0])
    first, *others = zip(*grid.rows, strict=True)
    if len(first) > len(COLUMNS) and read_header(first[0].text) is None and is_wordy(first[0].text):
        # "Parameter" in the corner names the row of names.
        first = (first[0].cut(0, 0), *first[1:])
    return replace(grid, rows=(first, *others)), (note,)


def _without_names_above(grid: Grid, reader: Reader) -> Grid:
    # Rows above the headers are no rows of the table, but the name of a student or a homework, or
    # the headers in words above those in symbols, if something in each of them is unreadable.
    named = [i for i, row in enumerate(grid.rows[: _MOST_NAMES + 1]) if _names_all_columns(row)]
    first = max(named, default=0)
    above = grid.rows[:first]
    if not above or any(
        all(reader.read(cell.text, "number").readable for cell in row) for row in above
    ):
        return grid
    for row in above:
        headers = [read_header(cell.text) for cell in row]
        if any(header and header.unit for header in headers):
            return grid  # the units would be lost
        check_sentences([joined(row, row[0].at)], [])
    return replace(
        grid, rows=grid.rows[first:], notes=(*grid.notes, left_aside(place_of(above[0])))
    )


def _names_all_columns(row: Sequence[GridCell]) -> bool:
    headers = [read_header(cell.text) for cell in row]
    named = [header.column for header in headers if header and header.column in QUANTITIES]
    return sorted(named) == sorted(COLUMNS)


def _without_remarks_below(grid: Grid, fewest: int, reader: Reader) -> Grid:
    # Rows below the table are a remark or a name if they begin with a word or have several, and
    # hold nothing that can be read but whole numbers. At least ``fewest`` rows stay.
    last = len(grid.rows)
    while last > fewest and _is_remark(grid.rows[last - 1], reader):
        last -= 1
    below = grid.rows[last:]
    if not below:
        return grid
    check_sentences([], [joined(row, row[0].at) for row in below])
    return replace(grid, rows=grid.rows[:last], notes=(*grid.notes, left_aside(place_of(below[0]))))


def _is_remark(row: Sequence[GridCell], reader: Reader) -> bool:
    # A row that has a label, or as many numbers as words, is a row of the table. A number with many
    # digits is the student's.
    first = next((cell for cell in row if cell.text), None)
    if first is None or is_label(first.text):
        return False
    cells = [cell for cell in row if cell.text and not _WHOLE.fullmatch(cell.text)]
    words = [cell for cell in cells if _WORD.search(cell.text)]
    numbers = [cell for cell in row if _SHORT.fullmatch(cell.text)]
    is_wordy = len(words) > 1 or words[:1] == [first]
    return (
        is_wordy
        and len(numbers) < len(words)
        and not any(reader.read(cell.text, "number").readable for cell in cells)
    )


def _without_repeated_headers(grid: Grid, joints: int) -> Grid:
    # A table over several pages has its headers on each page. There may be several tables if there
    # are more rows than those of the joints and of the end effector, or lines between the rows.
    first, *body = grid.rows
    texts = [cell.text for cell in first]
    again = [row for row in body if [cell.text for cell in row] == texts]
    if not again or len(body) - len(again) > joints + 1 or not _names_all_columns(first):
        return grid
    lines = [row[0].line_number for row in body if row]
    if any(below - above != 1 for above, below in pairwise(lines)):
        return grid
    message = say("The headers are repeated in the table. These rows were ignored.")
    rows = (first, *(row for row in body if row not in again))
    return replace(grid, rows=rows, notes=(*grid.notes, _text_aside(message, again[0])))


def _without_rows_of_no_joint(
    grid: Grid, headings: int, fewest: int, labels: int | None, reader: Reader
) -> Grid:
    # A first row for the base, and rows at the end, in which nothing has a value. At least
    # ``fewest`` rows stay, so that a row that a student has left empty is not ignored.
    rows = list(grid.rows)
    aside = []
    while len(rows) > fewest and _has_no_value(rows[-1], labels):
        aside.append(rows.pop())
    if len(rows) > fewest and _is_of_base(rows[headings], labels, reader):
        aside.append(rows.pop(headings))
    if not aside:
        return grid
    check_sentences([], [joined(row, row[0].at) for row in aside])
    note = _text_aside(
        say("Rows that belong to no joint and have no value were ignored."), aside[-1]
    )
    return replace(grid, rows=tuple(rows), notes=(*grid.notes, note))


def _has_no_value(row: Sequence[GridCell], labels: int | None) -> bool:
    return not any(cell.text.strip(_DASHES) for i, cell in enumerate(row) if i != labels)


def _is_of_base(row: Sequence[GridCell], labels: int | None, reader: Reader) -> bool:
    if _has_no_value(row, labels):
        return True
    label = row[labels].text if labels is not None and labels < len(row) else ""
    cells = [cell.text for i, cell in enumerate(row) if i != labels and cell.text.strip(_DASHES)]
    is_base = label_place(label) == 0 or _BASE.search(in_plain_words(" ".join([label, *cells])))
    return bool(is_base) and not any(
        _DIGIT.search(text) or reader.read(text, "number").readable for text in cells
    )


def _text_aside(message: str, row: Sequence[GridCell]) -> Note:
    return Note("text_left_aside", message, place_of(row))


# --- Find the parameter and the unit of each column, by headers or by order


def _found_headers(row: Sequence[GridCell], reader: Reader) -> list[Header | None] | None:
    # None if the row holds values. A name such as ``a`` may be a header or a declared length; the
    # other cells of the row decide.
    found = [read_header(cell.text) for cell in row]
    cells = [cell for cell in row if cell.text]
    known = sum(header is not None and header.column in QUANTITIES for header in found)
    if all(header for cell, header in zip(row, found, strict=True) if cell.text):
        return found if known > 1 else None
    readable = [reader.read(cell.text, "number").readable for cell in cells]
    wordy = all(is_wordy(cell.text) for cell in cells)
    if wordy and known > 1 and not all(readable):
        return found
    if (wordy or known > 2) and len(cells) > 1 and not any(readable):
        return found
    return None


def _with_meanings(found: Sequence[Header | None]) -> list[Header | None]:
    """Return the headers with the meanings of "l" and "offset" that the other headers leave."""
    columns = [header.column for header in found if header]
    of_l = LABEL if "a" in columns else "a"
    is_offset = any(each and each.column == "d" and not each.is_word for each in found)

    def meant(header: Header | None) -> Header | None:
        if header and header.column == LENGTH_OR_LABEL:
            return replace(header, column=of_l)
        if header and header.is_word and header.column == "d" and is_offset:
            return replace(header, column=OFFSET)
        return header

    return [meant(header) for header in found]


def _columns_by_headers(
    row: Sequence[GridCell], found: Sequence[Header | None]
) -> tuple[tuple[_Column, ...], int | None, tuple[Finding, ...]]:
    unknown = [cell for cell, header in zip(row, found, strict=True) if not header and cell.text]
    if unknown:
        message = say(
            "Which parameter stands below {names}? Use the headers a, alpha, d and theta, and i "
            "for the number of the row.",
            names=side_by_side([quoted(cell.text) for cell in unknown]),
        )
        raise GridError("unknown_header", message, place_of(unknown))
    places: dict[str, int] = {}
    times = Counter(header.column for header in found if header)
    if all(times[column] > 1 for column in COLUMNS):
        # A tidy table beside the one that the student worked in.
        headers = [cell for cell, header in zip(row, found, strict=True) if header]
        message = say("There are two tables here; paste one of them.")
        raise GridError("two_tables", message, place_of(headers))
    for i, header in enumerate(found):
        if header is None or header.column in (LABEL, ASIDE):
            continue
        name = SHOWN.get(header.column, header.column)
        if header.column in places:
            message = say(
                "Two columns are {parameter}: {first} and {second}. Each parameter has one column.",
                parameter=name,
                first=quoted(row[places[header.column]].text),
                second=quoted(row[i].text),
            )
            raise GridError("two_headers", message, row[i].whole)
        places[header.column] = i
    _check_names(row, places)
    missing = [SHOWN[column] for column in COLUMNS if column not in places]
    if missing:
        message = say(
            "No header is {parameters}. A DH table has the columns a, α, d and θ.",
            parameters=reduce(_either, missing),
        )
        raise GridError("missing_header", message, place_of(row))
    named = tuple((places[column], _header(found, places[column])) for column in COLUMNS)
    columns = _with_units_of_offsets(row, found, named)
    for (place, header), column in zip(columns, COLUMNS, strict=True):
        _check_unit(header, column, row[place])
    labels = next((i for i, h in enumerate(found) if h and h.column == LABEL), None)
    if labels is None and found[0] is None:
        labels = 0
    return columns, labels, (*_on_columns(row, found), *_convention_hint(row, columns))


def _either(first: str, second: str) -> str:
    return say("{first} or {second}", first=first, second=second)


def _check_names(row: Sequence[GridCell], places: Mapping[str, int]) -> None:
    # In the columns α, d, θ, r of Khalil, d and r mean a and d.
    order = [places.get(column, -1) for column in ("alpha", "d", "theta", "a")]
    name = row[order[-1]]
    if -1 in order or order != sorted(order) or not name.text.strip("$\\ ").startswith("r"):
        return
    raise GridError(
        "unknown_header",
        say(
            "With the columns α, d, θ, r, some books call the link length d and the "
            "offset r, others the offset d and the link length r. Use the headers a and "
            "d."
        ),
        name.whole,
    )


def _header(found: Sequence[Header | None], place: int) -> Header:
    header = found[place]
    assert header is not None
    return header


def _check_unit(header: Header, column: str, cell: GridCell) -> None:
    if not header.unit:
        return
    is_angle = QUANTITIES[column] == "angle"
    if is_angle != (header.angle_unit is not None):
        message = say(
            "{parameter} is a length, but its header says {unit}. Correct the header.",
            parameter=SHOWN[column],
            unit=header.unit,
        )
        if is_angle:
            message = say(
                "{parameter} is an angle, but its header says {unit}. Correct the header.",
                parameter=SHOWN[column],
                unit=header.unit,
            )
        raise GridError("header_unit", message, cell.whole)


def _with_units_of_offsets(
    row: Sequence[GridCell], found: Sequence[Header | None], columns: Sequence[_Column]
) -> tuple[_Column, ...]:
    """Return the columns with the unit of an offset, if the column of the variable has none."""
    changed = list(columns)
    for cell, offset in zip(row, found, strict=True):
        if offset is None or offset.column not in _OFFSETS or not offset.unit:
            continue
        j = THETA if offset.angle_unit else D
        place, header = changed[j]
        if header.unit not in ("", offset.unit):
            message = say(
                "The headers {name} and {other} have different units. Correct the headers.",
                name=quoted(cell.text),
                other=quoted(row[place].text),
            )
            raise GridError("header_unit", message, cell.whole)
        changed[j] = place, replace(header, unit=offset.unit)
    return tuple(changed)


def _on_columns(row: Sequence[GridCell], found: Sequence[Header | None]) -> Iterator[Finding]:
    for cell, header in zip(row, found, strict=True):
        if header and header.column == ASIDE:
            message = say("The column {name} was ignored.", name=quoted(cell.text))
            yield _note("column_left_aside", message, cell)
        if header and header.column in _OFFSETS:
            message = say(
                "The column {name} was added to the variables of the joints.",
                name=quoted(cell.text),
            )
            yield _note("column_added", message, cell)


def _convention_hint(row: Sequence[GridCell], columns: Sequence[_Column]) -> tuple[Finding, ...]:
    shifted = [row[place] for place, header in columns if header.shifted]
    if not shifted:
        return ()
    message = say(
        "Headers such as {names} belong to the modified convention, but they do not decide how "
        "the table is read. Check which convention the exercise asks for.",
        names=listed([quoted(cell.text) for cell in shifted]),
    )
    return (_note("convention_hint", message, shifted[0]),)


def _columns_in_order(
    grid: Grid, assumed: Sequence[str], named: Sequence[Header] | None
) -> tuple[tuple[_Column, ...], int | None, tuple[Finding, ...]]:
    order = named or [*map(Header, assumed)]
    width = max(map(len, grid.rows))
    has_labels = width == len(COLUMNS) + 1 and all(is_label(row[0].text) for row in grid.rows)
    if width != len(COLUMNS) and not has_labels:
        raise GridError(
            "wrong_shape",
            say(
                "Without headers, a DH table has the columns a, α, d, θ in this order, with or "
                "without row numbers before them; yours is {size}.",
                size=grid.size,
            ),
            place_of(grid.rows[0]),
        )
    first = 1 if has_labels else 0
    names = [header.column for header in order]
    places = [names.index(column) for column in COLUMNS]
    columns = tuple((first + place, order[place]) for place in places)
    for (_, header), column in zip(columns, COLUMNS, strict=True):
        _check_unit(header, column, grid.rows[0][0])
    message = say(
        "The columns have no headers and were read in the order a, α, d, θ. If yours "
        "is different, such as θ, d, a, α in the Robotics Toolbox, put headers above "
        "them."
    )
    shown = ", ".join(map(_shown, order))
    if named:
        message = say(
            "The columns were read in the order of your comment: {parameters}.", parameters=shown
        )
    elif tuple(names) != COLUMNS:
        message = say("The columns were read in the order {parameters}.", parameters=shown)
    finding = _note("column_order", message, grid.rows[0][0])
    return columns, 0 if has_labels else None, (finding,)


def _shown(header: Header) -> str:
    return f"{SHOWN[header.column]} [{header.unit}]" if header.unit else SHOWN[header.column]


# --- Move the units in the second row of a pasted table into its headers


_KINDS: Final = {**QUANTITIES, LENGTH_OR_LABEL: "length", THETA_OFFSET: "angle"}
_BRACKETS = "()[]"
_UNIT_WORDS: Final = frozenset(
    {"unit", "units", "einheit", "einheiten", "unite", "unites", "unidad", "unidades", "单位"}
)


def with_units_in_headers(grid: Grid) -> Grid:
    """Return the table with one header ``a [m]`` for the two cells ``a`` and ``(m)``.

    All cells of the second row, or of a last row "Unit", must be units of a parameter, or empty. A
    table without a row of units is returned unchanged.
    """
    if len(grid.rows) < 3:
        return grid
    first, *body = grid.rows
    if _says_unit(body[-1][0].text):
        body = [body[-1], *body[:-1]]
    second, *body = body
    if len(first) != len(second):
        return grid
    headers = [read_header(cell.text) for cell in first]
    columns = [header.column if header and not header.unit else "" for header in headers]
    units = [_unit_of(column, cell) for column, cell in zip(columns, second, strict=True)]
    if None in units or not any(units):
        return grid
    merged = tuple(
        _with_unit(header, unit) if unit else header
        for header, unit in zip(first, units, strict=True)
    )
    return replace(grid, rows=(merged, *body))


def _says_unit(text: str) -> bool:
    return in_plain_words(text).strip(f"{_BRACKETS} ") in _UNIT_WORDS


def _unit_of(column: str, cell: GridCell) -> GridCell | Literal[""] | None:
    """Return the cell if it is a unit of the parameter ``column``; None if it is anything else.

    Return an empty text for an empty cell, and for the label of the row of units.
    """
    if not cell.text.strip("-– ") or (column in ("", LABEL) and _says_unit(cell.text)):
        return ""
    unit = in_plain_words(cell.text).strip(f"{_BRACKETS} ")
    units = {"angle": ANGLE_UNITS, "length": METRES}.get(_KINDS.get(column, ""), {})
    return cell if unit in units else None


def _with_unit(header: GridCell, unit: GridCell) -> GridCell:
    bare = unit.strip(f"{_BRACKETS} ")
    nothing = bare.cut(0, 0)
    return joined([header, nothing.spelled(" ["), bare, nothing.spelled("]")], header.at)


# --- Find the columns and units that comments and captions of a table name
#
# The comment ``% theta [deg], d, a, alpha`` gives the columns of a table without headers. A unit
# without columns, such as ``% lengths in mm``, may apply to the table, so the text is refused.


_BETWEEN_NAMES: Final = regex(r"[\s,;|&:]+")
_BEFORE_UNIT: Final = regex(r"\s{1,8}(?=[(\[])")
# Numbers in a table with π, or in a script that converts them, are not in degrees or millimetres.
_CONVERTS_ANGLES: Final = regex(
    r"(?<![^\W\d_])(?:pi|deg2rad|radians)(?![^\W\d_])|π|°", re.IGNORECASE
)
_OTHER_ANGLES: Final = regex(r"limit|qlim|range|freedom|grenze|bereich|límite|rango", re.IGNORECASE)


def columns_in_comments(text: str) -> tuple[Header, ...] | None:
    """Return the headers in a comment such as ``% theta d a alpha``, or None.

    Raises GridError if two comments contradict each other.
    """
    found: dict[tuple[Header, ...], Span] = {}
    for comment in comments(text):
        named = _named_columns(comment[1])
        if named is not None:
            found[named] = comment.span(1)
    if len(found) > 1:
        message = say("Two comments name the columns in two orders. Put headers above the columns.")
        raise GridError("unknown_header", message, [*found.values()][1])
    return next(iter(found), None)


def refuse_other_units(text: str, headers: Sequence[Header], reader: Reader) -> None:
    """Raise GridError if a comment or a caption names a unit, but not the columns in this unit.

    Units of angles are ignored if a header has one, and so are units of lengths. The reader's own
    units and comments with numbers are ignored, too. Also raises GridError if a comment corrects
    the table.
    """
    refuse_corrections(text)
    has_angles = any(header.angle_unit for header in headers) or _CONVERTS_ANGLES.search(text)
    has_lengths = any(header.metres for header in headers) or CONVERTS_LENGTHS.search(text)
    for comment in comments_and_captions(text):
        written = comment[comment.lastindex or 0]
        if _OTHER_ANGLES.search(written) or _named_columns(written):
            continue
        angles, lengths = units_in(written)
        others = set() if has_angles else angles - {reader.angle_unit}
        if others or (not has_lengths and lengths - {METRES.get(reader.length_unit or "")}):
            message = say(
                "Line {line} names a unit, but not its columns. Delete the line, and write the "
                "units into the headers, such as theta [deg].",
                line=line_number(text, comment.start()),
            )
            raise GridError("text_around", message, comment.span())


def _named_columns(comment: str) -> tuple[Header, ...] | None:
    words = _BETWEEN_NAMES.split(_BEFORE_UNIT.sub("", comment.strip(" \t[]()")))
    headers = [read_header(word) for word in words]
    for i in range(len(headers) - len(COLUMNS) + 1):
        order = tuple(header for header in headers[i : i + len(COLUMNS)] if header)
        if sorted(header.column for header in order) == sorted(COLUMNS):
            return order
    return None


# --- Convert the lengths in a column from the header's unit to the exercise's unit


def in_unit(entry: Entry, header: Header, reader: Reader) -> Entry:
    """Convert an entry from the unit in the header to the unit of the exercise.

    Numbers are converted; a number is unreadable if the exercise's unit is unknown. Formulas of
    letters alone stay unchanged, because letters mean lengths in any unit. A formula that also
    contains a length in numbers is unreadable, because the number is ambiguous.
    """
    expression = entry.expression
    if expression is None:
        return entry
    if expression.symbols:
        return _checked_formula(entry, expression, header, reader)
    value = expression.evaluate({})
    if np.all(value == 0):
        return entry
    metres = METRES.get(reader.length_unit or "")
    if metres is None or header.metres is None:
        message = say(
            "A length in {unit} cannot be converted in this exercise. Delete `{unit}` from the "
            "header, and write lengths as the exercise does.",
            unit=header.unit,
        )
        return unreadable(reading_error("header_unit", message))
    factor = header.metres / metres
    converted = Expression(
        expression.source, _times(expression.tree, factor), expression.notes, expression.symbols
    )
    message = say(
        "Read as {number} {unit}, as the header says.",
        number=f"{float(np.max(value)):g}",
        unit=header.unit,
    )
    note = reading_note("converted_length", message)
    return replace(entry, expression=converted, findings=(*entry.findings, note))


def _times(tree: Node, factor: float) -> Node:
    # For 0.001 divide by 1000, which is exact.
    divisor = round(1 / factor)
    if divisor > 1 and abs(divisor * factor - 1) < SAME_FACTOR:
        by = Number(float(divisor), str(divisor), tree.end, tree.end)
        return Binary("/", tree, by, tree.start, tree.end)
    by = Number(factor, f"{factor:.10g}", tree.end, tree.end)
    return Binary("*", tree, by, tree.start, tree.end)


def _checked_formula(entry: Entry, expression: Expression, header: Header, reader: Reader) -> Entry:
    # An entry whose value does not double when all its lengths double contains a length in numbers.
    known = with_absent_variables(reader.vocabulary).by_name
    lengths = {name for name in expression.symbols if known[name].kind == "length"}
    values = reader.samples.values_for(expression)
    values = {name: values[name] for name in expression.symbols}
    doubled = {name: numbers * (2 if name in lengths else 1) for name, numbers in values.items()}
    once, twice = expression.evaluate(values), expression.evaluate(doubled)
    with np.errstate(all="ignore"):
        expected = 2 * np.asarray(once)
    if np.allclose(twice, expected, rtol=EXACT_VALUE, atol=EXACT_VALUE, equal_nan=True):
        return entry
    message = say(
        "The number here may be in {unit} or in the unit of the exercise. Delete `{unit}` from the "
        "header, and write lengths as the exercise does.",
        unit=header.unit,
    )
    if reader.length_unit:
        message = say(
            "The number here may be in {unit} or in {other}. Delete `{unit}` from the header, and "
            "write lengths as the exercise does.",
            unit=header.unit,
            other=reader.length_unit,
        )
    return unreadable(reading_error("header_unit", message))


# --- Read which cells of a table a student marks: ``2.alpha``, or row ``2``, or several


_NAMES: Final = {
    **{name: column for column, name in enumerate(COLUMNS)},
    "α": 1,
    "θ": 3,
}
# A row's label, a column's name, or both: "2.alpha", "row 2, alpha" is two marks.
_MARK: Final = regex(r"(?:row\s*)?([0-9]{1,3}|e2?)(?:\s*[./:\s]\s*([a-zα-ω]+))?")
_SEPARATORS: Final = regex(r"[,;\n]")
MAX_MARKS: Final = 64
MAX_CHARACTERS: Final = 1000


@dataclass(frozen=True, slots=True)
class MarkedCells:
    """The marked cells by row and column; ``findings`` say why a mark could not be read."""

    cells: frozenset[CellIndex] = frozenset()
    findings: tuple[Finding, ...] = ()

    @property
    def verdict(self) -> Verdict | None:
        """The verdict MISSING or UNREADABLE, or None if there are readable marks."""
        if self.findings:
            return Verdict.UNREADABLE
        return None if self.cells else Verdict.MISSING


_NOT_MARKS: Final = reading_error(
    "wrong_shape", say('Write the places that are wrong: "2.alpha", or several of them in a list.')
)


def read_marks(answer: object, labels: Sequence[str]) -> MarkedCells:
    """Read marks in a table whose rows have these labels.

    One unreadable mark makes all of them unreadable, because the student may have meant any cell.
    """
    marks = _split(answer)
    if marks is None:
        return MarkedCells(findings=(_NOT_MARKS,))
    cells: set[CellIndex] = set()
    for mark in marks:
        found = _cells_of(mark, labels)
        if found is None:
            return MarkedCells(findings=(_unknown(labels),))
        cells |= found
    return MarkedCells(frozenset(cells))


def _split(answer: object) -> list[str] | None:
    if answer is None:
        return []
    if isinstance(answer, int) and not isinstance(answer, bool):
        return [str(answer)] if 0 <= answer <= 999 else None
    if isinstance(answer, str):
        if len(answer) > MAX_CHARACTERS:
            return None
        marks = [mark.strip().lower() for mark in _SEPARATORS.split(answer)]
        return [mark for mark in marks if mark][: MAX_MARKS + 1]
    if not isinstance(answer, list) or len(answer) > MAX_MARKS:
        return None
    split = [None if isinstance(each, list) else _split(each) for each in answer]
    if None in split:
        return None
    return [mark for marks in split for mark in marks or ()]


def _cells_of(mark: str, labels: Sequence[str]) -> set[CellIndex] | None:
    found = _MARK.fullmatch(mark)
    if found is None or found[1] not in labels:
        return None
    row = labels.index(found[1])
    if found[2] is None:
        return {(row, column) for column in range(len(COLUMNS))}
    return {(row, _NAMES[found[2]])} if found[2] in _NAMES else None


def _unknown(labels: Sequence[str]) -> Finding:
    return reading_error(
        "unknown_place",
        say(
            "Write each place as its row and column: {row}.alpha. The rows are {rows}, the columns "
            "a, alpha, d, theta.",
            row=labels[-1],
            rows=", ".join(labels),
        ),
    )
