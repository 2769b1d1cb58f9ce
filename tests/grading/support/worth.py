"""Compute the expected points of a table from its text."""

from collections.abc import Iterable, Sequence

import pytest

from tests.grading.support.robots import Robot


def worth_of_rows(robot: Robot) -> list[float]:
    return [0.2 + sum(is_known(robot, i, j) for j in range(4)) for i in range(len(robot.rows))]


def is_known(robot: Robot, row: int, column: int) -> bool:
    cell = robot.rows[row][column]
    return cell != "0" and not cell.endswith("*")


# Computed by hand: the points of a content cell, of each row besides its cells, and of the unread
# cells of a row that are not content cells. A cell is worth the part's points, divided by the sum
# of `worth_of_rows`, as a whole number of quarters; the rows share what is left.
UNIT = {"stanford-arm": 1.75, "scara": 1.75, "rrrp": 1.25, "planar-rrr": 2.0}
BESIDES = {
    "stanford-arm": [0.25] * 6,
    "scara": [0.25] * 4,
    "rrrp": [0.5, 0.5, 0.5, 0.25],
    "planar-rrr": [0.5] * 4,
}
UNREAD = {"stanford-arm": 0.25, "scara": 0.25, "rrrp": 0.25, "planar-rrr": 0.5}


def points(robot: Robot, wrong: Iterable[int], unread: Iterable[int] = ()) -> list[float]:
    """Return the expected points of each row of a table."""
    # `wrong` has the row number of each wrong cell. `unread` has the numbers of rows in which a
    # cell that is 0 or only the joint variable was not read.
    wrong, unread, name = list(wrong), set(unread), robot.exercise
    worth = [
        BESIDES[name][i] + UNIT[name] * sum(is_known(robot, i, j) for j in range(4))
        for i in range(len(robot.rows))
    ]
    return [
        max(0.0, each - UNIT[name] * wrong.count(i) - UNREAD[name] * (i in unread))
        for i, each in enumerate(worth)
    ]


def about(values: Sequence[float]) -> object:
    return pytest.approx(list(values), abs=2e-6)
