"""The sentences that say where points were lost."""

from collections.abc import Sequence
from typing import Final

from service.grading.report import LittleWorth, LostPoints, RowReport, Verdict, rounded_points
from service.translations import Sentence, listed, say, say_count, template

CELLS: Final = "cells"
WHOLE: Final = "whole"
OUTSIDE: Final = "outside_cells"
SHARED: Final = "shared_by_rows"
NO_JOINT_MOVES: Final = "no_motion"
ALL_OR_NOTHING: Final = "all_or_nothing"
NOT_READ: Final = "not_read"
NO_ANSWER: Final = "no_answer"
PART: Final = "part"

# The sentence of each code of a loss without a row, as it follows "−0.5: ".
_SENTENCES: Final = {
    WHOLE: template(
        "mistakes that run through the answer, charged once for the whole part (its rows share "
        "the loss)"
    ),
    OUTSIDE: template("an extra row, or rows that do not lead to the end effector"),
    SHARED: template(
        "mistakes that cost more than their own rows are worth (the other rows share this loss)"
    ),
    NO_JOINT_MOVES: template("no joint moves this answer"),
    ALL_OR_NOTHING: template("only a right answer earns points here"),
    NOT_READ: template("the answer cannot be read"),
    NO_ANSWER: template("no answer"),
    PART: template("somewhere in this part"),
}
# Rows that are a single thing of their own and no row of a table, by their labels.
_SINGLE: Final = {
    # Translators: what the student has marked as the mistake, after "−0.5: ".
    "marked": template("the mark"),
    # Translators: the table without the mistake, after "−0.5: ".
    "table": template("the mended table"),
}
_NAMES: Final = {"alpha": "α", "theta": "θ", "axis": say("axis")}
# A row of zeros is worth at most this share of the part.
_MOST_OF_ZEROS: Final = 0.125


def lost_points(code: str, points: float) -> LostPoints:
    """Return the points that an answer lost as a whole, not in one row."""
    return LostPoints(code, rounded_points(points), say(_SENTENCES[code]))


def without_places(lost: Sequence[LostPoints]) -> tuple[LostPoints, ...]:
    """Return lost points as one sum, without naming rows or cells."""
    return (lost_points(PART, sum(each.points for each in lost)),) if lost else ()


def lost_in_row(row: RowReport, points: float) -> LostPoints:
    """Return the points that a row lost, and its cells that are not correct."""
    cells = tuple(cell.label for cell in row.cells if cell.verdict is not Verdict.CORRECT)
    if cells == (row.label,) and row.label in _SINGLE:
        message = say(_SINGLE[row.label])
    elif 0 < len(cells) < len(row.cells):
        message = _cells_in_row(cells, row.label)
    else:
        message = say("row {row}", row=row.label)
    return LostPoints(CELLS, rounded_points(points), message, row.label, cells)


def _cells_in_row(labels: Sequence[str], row: str) -> Sentence:
    # For example "a and α in row 2" or "columns 1, 2 and 4 in row 3".
    cells = listed([_NAMES.get(label, label) for label in labels])
    if not labels[0].isdigit():
        return say("{cells} in row {row}", cells=cells, row=row)
    return say_count(
        "column {cells} in row {row}",
        "columns {cells} in row {row}",
        count=len(labels),
        cells=cells,
        row=row,
    )


def little_worth(rows: Sequence[RowReport], most: float) -> LittleWorth | None:
    """Return why correct rows of zeros earned few points, or None if there are no such rows."""
    # rows are the rows without a cell that needs knowledge. most is the number of points of the
    # part.
    found = [
        row
        for row in rows
        if row.verdict is Verdict.CORRECT and 0 < row.max_points <= _MOST_OF_ZEROS * most
    ]
    if not found:
        return None
    labels = tuple(row.label for row in found)
    message = say_count(
        "Row {rows} is worth little: zeros, and the joint variable in its usual place, need no "
        "geometry.",
        "Rows {rows} are worth little: zeros, and the joint variable in its usual place, need no "
        "geometry.",
        count=len(labels),
        rows=listed(labels),
    )
    return LittleWorth(labels, rounded_points(sum(row.max_points for row in found)), message)
