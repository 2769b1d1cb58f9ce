"""The sentences that say where points were lost."""

from collections.abc import Sequence
from typing import Final

from service.grading.report import LittleWorth, LostPoints, RowReport, Verdict, rounded_points

CELLS: Final = "cells"
WHOLE: Final = "whole"
OUTSIDE: Final = "outside_cells"
NO_JOINT_MOVES: Final = "no_motion"
ALL_OR_NOTHING: Final = "all_or_nothing"
NOT_READ: Final = "not_read"
NO_ANSWER: Final = "no_answer"
PART: Final = "part"

# The sentence of each code, as it follows "−0.5: ".
_SENTENCES: Final = {
    CELLS: "{cells} in row {row}",
    WHOLE: "mistakes that run through the answer, each counted once",
    OUTSIDE: "an extra row, or rows that do not lead to the end effector",
    NO_JOINT_MOVES: "no joint moves this answer",
    ALL_OR_NOTHING: "only a right answer earns points here",
    NOT_READ: "the answer cannot be read",
    NO_ANSWER: "no answer",
    PART: "somewhere in this part",
}
_WHOLE_ROW: Final = "row {row}"
_COLUMN, _COLUMNS = "column {cells}", "columns {cells}"
_LITTLE_WORTH: Final = (
    "{rows} worth little: zeros, and the joint variable in its usual place, need no geometry."
)
_NAMES: Final = {"alpha": "α", "theta": "θ"}
# A row of zeros is worth at most this share of the part.
_MOST_OF_ZEROS: Final = 0.125


def lost_points(code: str, points: float) -> LostPoints:
    """Return points that the answer has lost as a whole."""
    return LostPoints(code, rounded_points(points), _SENTENCES[code])


def without_places(lost: Sequence[LostPoints]) -> tuple[LostPoints, ...]:
    """Return lost points as one sum, without their places."""
    return (lost_points(PART, sum(each.points for each in lost)),) if lost else ()


def lost_in_row(row: RowReport, points: float) -> LostPoints:
    """Return points that a row has lost by its cells that are not right."""
    cells = tuple(cell.label for cell in row.cells if cell.verdict is not Verdict.CORRECT)
    sentence = _SENTENCES[CELLS] if 0 < len(cells) < len(row.cells) else _WHOLE_ROW
    message = sentence.format(cells=_named(cells), row=row.label)
    # A row that is a single thing of its own, such as the mark on a slip, is no row of a table.
    if cells == (row.label,):
        message = row.label
    return LostPoints(CELLS, rounded_points(points), message, row.label, cells)


def _named(labels: Sequence[str]) -> str:
    """Return the names of cells, such as ``a and α`` or ``columns 1, 2 and 4``."""
    names = [_NAMES.get(label, label) for label in labels]
    words = " and ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))
    if names and names[0].isdigit():
        return (_COLUMN if len(names) == 1 else _COLUMNS).format(cells=words)
    return words


def little_worth(rows: Sequence[RowReport], most: float) -> LittleWorth | None:
    """Return why rows that are right, but hold only zeros, are worth little; None if none is.

    ``rows`` are those without a content cell; ``most`` are the points of the part.
    """
    found = [
        row
        for row in rows
        if row.verdict is Verdict.CORRECT and 0 < row.max_points <= _MOST_OF_ZEROS * most
    ]
    if not found:
        return None
    labels = tuple(row.label for row in found)
    if len(labels) == 1:
        named = f"Row {labels[0]} is"
    else:
        named = f"Rows {', '.join(labels[:-1])} and {labels[-1]} are"
    points = rounded_points(sum(row.max_points for row in found))
    return LittleWorth(labels, points, _LITTLE_WORTH.format(rows=named))
