"""Decide whether a table's decimals may be rounded values of a valid table."""

# This oracle is independent of the service. Each decimal of three or more figures becomes an
# unknown in the range of the numbers that are rounded or cut off to the decimal. The pose depends
# on the unknowns almost linearly, so that a few steps of linear least squares find them.

import re
from decimal import Decimal

import numpy as np
from scipy.optimize import lsq_linear

from tests.frame_choice.kinematics import Numbers, cell_values
from tests.frame_choice.oracle import TOLERANCE, Texts, Values, difference
from tests.frame_choice.robots import Policy, Robot

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
