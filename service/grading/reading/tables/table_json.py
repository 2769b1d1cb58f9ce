"""Convert the JSON shapes of a DH table into the one that the reader expects."""

from collections.abc import Mapping, Sequence
from typing import Final

from service.grading.reading.tables.column_headers import (
    ASIDE,
    LABEL,
    QUANTITIES,
    Header,
    read_header,
)
from service.grading.reading.tables.row_labels import LAST, label_place

_KEYS: Final = QUANTITIES.keys()
_IN_ORDER: Final = (*QUANTITIES,)
# Rows beyond these are counted but not read, and names beyond these are ignored.
_MOST_ROWS: Final = 16
_MOST_NAMES: Final = 40

# A row's label, if it has one, and its cells by column; or None and the row as it was sent.
_Read = tuple[object, object]


def canonical_table(answer: object, order: Sequence[str] = _IN_ORDER) -> object:
    """Convert a table to ``{"rows": [{"a", "alpha", "d", "theta"} …], …}``. Never raises.

    The answer may be a mapping with ``rows`` (other fields are kept), the list of rows alone, or a
    mapping from headers to lists. A row is a mapping whose keys are headers in any spelling ("α",
    "alpha_i", "twist"), or a list in ``order``, with or without the row's number in front. A list
    of four headers may precede such rows; or each list has the values of one parameter, after its
    header. If all rows have a number or "e", they are put in that order.

    Any other row is kept as it is; so is a row whose keys have a unit, or name one column twice.
    The reader then refuses the row, or reads the cells that it knows. An answer without any row is
    returned unchanged.
    """
    if isinstance(answer, Mapping):
        rows = answer.get("rows")
        if rows is None and (rows := _from_columns(answer)) is not None:
            return {**answer, "rows": _canonical_rows(rows, order)}
        if not isinstance(rows, list) or _is_canonical(rows):
            return answer
        return {**answer, "rows": _canonical_rows(rows, order)}
    if not isinstance(answer, list):
        return answer
    found = answer if _is_canonical(answer) else _canonical_rows(answer, order)
    has_rows = any(
        isinstance(row, Mapping) and not _KEYS.isdisjoint(row) for row in found[:_MOST_ROWS]
    )
    return {"rows": found} if has_rows else answer


def _from_columns(answer: Mapping[str, object]) -> list[object] | None:
    """Return the rows of a table that has one list for each parameter; None for other answers."""
    columns = {key: cells for key, cells in answer.items() if isinstance(cells, list)}
    lengths = {len(cells) for cells in columns.values()}
    if not len(_IN_ORDER) <= len(columns) <= _MOST_NAMES or len(lengths) > 1:
        return None
    cells = [cells[:_MOST_ROWS] for cells in columns.values()]
    return [dict(zip(columns, row, strict=True)) for row in zip(*cells, strict=True)]


def _with_parameters_in_columns(rows: list[object]) -> list[object]:
    """Return the rows, transposed if the lists begin with a, α, d and θ.

    A list of joint numbers may precede these lists.
    """
    lists = [row for row in rows[: len(_IN_ORDER) + 1] if isinstance(row, list)]
    if len(lists) < len(rows) or len({len(row) for row in lists}) > 1 or not lists or not lists[0]:
        return rows
    first = [_header(row[0], {}) for row in lists[-len(_IN_ORDER) :]]
    if sorted(header.column for header in first if header) != sorted(_IN_ORDER):
        return rows
    if len(lists) > len(_IN_ORDER):
        lists[0] = ["i", *lists[0][1:]]
    return [list(row) for row in zip(*lists, strict=True)]


def has_unnamed_columns(answer: object) -> bool:
    """True if the rows are lists without headers, so that only their order gives the columns."""
    rows = answer.get("rows") if isinstance(answer, Mapping) else answer
    if not isinstance(rows, list) or not any(isinstance(row, list) for row in rows):
        return False
    return _columns(_with_parameters_in_columns(rows), {}) is None


def _is_canonical(rows: Sequence[object]) -> bool:
    return all(isinstance(row, dict) and row.keys() == _KEYS for row in rows)


def _canonical_rows(rows: list[object], order: Sequence[str]) -> list[object]:
    names: dict[str, Header | None] = {}
    rows = _with_parameters_in_columns(rows)
    columns = _columns(rows, names)
    body = rows if columns is None else rows[1:]
    if columns is None:
        columns = (LABEL, *order) if _are_numbered(rows[:_MOST_ROWS]) else tuple(order)
    read = [_read_row(row, columns, names) for row in body[:_MOST_ROWS]]
    return [*_in_order(read), *body[_MOST_ROWS:]]


def _columns(rows: list[object], names: dict[str, Header | None]) -> tuple[str, ...] | None:
    """Return the columns of rows that are lists, if the first list has the headers."""
    first = rows[0] if len(rows) > 1 else None
    if not isinstance(first, list) or len(first) not in (4, 5):
        return None
    headers = [_header(cell, names) for cell in first]
    columns = tuple(header.column for header in headers if header and not header.unit)
    is_head = set(_IN_ORDER) <= set(columns) <= {*_IN_ORDER, LABEL}
    return columns if is_head and len(columns) == len(first) == len(set(columns)) else None


def _are_numbered(rows: list[object]) -> bool:
    """True if every row is a list of five values that begins with its own number, or "e"."""
    if not all(isinstance(row, list) and len(row) == len(_IN_ORDER) + 1 for row in rows):
        return False
    numbers = [_number(row[0]) for row in rows if isinstance(row, list)]
    return None not in numbers and len(set(numbers)) == len(numbers)


def _number(cell: object) -> int | None:
    """Return the number of a row. None for 0, and for a length such as l1."""
    place = _place(cell)
    return place if place == LAST or (place and str(cell).strip().isdecimal()) else None


def _place(label: object) -> int | None:
    """Return the place of the row with this label."""
    # Python raises an error if a number of thousands of digits is converted to text.
    is_number = isinstance(label, int | float) and abs(label) < _MOST_ROWS
    return label_place(str(label)) if is_number or isinstance(label, str) else None


def _read_row(row: object, columns: tuple[str, ...], names: dict[str, Header | None]) -> _Read:
    if isinstance(row, Mapping):
        return _by_keys(row, names)
    is_flat = isinstance(row, list) and not any(isinstance(cell, list | dict) for cell in row)
    if not isinstance(row, list) or not is_flat or len(row) != len(columns):
        return None, row
    cells = dict(zip(columns, row, strict=True))
    return cells.pop(LABEL, None), cells


def _by_keys(row: Mapping[str, object], names: dict[str, Header | None]) -> _Read:
    """Return the label and cells of a row that names its values."""
    label: object = None
    cells: dict[str, object] = {}
    for key, value in row.items():
        header = _header(key, names)
        if header is None or header.column == ASIDE:
            continue
        if header.column == LABEL:
            label = value
        elif header.unit or header.column in cells:
            return None, row
        else:
            cells[header.column] = value
    return label, cells or row


def _header(name: object, names: dict[str, Header | None]) -> Header | None:
    """Return the header with this name; ``names`` memoizes those of earlier rows."""
    if not isinstance(name, str):
        return None
    if name not in names:
        names[name] = read_header(name) if len(names) < _MOST_NAMES else None
    return names[name]


def _in_order(rows: Sequence[_Read]) -> list[object]:
    """Return the rows in the order of their labels, or unchanged unless each has its own label."""
    places = [_place(label) for label, _ in rows]
    known = [place for place in places if place is not None]
    if len(known) < len(rows) or len(set(known)) < len(known):
        return [row for _, row in rows]
    return [rows[i][1] for i in sorted(range(len(rows)), key=known.__getitem__)]
