"""Generate wrong table rows as students write them."""

# This generator is independent of `edits`.

from collections.abc import Iterator, Sequence

import numpy as np

from tests.frame_choice.kinematics import Numbers, evaluate
from tests.frame_choice.oracle import samples
from tests.frame_choice.robots import ALPHA, THETA, A, D, Robot

Texts = list[list[str]]

ANGLES = (ALPHA, THETA)
_IN_DRAWINGS = ("0.3", "0.25", "0.5", "0.12", "0.4")
_TURNS = ("pi/2", "-pi/2", "pi", "pi/4", "40*pi/180", "pi/6", "90", "180")
SAME = 1e-9
DRAWS = 40


def entries(robot: Robot, texts: Texts, row: int, column: int) -> Iterator[str]:
    """Yield the texts that a student may write in a cell, correct or wrong."""
    written = texts[row][column]
    for other in (row - 1, row + 1, row + 2):
        if 0 <= other < len(texts):
            yield texts[other][column]
    # The entry that belongs into the neighbouring column.
    yield texts[row][{A: D, D: A, ALPHA: THETA, THETA: ALPHA}[column]]
    if column in (A, ALPHA) and row > 0:
        yield texts[row - 1][column]
    yield "0"
    yield f"-({written})"
    yield from _TURNS if column in ANGLES else _IN_DRAWINGS
    yield from () if column in ANGLES else robot.lengths
    if column in ANGLES:
        yield f"{written} + pi/2"
        yield f"{written} - pi/2"
    for i, variable in enumerate(robot.joints):
        if robot.column(i) == column and abs(i - row) <= 1:
            yield variable
            yield f"-{variable}"


def wrong_row(
    robot: Robot, texts: Texts, row: int, count: int, rng: np.random.Generator
) -> Texts | None:
    """Return the table with ``count`` wrong entries in a row, or None if none are found."""
    columns = rng.permutation(4)[:count].tolist()
    for _ in range(DRAWS):
        spoiled = [list(each) for each in texts]
        for column in columns:
            of_cell = list(entries(robot, texts, row, column))
            spoiled[row][column] = of_cell[int(rng.integers(len(of_cell)))]
        if all(differs(robot, texts, spoiled, row, column) for column in columns):
            return spoiled
    return None


def differs(
    robot: Robot, one: Sequence[Sequence[str]], other: Texts, row: int, column: int
) -> bool:
    """True if a cell has different values in two tables."""
    values = samples(robot)
    error: Numbers = evaluate(one[row][column], values) - evaluate(other[row][column], values)
    if column in ANGLES:
        error = error - 2 * np.pi * np.round(error / (2 * np.pi))
    return bool(np.abs(error).max() > SAME)
