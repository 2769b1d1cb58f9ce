"""The marks of a table as a tutor works them out on paper, from its text."""

from collections.abc import Iterable, Sequence

import pytest

from tests.grading.support.robots import Robot


def worth_of_rows(robot: Robot) -> list[float]:
    """A unit for each cell that is neither 0 nor the bare joint variable, and a fifth besides."""
    return [
        0.2 + sum(cell != "0" and not cell.endswith("*") for cell in cells) for cells in robot.rows
    ]


def points(robot: Robot, most: float, wrong: Iterable[int]) -> list[float]:
    """The points of each row of a table worth ``most``; ``wrong`` is the row of each wrong cell."""
    wrong = list(wrong)
    rows = worth_of_rows(robot)
    kept = [max(0.0, worth - wrong.count(i)) for i, worth in enumerate(rows)]
    return [most * each / sum(rows) for each in kept]


def about(values: Sequence[float]) -> object:
    """The values up to the rounding of points."""
    return pytest.approx(list(values), abs=2e-6)
