"""Read the table that P. Corke's Robotics Toolboxes print for a robot, in MATLAB and in Python.

The first line names the convention: ``arm:: 3 axis, RRR, stdDH, slowRNE`` or ``DHRobot: arm, 3
joints (RRR), standard DH parameters``.
"""

# Angles without a unit are in radians.

import re
from collections.abc import Mapping
from typing import Final

from service.grids.cutting.grid import grid
from service.grids.cutting.source_text import SourceText, joined
from service.grids.scripts.script import RobotTable, unread_script
from service.grids.scripts.script_names import too_many_robots
from service.regex import regex
from service.translations import say

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
_COLUMNS: Final = ("a", "alpha", "d", "theta")
# A line below the headers without values, as Markdown draws it.
_RULE: Final = regex(r"[\s|│┃║:=\-]+")
_INDEXED: Final = r"[ _]?\{?[\d₁-₉]"
# The joint variable, as the toolbox prints it or as a student writes it into the table.
_VARIABLE: Final = regex(rf"[$\\]{{0,2}}(?:q|th|theta|θ|ϑ){_INDEXED}", re.IGNORECASE)
_SLIDING: Final = regex(rf"\$?q{_INDEXED}", re.IGNORECASE)
_ZERO: Final = regex(r"-?0(?:\.0*)?°?")
_FRAME: Final = regex(r"(?<![^\W\d_])(?:tool|base)(?![^\W\d_])")
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
    if not is_whole or any(columns.count(name) != 1 for name in _COLUMNS):
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
    return [named[name] for name in _COLUMNS]


def _has_frames(rest: str) -> bool:
    """True if the robot has a base or a tool that is not the unit matrix."""
    if not _FRAME.search(rest):
        return False
    lines = [line for line in rest.splitlines() if line.strip()]
    numbers = [[float(number) for number in _NUMBER.findall(line)] for line in lines]
    if [each[-8:] for each in numbers[:4]] == _UNIT_MATRICES:
        return any(map(_FRAME.search, lines[4:]))
    return any(any(each) for line, each in zip(lines, numbers, strict=True) if _FRAME.search(line))
