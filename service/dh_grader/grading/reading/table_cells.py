"""Find the four cells of each row of a DH table, in JSON or text, and read them as entries.

This file knows the shapes that an answer in JSON may have, and what the names of cells mean. The
rows of a pasted table are found by ``pasted_table.py``.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from itertools import accumulate
from typing import Final, NamedTuple

from dh_grader.expressions import AngleUnit, LeftSide, Vocabulary
from dh_grader.expressions.vocabulary import normal_form
from dh_grader.grading.numbers import Samples
from dh_grader.grading.reading.entries import (
    Arrangement,
    Entry,
    Places,
    Reader,
    arranged,
    misnamed_value,
    name_of,
    unreadable,
    with_order_note,
)
from dh_grader.grading.reading.headers import (
    ASIDE,
    LABEL,
    LAST,
    QUANTITIES,
    SHOWN,
    Header,
    label_place,
    named_parameter,
    read_header,
)
from dh_grader.grading.report import MAX_SYMBOLS, Finding, WorkBudget
from dh_grader.kinematics import COLUMNS
from dh_grader.regex import regex
from dh_grader.translations import say

# --- Read the cells of one row as entries


# Longer rows are not memoized: hardly any two students write the same one.
_LONGEST_MEMOIZED: Final = 60
_MEMOIZED: Final = 4096
_NO_SAMPLES: Final = Samples({})


def read_row(cells: Sequence[object], number: int | None, reader: Reader) -> tuple[Entry, ...]:
    """Read the four cells of one row as entries.

    A cell is a JSON value, or the finding that says why the cell is unreadable. ``number`` is the
    number of the row, None if unknown.
    """
    found = arranged_row(cells, reader.vocabulary)
    ordered = [cells[i] for i in found.order] if found else cells

    def read(column: int) -> Entry:
        raw = ordered[column]
        if isinstance(raw, Finding):
            return unreadable(raw)
        return reader.read(raw, QUANTITIES[COLUMNS[column]], in_table=True)

    return row_entries(ordered, found, number, read, lambda _, entry: entry, reader.vocabulary)


def memoized_row(cells: Sequence[object], reader: Reader) -> tuple[Entry, ...] | None:
    """Return the memoized entries of a row of short, readable texts; None for any other row."""
    # Most students of a class write the same rows, and a lookup takes a tenth of reading one. Rows
    # with names, such as ``theta_1 = q1``, are not memoized: they depend on the row's number.
    a, alpha, d, theta = cells
    if not (type(a) is type(alpha) is type(d) is type(theta) is str):
        return None
    if len(a) + len(alpha) + len(d) + len(theta) > _LONGEST_MEMOIZED:
        return None
    found = _read_texts((a, alpha, d, theta), reader.vocabulary, reader.angle_unit)
    if found is None or found.symbols > reader.budget.symbols:
        return None
    reader.budget.symbols -= found.symbols
    # Equal rows of a table are different objects, by which the report tells them apart.
    return (*found.entries,)


class _MemoizedRow(NamedTuple):
    # ``symbols`` is the number of names, numbers and signs in the text of the row.
    entries: tuple[Entry, ...]
    symbols: int


@lru_cache(maxsize=_MEMOIZED)
def _read_texts(
    texts: tuple[str, str, str, str], vocabulary: Vocabulary, angle_unit: AngleUnit
) -> _MemoizedRow | None:
    if any(name_of(text, vocabulary) for text in texts):
        return None
    budget = WorkBudget(repairs=0)
    reader = Reader(vocabulary, _NO_SAMPLES, angle_unit, None, budget)
    entries = read_row(texts, None, reader)
    # Rows that need repairs are not memoized: each submission must pay for its own repairs.
    is_plain = budget.repairs == 0 and all(entry.readable for entry in entries)
    return _MemoizedRow(entries, MAX_SYMBOLS - budget.symbols) if is_plain else None


# --- Find the column and row that a cell's name means, as in theta_1 = q1


_LABELS: Final = tuple(SHOWN[column] for column in COLUMNS)
# The parameters that the modified convention numbers one less than their row.
_SHIFTED: Final = frozenset({"a", "alpha"})


def arranged_row(cells: Sequence[object], vocabulary: Vocabulary) -> Arrangement | None:
    """Arrange the four cells of a row by their names; None if they are in order."""
    return arranged(cells, _LABELS, _columns_of, vocabulary)


def _columns_of(names: Sequence[LeftSide | None], _: Vocabulary) -> list[Places]:
    found = [named_parameter(name.name) if name else None for name in names]
    return [(COLUMNS.index(each.column),) if each else None for each in found]


def first_number(rows: Sequence[Sequence[object]], vocabulary: Vocabulary) -> int | None:
    """Return the number of the first row: 0 if its θ or d has the index 0, else 1.

    Return None for a single row, which may belong to any joint.
    """
    if len(rows) < 2:
        return None
    names = [name_of(cell, vocabulary) for cell in rows[0]]
    named = [named_parameter(name.name) for name in names if name]
    counts_from_zero = any(each and each.row == 0 and each.column not in _SHIFTED for each in named)
    return 0 if counts_from_zero else 1


def row_entries(
    cells: Sequence[object],
    found: Arrangement | None,
    number: int | None,
    read: Callable[[int], Entry],
    placed: Callable[[int, Entry], Entry],
    vocabulary: Vocabulary,
) -> tuple[Entry, ...]:
    """Return the entries of a row whose ``cells`` were arranged by their names.

    ``found`` is the arrangement. ``read`` returns the entry of a column. ``placed`` moves the spans
    of an entry from its cell to the whole text.
    """
    entries: list[Entry] = []
    for column, cell in enumerate(cells):
        wrong = found.misnamed.get(column) if found else None
        entry = unreadable(wrong) if wrong else read(column)
        if wrong is None and number is not None and entry.findings:
            wrong = _names_another_row(cell, COLUMNS[column], entry, number, vocabulary)
        entries.append(placed(column, unreadable(wrong)) if wrong else entry)
    if found is None or not found.by_name:
        return tuple(entries)
    return with_order_note(entries, say("The cells of a row were ordered by their names."))


def _names_another_row(
    cell: object, column: str, entry: Entry, number: int, vocabulary: Vocabulary
) -> Finding | None:
    # Such as θ2 = … in row 1. None for a cell such as θ2 = θ2, which contains the variable that it
    # is named after.
    name = name_of(cell, vocabulary)
    named = named_parameter(name.name) if name else None
    if name is None or named is None or named.row is None or entry.expression is None:
        return None
    if named.row == number or (named.row == number - 1 and column in _SHIFTED):
        return None
    symbol = vocabulary.by_name.get(normal_form(name.name))
    if symbol is not None and symbol.name in entry.expression.symbols:
        return None
    return misnamed_value(name, say("{parameter} (row {row})", parameter=SHOWN[column], row=number))


# --- Convert the shapes that a table may have in JSON to the one that the reader expects


_KEYS: Final = QUANTITIES.keys()
_IN_ORDER: Final = (*QUANTITIES,)
# Rows beyond these are counted but not read, and names beyond these are ignored.
_MOST_ROWS: Final = 16
_MOST_NAMES: Final = 40

# A row's label, if it has one, and its cells by column; or None and the row as it was sent.
_LabelledRow = tuple[object, object]


def canonical_table(answer: object, order: Sequence[str] = _IN_ORDER) -> object:
    """Convert a table to ``{"rows": [{"a", "alpha", "d", "theta"} …], …}``. Never raises.

    The answer may be a mapping with ``rows`` (other fields are kept), the list of rows alone, or a
    mapping from headers to lists. A row may be a mapping whose keys are headers, or a list in
    ``order``. A list of four headers may precede rows that are lists; or each list has the values
    of one parameter, after its header. Headers have any spelling ("α", "alpha_i", "twist"). Rows
    are sorted if all have a number or "e".

    A row of any other form is unchanged. So is a row whose keys have a unit, or name one column
    twice: the reader then refuses the row, or reads the cells that it knows. An answer without any
    row is returned unchanged.
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


def has_unnamed_columns(answer: object) -> bool:
    """True if the rows are lists without headers, so that only their order gives the columns."""
    rows = answer.get("rows") if isinstance(answer, Mapping) else answer
    if not isinstance(rows, list) or not any(isinstance(row, list) for row in rows):
        return False
    return _columns(_with_parameters_in_columns(rows), {}) is None


def _from_columns(answer: Mapping[str, object]) -> list[object] | None:
    columns = {key: cells for key, cells in answer.items() if isinstance(cells, list)}
    lengths = {len(cells) for cells in columns.values()}
    if not len(_IN_ORDER) <= len(columns) <= _MOST_NAMES or len(lengths) > 1:
        return None
    cells = [cells[:_MOST_ROWS] for cells in columns.values()]
    return [dict(zip(columns, row, strict=True)) for row in zip(*cells, strict=True)]


def _with_parameters_in_columns(rows: list[object]) -> list[object]:
    # A list of joint numbers may precede the lists that begin with a, α, d and θ.
    lists = [row for row in rows[: len(_IN_ORDER) + 1] if isinstance(row, list)]
    if len(lists) < len(rows) or len({len(row) for row in lists}) > 1 or not lists or not lists[0]:
        return rows
    first = [_header(row[0], {}) for row in lists[-len(_IN_ORDER) :]]
    if sorted(header.column for header in first if header) != sorted(_IN_ORDER):
        return rows
    if len(lists) > len(_IN_ORDER):
        lists[0] = ["i", *lists[0][1:]]
    return [list(row) for row in zip(*lists, strict=True)]


def _is_canonical(rows: Sequence[object]) -> bool:
    return all(isinstance(row, dict) and row.keys() == _KEYS for row in rows)


def _canonical_rows(rows: list[object], order: Sequence[str]) -> list[object]:
    names: dict[str, Header | None] = {}
    rows = _with_parameters_in_columns(rows)
    columns = _columns(rows, names)
    body = rows if columns is None else rows[1:]
    if columns is None:
        columns = (LABEL, *order) if _are_numbered(rows[:_MOST_ROWS]) else tuple(order)
    read = [_labelled_row(row, columns, names) for row in body[:_MOST_ROWS]]
    return [*_in_order(read), *body[_MOST_ROWS:]]


def _columns(rows: list[object], names: dict[str, Header | None]) -> tuple[str, ...] | None:
    first = rows[0] if len(rows) > 1 else None
    if not isinstance(first, list) or len(first) not in (4, 5):
        return None
    headers = [_header(cell, names) for cell in first]
    columns = tuple(header.column for header in headers if header and not header.unit)
    is_head = set(_IN_ORDER) <= set(columns) <= {*_IN_ORDER, LABEL}
    return columns if is_head and len(columns) == len(first) == len(set(columns)) else None


def _are_numbered(rows: list[object]) -> bool:
    # Five values, the first of which is the row's number, or "e".
    if not all(isinstance(row, list) and len(row) == len(_IN_ORDER) + 1 for row in rows):
        return False
    numbers = [_number(row[0]) for row in rows if isinstance(row, list)]
    return None not in numbers and len(set(numbers)) == len(numbers)


def _number(cell: object) -> int | None:
    # None for 0, and for a length such as l1.
    place = _place(cell)
    return place if place == LAST or (place and str(cell).strip().isdecimal()) else None


def _place(label: object) -> int | None:
    # Python raises an error if a number of thousands of digits is converted to text.
    is_number = isinstance(label, int | float) and abs(label) < _MOST_ROWS
    return label_place(str(label)) if is_number or isinstance(label, str) else None


def _labelled_row(
    row: object, columns: tuple[str, ...], names: dict[str, Header | None]
) -> _LabelledRow:
    if isinstance(row, Mapping):
        return _by_keys(row, names)
    is_flat = isinstance(row, list) and not any(isinstance(cell, list | dict) for cell in row)
    if not isinstance(row, list) or not is_flat or len(row) != len(columns):
        return None, row
    cells = dict(zip(columns, row, strict=True))
    return cells.pop(LABEL, None), cells


def _by_keys(row: Mapping[str, object], names: dict[str, Header | None]) -> _LabelledRow:
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
    # ``names`` memoizes the headers of earlier rows.
    if not isinstance(name, str):
        return None
    if name not in names:
        names[name] = read_header(name) if len(names) < _MOST_NAMES else None
    return names[name]


def _in_order(rows: Sequence[_LabelledRow]) -> list[object]:
    # If a label is missing or occurs twice, the rows keep their own order.
    places = [_place(label) for label, _ in rows]
    known = [place for place in places if place is not None]
    if len(known) < len(rows) or len(set(known)) < len(known):
        return [row for _, row in rows]
    return [rows[i][1] for i in sorted(range(len(rows)), key=known.__getitem__)]


# --- Find the cells in the text of one row


_LONGEST_TEXT: Final = 2_000
# A name before = or a colon, with or without an index: a, \alpha_1, θ₁.
_NAMED: Final = regex(
    r"(?<![^\s,;({\[$|&])(\\?[A-Za-z\u0370-\u03ff⍺]+)(?:_?\{?[0-9]\}?|_\{?i\}?|[₀-₉])?\s{0,8}[=:]"
)
_BETWEEN: Final = regex(r"(?:[\s,;$|&]|\\[,;: ]|\\\\|\\quad|\\qquad|\band\b)+")
# The separators of rows in MATLAB, and of lines.
_ENDS: Final = regex(r"[;\n]")
# Four values separated by blanks only: a sign with blanks on both sides is an operator.
_FOUR_VALUES: Final = regex(
    r"\s*(?:[-+]?[^\s,;=+*/^-](?:[^\s,;=]*[^\s,;=+*/^-])?(?:[ \t]+|\s*$)){4}"
)
_BLANK: Final = regex(r"[ \t](?=[^ \t])")
_STYLE: Final = regex(r"\\(?:text|textrm|textit|mathrm|mathit|operatorname)\s?\{([^{}]*)\}")
_NONE: Final = regex(
    r"none|n/a|no (?:dh )?row|there is (?:none|no row)|does(?: not|n't) exist|\{none: ?true\}"
)


class NamedCell(NamedTuple):
    """The text of a cell, and the place in the whole text where it begins."""

    text: str
    start: int


def named_cells(text: str) -> Mapping[str, NamedCell] | None:
    """Return the cells of a text such as ``a=3, d=2, theta=90deg, alpha=0`` by column.

    The order is free. Separators are commas, semicolons, blanks or line ends; a colon may replace
    ``=``. The mapping is empty if a parameter is named twice. Return None for any other text.
    """
    if len(text) > _LONGEST_TEXT:
        return None
    names = list(_NAMED.finditer(text))
    if not names or text[: names[0].start()].strip(" \t\n([{$"):
        return None
    cells: dict[str, NamedCell] = {}
    ends = [name.start() for name in names[1:]] + [len(text)]
    for name, end in zip(names, ends, strict=True):
        named = named_parameter(name[1])
        if named is None:
            return None
        if named.column in cells:
            return {}
        cells[named.column] = _trimmed(text, name.end(), end)
    return cells


def _trimmed(text: str, start: int, end: int) -> NamedCell:
    while leading := _BETWEEN.match(text, start, end):
        start = leading.end()
    value = text[start:end]
    for trailing in _BETWEEN.finditer(value):
        if trailing.end() == len(value):
            value = value[: trailing.start()]
            break
    return NamedCell(value, start)


def in_one_line(text: str) -> str:
    """Return the text of a row with commas between its values and without outer round brackets.

    No character moves, so that spans stay valid.
    """
    if len(text) > _LONGEST_TEXT:
        return text
    first, last = len(text) - len(text.lstrip()), len(text.rstrip())
    if _is_enclosed(text[first:last]):
        text = f"{text[:first]} {text[first + 1 : last - 1]} {text[last:]}"
    if "," not in text and len(_ENDS.findall(text.strip())) == len(QUANTITIES) - 1:
        return text[:first] + _ENDS.sub(",", text[first:last]) + text[last:]
    if _FOUR_VALUES.fullmatch(text):
        return text[:first] + _BLANK.sub(",", text[first:last]) + text[last:]
    return text


def _is_enclosed(text: str) -> bool:
    # The last character closes the first bracket.
    if not (text.startswith("(") and text.endswith(")")):
        return False
    depths = accumulate({"(": 1, ")": -1}.get(sign, 0) for sign in text[:-1])
    return min(depths) > 0


def says_none(text: str) -> bool:
    r"""True if the text says that there is no row: none, n/a, \text{none}."""
    if len(text) > _LONGEST_TEXT:
        return False
    plain = _STYLE.sub(r"\1", text)
    plain = "".join(sign for sign in plain if sign not in "$\"'“”").strip().rstrip(".!").lower()
    return _NONE.fullmatch(" ".join(plain.split())) is not None
