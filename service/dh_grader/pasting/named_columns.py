"""Tables of dictionaries or objects, and what robotics toolboxes print for a robot.

Scripts that build a robot from links are in ``robots.py``.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import islice
from typing import Final

from dh_grader.expressions.errors import Note
from dh_grader.pasting.around import UNIT
from dh_grader.pasting.matrices import rows_in_matlab
from dh_grader.pasting.program import (
    MAKERS,
    arguments,
    excerpt,
    split_call,
    statements,
    text_around,
    unquoted,
    unread_script,
)
from dh_grader.pasting.robots import PARAMETERS, too_many_robots
from dh_grader.pasting.source import (
    CLOSES,
    GRID_LIMITS,
    RobotTable,
    SourceText,
    grid,
    joined,
    strict_pairs,
    too_many_rows,
)
from dh_grader.pasting.uses import first_change, tells
from dh_grader.regex import regex
from dh_grader.translations import say, say_count

# --- Read a DH table that is written as dictionaries in Python, or as objects in JSON
#
# A list may hold one dictionary for each row: ``[{'a': a1, 'alpha': 0, …}, dict(a=a2, …)]``. A
# single dictionary holds columns, ``{'a': [a1, a2], 'alpha': […], 'd': […], 'theta': […]}``, or
# single parameters, ``{alpha0: 0, a0: 0, d1: 0.75, …}``. Four named lists are read, too: ``a = [l1,
# l2]``.


_DICTIONARY: Final = regex(
    r"\{\s{0,40}(?:'[^'\n]{1,40}'|\"[^\"\n]{1,40}\"|[A-Za-z]\w{0,20})\s?:"
    r"|(?<!\w)dict\(\s{0,40}\w{1,20}\s?="
)
_NAME: Final = regex(r"[A-Za-z]\w{0,60}[ \t]*=(?!=)[ \t]*")
_KEY: Final = regex(r"(alpha|al|a|d|theta|th|q|α|θ)_?(\d{1,2})")
_COLUMN_OF: Final = {
    "alpha": "alpha", "al": "alpha", "α": "alpha", "a": "a", "d": "d", "theta": "theta",
    "th": "theta", "θ": "theta", "q": "theta",
}  # fmt: skip
# The beginning of a list with the name of a column, in a statement of its own.
_LIST: Final = regex(
    r"(?:^|(?<=;))[ \t]{0,8}(?:[A-Za-z]\w{0,20}\.)?(alpha|al|a|d|theta|th|q|α|θ)[ \t]{0,8}="
    r"[ \t]{0,8}(?=(?:(?:np\.|sp\.|numpy\.)?\w{1,12}\()?[\[(])",
    re.MULTILINE,
)
_HARMLESS: Final = regex(
    r"(?:syms|import|from|clc|clear|close|format|pkg|class|def)\b"
    r"|\w+\s*=\s*(?:table|length|len|numel|size)\([\w, ]+\)\Z"
)
_DATA_FRAME: Final = "DataFrame"
_UNIT: Final = regex(rf"{UNIT.pattern}|(?<!\w)m(?!\w)", re.IGNORECASE)
_KEYWORDS: Final = frozenset({"data", "columns", "index", "dtype"})
_TITLES: Final = frozenset({"robot", "name", "title", "model"})
_DASH: Final = regex(r"-[ \t]{1,8}(?=\{)")
_OPENS_ITEMS: Final = regex(r"\{|dict\(")


@dataclass(frozen=True, slots=True)
class _Item:
    key: SourceText
    value: SourceText


def describes_columns(text: str) -> bool:
    """True if a text seems to contain a table as dictionaries, named lists or a data frame."""
    # LaTeX has braces and colons, too.
    if "DataFrame(" in text:
        return True
    names = {_COLUMN_OF[found[1]] for found in islice(_LIST.finditer(text), GRID_LIMITS.columns)}
    if len(names) == len(PARAMETERS) or "VariableNames" in text:
        return True
    return (
        (":" in text or "dict(" in text)
        and "\\" not in text
        and _DICTIONARY.search(text) is not None
    )


def read_columns(source: SourceText) -> RobotTable | None:
    """Return the first table that is written as dictionaries or as named lists, or None.

    Raises GridError if the text cannot be read.
    """
    found_statements = statements(source)
    if columns := _named_lists(found_statements):
        return _by_column(*columns, source)
    if rows := _dashed_rows(found_statements):
        return _by_row(rows, source)
    for i, statement in enumerate(found_statements):
        if table := _table_in(statement, source):
            _check_later(statement, found_statements[i + 1 :])
            return table
    return None


def _table_in(statement: SourceText, source: SourceText) -> RobotTable | None:
    if rows := _row_items(statement):
        return _by_row(rows, source)
    if columns := _table_call(statement):
        return _by_column(*columns, source)
    if lines := _listed_rows(statement):
        return RobotTable(grid("rows", lines, source.whole), has_headers=True)
    found = _items(statement)
    keys = [_KEY.fullmatch(item.key.text) for item in found]
    if found and all(keys):
        return _by_index(found, [(_COLUMN_OF[k[1]], int(k[2])) for k in keys if k], source)
    lists = [_list(item.value) for item in found]
    if all(lists) and len(lists) >= len(PARAMETERS):
        return _by_column(found, [each for each in lists if each], source)
    return None


def _check_later(statement: SourceText, later: list[SourceText]) -> None:
    """Raise GridError if a later statement may change the table of a statement."""
    found = _NAME.match(statement.text)
    name = found[0].rstrip("= \t") if found else ""
    if later and later[0].text.strip() == f"{name} =":
        # MATLAB prints the table below its name; a statement has an = or a call.
        later = [each for each in later[1:] if "=" in each.text or "(" in each.text]
    if change := first_change(later, name):
        raise text_around(change)


def _listed_rows(statement: SourceText) -> list[list[SourceText]]:
    """Return the rows of ``DataFrame([[…], …], columns=[…])``, with its headers above them.

    Also return the rows of an object with one list of rows, such as ``{"dh": [[…], …]}``. Return []
    for any other text.
    """
    value = _assigned(statement)
    call = split_call(value)
    if call and call[0] == _DATA_FRAME:
        return _frame_rows(arguments(call[1]))
    items = _items(value) if value.text.startswith("{") else []
    listed = [item.value for item in items if item.value.text[:1] in CLOSES]
    is_clear = not any(
        _UNIT.search(text) or (item.key.text not in _TITLES and tells(text))
        for item in items
        for text in (item.key.text, item.value.text * (item.value not in listed))
    )
    return _rows_of(listed[0]) if len(listed) == 1 and is_clear else []


def _frame_rows(given: list[SourceText]) -> list[list[SourceText]]:
    named: dict[str, SourceText] = {}
    for each in given:
        keyword = _NAME.match(each.text)
        key = keyword[0].rstrip("= \t") if keyword else "data"
        if key in named or key not in _KEYWORDS:
            return []
        named[key] = each.cut(keyword.end() if keyword else 0, len(each.text))
    # The index may be the names of parameters, and then each row is one.
    is_counted = "index" not in named or not re.search(r"[^\W\d]", named["index"].text)
    rows = _rows_of(named["data"]) if "data" in named and is_counted else []
    if "columns" not in named or not rows:
        return rows
    headers = _list(named["columns"])
    return [headers, *rows] if headers else []


def _rows_of(value: SourceText) -> list[list[SourceText]]:
    """Return the values in a list of lists, or []."""
    rows = [_list(each) for each in _elements(value) or []]
    return [row for row in rows if row] if all(rows) else []


def _items(statement: SourceText) -> list[_Item]:
    """Return the items of the dictionary in a statement, or []."""
    value = _value(statement)
    call = split_call(value)
    if call and call[0] == "dict":
        return _keywords(call[1])
    if not value.text.startswith("{") or strict_pairs(value)[0] != len(value.text):
        return []
    items = []
    for piece in arguments(value.cut(1, len(value.text) - 1)):
        key, colon, _ = piece.text.partition(":")
        if not colon:
            return []
        after_colon = piece.cut(len(key) + 1, len(piece.text)).strip()
        items.append(_Item(unquoted(piece.cut(0, len(key)).strip()), after_colon))
    return items


def _value(statement: SourceText) -> SourceText:
    """Return the value of an assignment, without ``DataFrame(…)`` around it."""
    value = _assigned(statement)
    call = split_call(value)
    if call and call[0] == _DATA_FRAME:
        value = (arguments(call[1]) or [call[1]])[0]
    return value


def _assigned(statement: SourceText) -> SourceText:
    name = _NAME.match(statement.text)
    return statement.cut(name.end() if name else 0, len(statement.text)).strip()


def _table_call(statement: SourceText) -> tuple[list[_Item], list[list[SourceText]]] | None:
    """Return the columns of MATLAB's ``table(a, …, 'VariableNames', {'a', …})``, or None."""
    call = split_call(_value(statement))
    given = arguments(call[1]) if call and call[0] == "table" else []
    if len(given) < 3 or given[-2].text.strip("'\"") != "VariableNames":
        return None
    *values, _, names = given
    keys = [unquoted(each) for each in arguments(names.cut(1, len(names.text) - 1))]
    columns = [column for value in values if (column := _column(value))]
    if len(columns) != len(values) or len(keys) != len(values):
        return None
    return [*map(_Item, keys, values)], columns


def _keywords(inside: SourceText) -> list[_Item]:
    """Return the items of ``dict(a=l1, d=0)``; [] if an argument has no name."""
    items = []
    for piece in arguments(inside):
        key, equals, _ = piece.text.partition("=")
        if not equals or not key.strip().isidentifier():
            return []
        value = piece.cut(len(key) + 1, len(piece.text)).strip()
        items.append(_Item(piece.cut(0, len(key)).strip(), unquoted(value)))
    return items


def _row_items(statement: SourceText) -> list[list[_Item]]:
    """Return the items of each dictionary in a list of dictionaries; [] for any other text."""
    value = _value(statement)
    if value.text.startswith("{"):
        # JSON may name the list and the robot: {"robot": "RR", "table": [{…}, {…}]}.
        items = [
            item
            for item in _items(value)
            if item.key.text not in _TITLES or _UNIT.search(item.value.text)
        ]
        if len(items) != 1:
            return []
        value = items[0].value
    if value.text[:1] not in {"[", "("} or strict_pairs(value)[0] != len(value.text):
        return []
    pieces = arguments(value.cut(1, len(value.text) - 1))
    if len(pieces) > GRID_LIMITS.rows or not all(_OPENS_ITEMS.match(each.text) for each in pieces):
        return []
    found = [_items(piece) for piece in pieces]
    return found if all(len(items) >= len(PARAMETERS) for items in found) else []


def _dashed_rows(found: list[SourceText]) -> list[list[_Item]]:
    """Return the items of each dictionary in a list of YAML, ``- {a: l1, …}``, or []."""
    dashes = [_DASH.match(statement.text) for statement in found]
    rows = [
        _items(statement.cut(dash.end(), len(statement.text)))
        for statement, dash in zip(found, dashes, strict=True)
        if dash
    ]
    is_list = len(rows) == len(found) < GRID_LIMITS.rows
    return rows if is_list and all(len(items) >= len(PARAMETERS) for items in rows) else []


def _by_row(rows: list[list[_Item]], source: SourceText) -> RobotTable:
    first = [item.key.text for item in rows[0]]
    cells = [[item.key for item in rows[0]]]
    for row in rows:
        named = {item.key.text: unquoted(item.value) for item in row}
        if len(named) < len(row) or named.keys() != set(first):
            raise unread_script(
                say(
                    "The rows do not have the same names: the first has {names}. "
                    "Give each row the same names.",
                    names=", ".join(first)[:80],
                ),
                row[0].key,
            )
        cells.append([named[name] for name in first])
    return RobotTable(grid("dictionaries", cells, source.whole), has_headers=True)


def _list(value: SourceText) -> list[SourceText] | None:
    """Return the values in a list such as ``[1, 2]`` or ``np.array([1, 2])``, or None."""
    elements = _elements(value)
    return None if elements is None else [unquoted(each) for each in elements]


def _elements(value: SourceText) -> list[SourceText] | None:
    call = split_call(value)
    if call and call[0] in MAKERS:
        value = call[1].strip()
    if value.text[:1] not in {"[", "("} or strict_pairs(value)[0] != len(value.text):
        return None
    return arguments(value.cut(1, len(value.text) - 1))


def _named_lists(
    found: list[SourceText],
) -> tuple[list[_Item], list[list[SourceText]]] | None:
    # Return the names and values of four lists, a, alpha, d and theta; None for any other text.
    items, columns = [], []
    for statement in found:
        name = _LIST.match(statement.text)
        value = statement.cut(name.end(), len(statement.text)) if name else statement
        column = _column(value.strip()) if name else None
        if name and column:
            items.append(_Item(statement.cut(*name.span(1)), value))
            columns.append(column)
        elif not _HARMLESS.match(statement.text):
            return None
    names = [_COLUMN_OF[item.key.text] for item in items]
    return (items, columns) if sorted(names) == sorted(PARAMETERS) else None


def _column(value: SourceText) -> list[SourceText] | None:
    """Return the values in a list of Python, or in a row or column of MATLAB."""
    if value.text[:1] != "[" or "," in value.text or strict_pairs(value)[0] != len(value.text):
        return _list(value)
    found, _ = rows_in_matlab(value.cut(1, len(value.text) - 1))
    if len(found) == 1:
        return found[0]
    return [row[0] for row in found] if all(len(row) == 1 for row in found) else None


def _by_column(
    items: list[_Item], columns: list[list[SourceText]], source: SourceText
) -> RobotTable:
    longest = max(columns, key=len)
    for item, column in zip(items, columns, strict=True):
        if len(column) != len(longest):
            raise unread_script(
                say_count(
                    "The column {name} has one value, another has {most}. "
                    "Write one for each joint.",
                    "The column {name} has {count} values, another has {most}. "
                    "Write one for each joint.",
                    count=len(column),
                    name=excerpt(item.key),
                    most=len(longest),
                ),
                item.value,
            )
    rows = [[item.key for item in items], *map(list, zip(*columns, strict=True))]
    return RobotTable(grid("dictionary", rows, source.whole), has_headers=True)


def _by_index(
    items: list[_Item], keys: list[tuple[str, int]], source: SourceText
) -> RobotTable | None:
    # Return the table of parameters such as ``alpha0``; None unless they are a whole table.
    # If d or θ is missing in a row, the cell is the joint variable ``d1``, ``q1`` and so on.
    cells = dict(zip(keys, (item.value for item in items), strict=True))
    numbers = {index for column, index in keys if column in ("d", "theta")}
    count = max(numbers, default=0)
    if count >= GRID_LIMITS.rows:
        raise too_many_rows(source.whole)
    before = {index for column, index in keys if column in ("a", "alpha")}
    shift = 1 if 0 in before else 0
    is_whole = numbers == set(range(1, count + 1)) and len(cells) == len(keys)
    needed = {(column, i - shift) for column in ("a", "alpha") for i in numbers}
    if not is_whole or not needed or needed != {key for key in keys if key[0] in ("a", "alpha")}:
        return None
    rows = [_indexed_row(cells, i, shift) for i in range(1, count + 1)]
    first, last = items[0].key.whole, items[-1].value.whole
    message = say("The indices say which row a parameter belongs to.")
    if shift:
        message = say(
            "The indices say which row a parameter belongs to; those of alpha and a are one less, "
            "as in the modified convention."
        )
    notes = [Note("indexed_parameters", message, (first[0], last[1]))]
    table = grid("dictionary", rows, source.whole, notes)
    return RobotTable(table, "modified" if shift else None)


def _indexed_row(
    cells: Mapping[tuple[str, int], SourceText], number: int, shift: int
) -> list[SourceText]:
    d, theta = cells.get(("d", number)), cells.get(("theta", number))
    beside = d or theta
    assert beside is not None
    return [
        cells["a", number - shift],
        cells["alpha", number - shift],
        d or beside.spelled(f"d{number}"),
        theta or beside.spelled(f"q{number}"),
    ]


# --- Read the table that P. Corke's Robotics Toolboxes print for a robot, in MATLAB and in Python
#
# The first line names the convention: ``arm:: 3 axis, RRR, stdDH, slowRNE`` or ``DHRobot: arm, 3
# joints (RRR), standard DH parameters``.
#
# Angles without a unit are in radians.


_FIRST_LINE: Final = regex(
    r"(?:::[ \t]{0,4}|\()(?P<axes>\d{1,2}) axis, [RP]{1,12}, (?P<matlab>std|mod)DH"
    r"|(?P<joints>\d{1,2}) joints? \([RP]{1,12}\),[^\n]{0,80}?"
    r"(?P<python>standard|modified) DH parameters"
)
# The headers that the toolbox for MATLAB prints, if the first line is missing.
_BOX: Final = regex(
    r"^[ \t]*\|[ \t]*j[ \t]*\|[ \t]*theta[ \t]*\|[ \t]*d[ \t]*\|[ \t]*a[ \t]*\|[ \t]*alpha[ \t]*"
    r"\|[ \t]*offset[ \t]*\|",
    re.MULTILINE,
)
_BARS: Final = regex(r"[|│┃║]")
_HEADERS: Final[Mapping[str, str]] = {
    "theta": "theta", "θ": "theta", "d": "d", "a": "a", "alpha": "alpha", "⍺": "alpha",
    "α": "alpha", "offset": "offset",
}  # fmt: skip
_CONVENTIONS: Final = {"std": "standard", "sta": "standard", "mod": "modified"}
_INDEX: Final = " ⱼ₋₁"
# A line below the headers without values, as Markdown draws it.
_RULE: Final = regex(r"[\s|│┃║:=\-]+")
_INDEXED: Final = r"[ _]?\{?[\d₁-₉]"
# The joint variable, as the toolbox prints it or as a student writes it into the table.
_VARIABLE: Final = regex(rf"[$\\]{{0,2}}(?:q|th|theta|θ|ϑ){_INDEXED}", re.IGNORECASE)
_SLIDING: Final = regex(rf"\$?q{_INDEXED}", re.IGNORECASE)
_ZERO: Final = regex(r"-?0(?:\.0*)?°?")
_BASE_OR_TOOL: Final = regex(r"(?<![^\W\d_])(?:tool|base)(?![^\W\d_])")
_NUMBER: Final = regex(r"(?<![\w.])-?\d{1,12}(?:\.\d{0,12})?(?![\w.])")
# The numbers of two unit matrices side by side, as older versions print base and tool.
_UNIT_MATRICES: Final = [[float(i == j) for j in range(4)] * 2 for i in range(4)]


def describes_print(text: str) -> bool:
    """True if a text contains a robot as P. Corke's Robotics Toolbox prints it."""
    return _FIRST_LINE.search(text) is not None or _BOX.search(text) is not None


def read_print(source: SourceText) -> RobotTable:
    """Return the table of the printed robot. Raises GridError if the table is not certain."""
    # GridError if there are several robots, if the table is incomplete, or if the robot has a base
    # or a tool.
    found = list(_FIRST_LINE.finditer(source.text))
    if len(found) > 1 or len(_BOX.findall(source.text)) > 1:
        raise too_many_robots(source)
    rows, rest = _table(source.cut(found[0].end() if found else 0, len(source.text)))
    columns = [_HEADERS.get(cell.text.strip(_INDEX)) for cell in rows[0]] if rows else []
    count = int(found[0]["axes"] or found[0]["joints"]) if found else len(rows) - 1
    is_whole = len(rows) - 1 == count > 0 and (bool(found) or _BARS.search(rest) is None)
    if not is_whole or any(columns.count(name) != 1 for name in PARAMETERS):
        raise unread_script(
            say("The table below this line is not complete. Paste it with its line of headers."),
            source,
        )
    if _has_frames(rest):
        raise unread_script(
            say(
                "The robot has a base or a tool, which this table does not show. Write the "
                "DH table with its headers, without the rest."
            ),
            source,
        )
    for row in rows[1:]:
        if len(row) != len(columns):
            raise unread_script(
                say("This row is not complete. Copy the whole table again."), row[0]
            )
    cells = [_cells(row, columns) for row in rows[1:]]
    names = [first["matlab"] or first["python"] for first in found]
    convention = _CONVENTIONS[names[0][:3]] if names else None
    return RobotTable(grid("toolbox", cells, source.whole), convention)


def _table(source: SourceText) -> tuple[list[list[SourceText]], str]:
    rows: list[list[SourceText]] = []
    lines = source.lines()
    for i, line in enumerate(lines):
        plain = line.strip()
        if _BARS.match(plain.text) and _RULE.fullmatch(plain.text):
            continue
        if _BARS.match(plain.text):
            rows.append([cell.strip() for cell in plain.split(_BARS)[1:-1]])
        elif rows and plain.text[:1] not in {"+", "├", "┣", "╠"}:
            return rows, "\n".join(line.text for line in lines[i:])
    return rows, ""


def _cells(row: list[SourceText], columns: list[str | None]) -> list[SourceText]:
    named = {name: cell for name, cell in zip(columns, row, strict=True) if name}
    offset = named.get("offset")
    if offset is not None and not _ZERO.fullmatch(offset.text):
        variable = "theta" if _VARIABLE.match(named["theta"].text) else "d"
        if variable == "d" and not _SLIDING.match(named["d"].text):
            message = say(
                "This offset may belong to θ or to d. Add it to the value in one of them."
            )
            raise unread_script(message, offset)
        cell = named[variable]
        parts = [cell, cell.spelled(" + ("), offset, offset.spelled(")")]
        named[variable] = joined(parts, cell.at)
    return [named[name] for name in PARAMETERS]


def _has_frames(rest: str) -> bool:
    """True if the robot has a base or a tool that is not the unit matrix."""
    if not _BASE_OR_TOOL.search(rest):
        return False
    lines = [line for line in rest.splitlines() if line.strip()]
    numbers = [[float(number) for number in _NUMBER.findall(line)] for line in lines]
    if [each[-8:] for each in numbers[:4]] == _UNIT_MATRICES:
        return any(map(_BASE_OR_TOOL.search, lines[4:]))
    return any(
        any(each) for line, each in zip(lines, numbers, strict=True) if _BASE_OR_TOOL.search(line)
    )
