"""Read the grids (tables and matrices) in pasted texts, and report errors in them."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import reduce
from itertools import islice
from typing import Final, TypeVar

from service.expressions.characters.decimal_comma import with_points
from service.grading.feedback import Finding
from service.grading.reading.entry import Entry, Reader
from service.grading.reading.given_letters import with_given_letters
from service.grading.reading.tables.words import ANGLE_UNITS, METRES
from service.grading.work_budget import MAX_PASTED, MAX_PASTED_SIGNS
from service.grids import (
    GRID_LIMITS,
    Grid,
    GridCell,
    GridError,
    NamedGrid,
    RobotTable,
    read_grid,
    read_grids,
    read_robot,
)
from service.grids.cutting.once import remembering
from service.grids.cutting.source_text import line_number
from service.regex import regex
from service.time_slices import checkpoint
from service.translations import say

R = TypeVar("R")

# An index in square brackets: theta[1], l[2].
_INDEX: Final = regex(r"((?<![^\W\d])[^\W\d_]{1,6}_?)\[(\s?[0-9]{1,2}\s?)\]")
_IN_UNIT: Final = regex(
    r"(?<![^\W\d_])(?:in|en|and|und|y|et) ([^\W\d_]{1,12})(?![^\W\d_])", re.IGNORECASE
)
# A unit in a header: a [mm], alpha (deg).
_HEADED_UNIT: Final = regex(r"[\[(]\s?([^\W\d_]{1,12}|°)\s?[\])]")
_MOST_UNITS: Final = 40
# The codes of errors whose messages say "this bracket" or "this row".
_AT_A_PLACE: Final = frozenset(
    {"unclosed_quote", "stray_quote", "unbalanced_bracket", "unbalanced_environment"}
    | {"unclosed_tag", "unread_tag", "mixed_separators"}
)
_JOINT_VARIABLES: Final = frozenset({"q", "th", "theta", "θ", "ϑ"})


def pasted_grid(text: str, reader: Reader, *, of_table: bool = False) -> Grid:
    """Return the table or matrix in a pasted text. Raises GridError if there is none."""
    # Also raised if the pasted texts of a submission are too long.

    def read() -> Grid:
        grid = read_grid(_prepared(text, reader), of_table=of_table)
        return with_given_letters(grid, text, reader)

    return _cut("table" if of_table else "grid", text, reader, read)


def pasted_robot(text: str, reader: Reader) -> RobotTable | None:
    """Return the DH table of the robot that a pasted script describes; None for any other text.

    Raises GridError if the script's table is ambiguous.
    """
    # Also raised if the pasted texts of a submission are too long.

    def read() -> RobotTable | None:
        robot = read_robot(_without_own_units(text, reader))
        if robot is None:
            return None
        return replace(robot, grid=with_given_letters(robot.grid, text, reader))

    return _cut("robot", text, reader, read)


def pasted_grids(text: str, reader: Reader) -> tuple[NamedGrid, ...]:
    """Return the matrices in a pasted text, with their names. May raise GridError."""
    return _cut("grids", text, reader, lambda: read_grids(_prepared(text, reader)))


def grids_as_written(text: str, reader: Reader) -> tuple[NamedGrid, ...]:
    """Return the matrices in a pasted text with its indices, of which none is ambiguous here.

    May raise GridError.
    """
    return _cut("grids as written", text, reader, lambda: read_grids(text))


def _cut(way: str, text: str, reader: Reader, read: Callable[[], R]) -> R:
    # Raises GridError if the text may not be cut.
    _charge(text, reader)
    with remembering(reader.budget.searched):
        return once(way, text, reader, read)


def once(way: str, text: str, reader: Reader, read: Callable[[], R]) -> R:
    """Read a text in one way, and remember what is found; raise its GridError again and again."""
    # A text may stand in several places of a submission, and several parts of the grader read it.
    checkpoint()
    found = reader.budget.found
    key = way, text, reader.angle_unit, reader.length_unit
    if key not in found:
        try:
            found[key] = read()
        except GridError as error:
            found[key] = error
    result = found[key]
    if isinstance(result, GridError):
        raise GridError(result.code, result.message, result.span)
    again: R = result
    return again


def _prepared(text: str, reader: Reader) -> str:
    # Decimal points for decimal commas, and unambiguous indices.
    if reader.vocabulary.decimal_comma:
        text = with_points(text)
    return _with_indices_from_one(_without_own_units(text, reader), reader)


def stated_units(text: str) -> set[str]:
    """Return the units in sentences and comments such as "all lengths in mm", in small letters."""
    found = {unit[1].lower() for unit in islice(_IN_UNIT.finditer(text), _MOST_UNITS)}
    return found & (ANGLE_UNITS.keys() | METRES.keys())


def _without_own_units(text: str, reader: Reader) -> str:
    # "in radians" in "all angles in radians" becomes blanks if that is the unit. Every character
    # keeps its place. Another unit stays, and such a sentence is refused; so is a sentence that
    # contradicts a header with another unit.
    length = METRES.get(reader.length_unit or "", 0)
    headed = {unit[1].lower() for unit in islice(_HEADED_UNIT.finditer(text), _MOST_UNITS)}
    own: set[str] = set()
    for units, wanted in ((ANGLE_UNITS, reader.angle_unit), (METRES, length)):
        if all(units.get(unit, wanted) == wanted for unit in headed):
            own.update(unit for unit, meant in units.items() if meant == wanted)

    def without_unit(found: re.Match[str]) -> str:
        return " " * len(found[0]) if found[1].lower() in own else found[0]

    return _IN_UNIT.sub(without_unit, text)


def _with_indices_from_one(text: str, reader: Reader) -> str:
    # theta[1] becomes theta(1) if its indices count from 1, as in Maple. They count from 0 if a
    # joint variable has the index 0, and from 1 if one has the number of the last joint as its
    # index. Other indices are ambiguous. Every character keeps its place.
    found = [each for each in _INDEX.finditer(text) if each[1].rstrip("_") in _JOINT_VARIABLES]
    numbers = {int(each[2]) for each in found}
    joints = reader.vocabulary.joints
    if not numbers or 0 in numbers or not joints:
        return text
    if joints[-1] not in numbers:
        name, index = found[0][1].rstrip("_"), int(found[0][2])
        raise GridError(
            "ambiguous_index",
            say(
                "`{name}[{index}]` is joint {next} in Python and joint {index} in Maple. "
                "Write {name}{next} or {name}{index}.",
                name=name,
                index=index,
                next=index + 1,
            ),
            found[0].span(),
        )
    return _INDEX.sub(r"\1(\2)", text)


def _charge(text: str, reader: Reader) -> None:
    """Charge the cutting of a text. Raises GridError if it may not be cut."""
    if len(text) > GRID_LIMITS.characters or reader.budget.charge_pasted(text):
        # A text that is too long is not cut.
        return
    message = say("The pasted texts have more than {most:,} characters together.", most=MAX_PASTED)
    if reader.budget.pasted >= 0:
        message = say(
            "The pasted texts have more than {most:,} brackets and quotation marks together.",
            most=MAX_PASTED_SIGNS,
        )
    raise GridError("too_long", message, (0, len(text)))


def from_grid_error(error: GridError, text: str = "") -> Finding:
    """Return the finding that a pasted text is not a table or matrix.

    If the error is about one place in several lines of ``text``, the message names its line.
    """
    code = "wrong_shape" if error.code == "no_grid" else error.code
    message = error.message
    if code in _AT_A_PLACE and line_number(text, len(text)) > 1:
        line = line_number(text, error.span[0])
        message = say("Line {line}: {message}", line=line, message=message)
    return Finding(code, message, span=error.span, reading=True)


def placed(entry: Entry, cell: GridCell) -> Entry:
    """Return the entry with its spans counted in the whole pasted text instead of in the cell."""
    if not entry.findings:
        return entry
    findings = tuple(
        replace(finding, span=cell.span(*finding.span) if finding.span else cell.whole)
        for finding in entry.findings
    )
    return replace(entry, findings=findings)


def place_of(cells: Sequence[GridCell]) -> tuple[int, int]:
    """Return the span (start and end) of neighbouring cells in the whole text."""
    return cells[0].whole[0], max(cells[0].whole[1], cells[-1].whole[1])


def quoted(text: str) -> str:
    """Return a cell's text, shortened and in quotes, for use in a message."""
    shown = "".join(filter(str.isprintable, text.replace("\t", " ")))
    short = shown if len(shown) <= 30 else shown[:29] + "…"
    if "\t" in text:
        # Translators: the text of a cell, as a part of other sentences.
        return say("`{text}` (with a tab character in it)", text=short)
    if shown == text:
        return f"`{short}`"
    # Translators: the text of a cell, as a part of other sentences.
    return say("`{text}` (with an invisible character in it)", text=short)


def side_by_side(names: Sequence[str]) -> str:
    """Return quoted names with commas between them."""
    return reduce(lambda first, second: say("{first}, {second}", first=first, second=second), names)
