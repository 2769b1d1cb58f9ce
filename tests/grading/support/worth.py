"""The marks of a table as a tutor computes them by hand from its text."""

from collections.abc import Iterable, Sequence

import pytest

from tests.grading.support.robots import Robot


def worth_of_rows(robot: Robot) -> list[float]:
    """Return the worth of rows: a unit per cell that is not lazy, and a fifth for each row."""
    return [0.2 + sum(is_known(robot, i, j) for j in range(4)) for i in range(len(robot.rows))]


def is_known(robot: Robot, row: int, column: int) -> bool:
    """True if the cell needs knowledge: it is neither 0 nor the bare joint variable."""
    cell = robot.rows[row][column]
    return cell != "0" and not cell.endswith("*")


def points(
    robot: Robot, most: float, wrong: Iterable[int], unread: Iterable[int] = ()
) -> list[float]:
    """Return the points of each row of a table worth ``most``.

    ``wrong`` is the row of each cell that costs a unit, ``unread`` the rows in which other cells
    were not read.
    """
    wrong, unread = list(wrong), set(unread)
    rows = worth_of_rows(robot)
    kept = [max(0.0, worth - wrong.count(i) - 0.2 * (i in unread)) for i, worth in enumerate(rows)]
    return [most * each / sum(rows) for each in kept]


def about(values: Sequence[float]) -> object:
    """Return a value that equals ``values`` up to the rounding of points."""
    return pytest.approx(list(values), abs=2e-6)
