"""Rows as students write them, for the shipped robots."""

import re
from collections.abc import Iterator, Sequence
from decimal import Decimal
from functools import cache

import numpy as np
from dh_grader.catalogue import Exercise
from scipy.optimize import lsq_linear

from tests.frame_choice.kinematics import Numbers, cell_values, evaluate
from tests.frame_choice.oracle import TOLERANCE, Texts, Values, difference, samples
from tests.frame_choice.robots import ALPHA, THETA, A, D, Policy, Robot, TextRow
from tests.shipped import shipped_exercises, without_most_real_robots

# --- Convert the robots of shipped exercises to ``Robot``

_DEGREES = re.compile(r"(\d+(?:\.\d+)?)\s*deg")


@cache
def shipped_robots() -> tuple[Robot, ...]:
    """Return the robots of the shipped exercises, each once."""
    # Most real robots are left out: they have a campaign of their own (`tests.exercises.real`).
    found: dict[tuple[str, tuple[TextRow, ...]], Robot] = {}
    shipped = shipped_exercises()
    for name in without_most_real_robots(shipped):
        exercise = shipped[name]
        if any(part.kind == "dh_table" for part in exercise.parts):
            robot = robot_of(exercise)
            found.setdefault((robot.structure + robot.convention, robot.rows), robot)
    return tuple(found.values())


def robot_of(exercise: Exercise) -> Robot:
    """Convert the robot of an exercise to ``Robot``."""
    robot = exercise.robot
    rows = []
    for row in robot.tables[robot.convention].rows:
        a, alpha, d, theta = (_DEGREES.sub(r"(\1*pi/180)", cell.source) for cell in row)
        rows.append((a, alpha, d, theta))
    lengths = [each for each in exercise.variables if each.joint is None]
    return Robot(
        exercise.id,
        robot.structure,
        robot.convention.value,
        tuple(joint.variable for joint in robot.joints),
        tuple(rows),
        tuple(each.name for each in lengths),
        robot.joints[0].index,
        {each.name: (each.low, each.high) for each in lengths},
    )


# --- Generate wrong table rows as students write them

# This generator is independent of `edits`.

StudentRowsTexts = list[list[str]]

ANGLES = (ALPHA, THETA)
_IN_DRAWINGS = ("0.3", "0.25", "0.5", "0.12", "0.4")
_TURNS = ("pi/2", "-pi/2", "pi", "pi/4", "40*pi/180", "pi/6", "90", "180")
SAME = 1e-9
DRAWS = 40


def entries(robot: Robot, texts: StudentRowsTexts, row: int, column: int) -> Iterator[str]:
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
    robot: Robot, texts: StudentRowsTexts, row: int, count: int, rng: np.random.Generator
) -> StudentRowsTexts | None:
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
    robot: Robot, one: Sequence[Sequence[str]], other: StudentRowsTexts, row: int, column: int
) -> bool:
    """True if a cell has different values in two tables."""
    values = samples(robot)
    error: Numbers = evaluate(one[row][column], values) - evaluate(other[row][column], values)
    if column in ANGLES:
        error = error - 2 * np.pi * np.round(error / (2 * np.pi))
    return bool(np.abs(error).max() > SAME)


# --- Decide whether a table's decimals may be rounded values of a valid table

# This oracle is independent of the service. Each decimal of three or more figures becomes an
# unknown in the range of the numbers that are rounded or cut off to the decimal. The pose depends
# on the unknowns almost linearly, so that a few steps of linear least squares find them.

_DECIMAL = re.compile(r"(?<![\w.])\d*\.\d+(?:[eE]-?\d+)?")
LEAST_FIGURES = 3
# The true number minus the decimal, in units of its last place: at least half a unit less (rounded
# up), at most one unit more (cut off).
BOUNDS = (-0.5, 1.0)
STEPS, STEP = 3, 0.1


def is_valid_when_rounded(robot: Robot, policy: Policy, texts: Texts, convention: str) -> bool:
    """True if the decimals may be rounded values of a valid table."""
    numbers: list[Decimal] = []

    def named(match: re.Match[str]) -> str:
        number = Decimal(match[0])
        if len(number.as_tuple().digits) < LEAST_FIGURES:
            return match[0]
        numbers.append(number)
        return f"true_{len(numbers) - 1}"

    formulas = [[_DECIMAL.sub(named, text) for text in row] for row in texts]
    if not numbers:
        return False
    written = np.array([float(number) for number in numbers])
    units = np.array([10.0 ** int(number.as_tuple().exponent) for number in numbers])

    def error(shifts: Numbers) -> Numbers:
        true = {f"true_{i}": np.asarray(each) for i, each in enumerate(written + shifts * units)}

        def table(at: Values) -> Numbers:
            return cell_values(formulas, {**at, **true})

        return difference(robot, policy, table, convention).ravel()

    shifts = np.zeros(len(units))
    for _ in range(STEPS):
        ways = STEP * np.eye(len(units))
        rates = [(error(shifts + way) - error(shifts - way)) / (2 * STEP) for way in ways]
        wanted = np.array(rates).T @ shifts - error(shifts)
        shifts = lsq_linear(np.array(rates).T, wanted, BOUNDS, method="bvls").x
    return bool(np.abs(error(shifts)).max() < TOLERANCE)
