"""The marks of a table as a tutor works them out on paper, from its text."""

from collections.abc import Iterable, Sequence

import pytest

from tests.grading.support.robots import Robot


def worth_of_rows(robot: Robot) -> list[float]:
    """A unit for each cell that is neither 0 nor the bare joint variable, and a fifth besides."""
    return [0.2 + sum(is_known(robot, i, j) for j in range(4)) for i in range(len(robot.rows))]


def is_known(robot: Robot, row: int, column: int) -> bool:
    """Whether one has to know something for a cell."""
    cell = robot.rows[row][column]
    return cell != "0" and not cell.endswith("*")


def points(
    robot: Robot, most: float, wrong: Iterable[int], unread: Iterable[int] = ()
) -> list[float]:
    """The points of each row of a table worth ``most``.

    ``wrong`` is the row of each cell that costs a unit, ``unread`` the rows in which other cells
    were not read.
    """
    wrong, unread = list(wrong), set(unread)
    rows = worth_of_rows(robot)
    kept = [max(0.0, worth - wrong.count(i) - 0.2 * (i in unread)) for i, worth in enumerate(rows)]
    return [most * each / sum(rows) for each in kept]


def about(values: Sequence[float]) -> object:
    """The values up to the rounding of points."""
    return pytest.approx(list(values), abs=2e-6)
