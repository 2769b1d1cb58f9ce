"""Find the cells in which a wrong table can be repaired."""

# Next to parallel axes and prismatic joints, a change of another cell can often make the table
# correct, too. Then no grader can know which cell the student got wrong.

from collections.abc import Sequence
from itertools import product

import numpy as np
from scipy.optimize import least_squares

from tests.frame_choice.kinematics import Numbers, cell_values, evaluate, factors, inverse
from tests.frame_choice.oracle import (
    JOINTS,
    LENGTHS,
    TOLERANCE,
    Texts,
    Values,
    difference,
    reference_poses,
    samples,
)
from tests.frame_choice.robots import ALPHA, STANDARD, THETA, A, D, Policy, Robot

Place = tuple[int, int]
TURNS = (0.0, np.pi, np.pi / 2, -np.pi / 2)
STARTS = 8


def can_repair(
    robot: Robot, policy: Policy, texts: Texts, convention: str, cells: Sequence[Place]
) -> bool:
    """True if other values of these cells make the table valid."""
    # Each cell gets an unknown constant for each set of lengths. In the column of the row's joint
    # variable, the variable is added or subtracted. Least squares finds the constants from several
    # starts.
    values = samples(robot)
    holds_variable = [robot.column(r) == c if r < len(robot.joints) else False for r, c in cells]
    written = cell_values(texts, {name: value * 1.0 for name, value in values.items()})
    starts = [
        written[r, c].mean(axis=-1) if not mine else np.zeros(LENGTHS)
        for (r, c), mine in zip(cells, holds_variable, strict=True)
    ]
    rng = np.random.default_rng(0)
    for signs in product(*[(1.0, -1.0) if mine else (0.0,) for mine in holds_variable]):

        def error(x: Numbers, signs: tuple[float, ...] = signs) -> Numbers:
            constants = x.reshape(len(cells), LENGTHS)

            def table(at: Values) -> Numbers:
                numbers = cell_values(texts, at)
                for (r, c), constant, sign in zip(cells, constants, signs, strict=True):
                    shape = np.shape(numbers[r, c])
                    value = constant.reshape(LENGTHS, *[1] * (len(shape) - 1))
                    if sign:
                        value = value + sign * at[robot.joints[r]]
                    numbers[r, c] = value
                return numbers

            return difference(robot, policy, table, convention).ravel()

        for attempt in range(STARTS):
            start = np.concatenate(starts) + (attempt > 0) * rng.uniform(-2, 2, 2 * len(cells))
            if attempt < len(TURNS):  # if all axes are parallel, the gradient is no help
                angles = np.repeat([c in (ALPHA, THETA) for _, c in cells], LENGTHS)
                start = np.where(angles, TURNS[attempt], start)
            found = least_squares(error, start, method="trf", max_nfev=60)
            if np.abs(found.fun).max() < TOLERANCE:
                return True
    return False


def repairing_cells(robot: Robot, texts: Texts, convention: str) -> set[tuple[int, int]]:
    """Return each cell that can repair the table on its own."""
    # A cell belongs to one factor of the pose. This factor must be F = A⁻¹ T_reference C⁻¹, where A
    # and C are the products of the factors before and after it. The cell repairs the table if some
    # value of the cell gives F at every sample. The value may contain the joint variable only in
    # the variable's own column.
    values = samples(robot)
    chain = factors(cell_values(texts, values), convention)
    target = reference_poses(robot, (1,) * len(robot.joints))
    before, behind = [np.broadcast_to(np.eye(4), target.shape)], []
    for factor in chain:
        before.append(before[-1] @ factor)
    behind.append(np.broadcast_to(np.eye(4), target.shape))
    for factor in chain[::-1]:
        behind.append(factor @ behind[-1])
    found = set()
    for i in range(len(chain)):
        wanted = inverse(before[i]) @ target @ inverse(behind[len(chain) - 1 - i])
        row, in_x = i // 2, (i % 2 == 1) == (convention == STANDARD)
        for column in (A, ALPHA) if in_x else (D, THETA):
            if _fills(robot, texts, row, column, wanted, values):
                found.add((row, column))
    return found


def _fills(
    robot: Robot, texts: Texts, row: int, column: int, wanted: Numbers, values: Values
) -> bool:
    # True if the cell can have a value at which its screw motion is `wanted` at all samples.
    axis = 0 if column in (A, ALPHA) else 2
    first, second = (axis + 1) % 3, (axis + 2) % 3
    other = evaluate(texts[row][{A: ALPHA, ALPHA: A, D: THETA, THETA: D}[column]], values)
    angle = np.arctan2(wanted[..., second, first], wanted[..., first, first])
    shift = wanted[..., axis, 3]
    free, fixed = (shift, angle) if column in (A, D) else (angle, shift)
    error = np.abs(wanted[..., axis, axis] - 1) + np.abs(wanted[..., first, 3])
    error = error + np.abs(wanted[..., second, 3])
    rest = fixed - other
    if column in (A, D):
        rest = _principal(rest)
    if max(error.max(), np.abs(rest).max()) > TOLERANCE:
        return False
    signs = [0.0]
    variable = np.zeros((LENGTHS, JOINTS))
    if row < len(robot.joints) and column == robot.column(row):
        signs, variable = [1.0, -1.0], values[robot.joints[row]]
    for sign in signs:
        constant = free - sign * variable
        drift = constant - constant[:, :1]
        drift = drift if column in (A, D) else _principal(drift)
        if np.abs(drift).max() < TOLERANCE:
            return True
    return False


def _principal(angle: Numbers) -> Numbers:
    turned: Numbers = angle - 2 * np.pi * np.round(angle / (2 * np.pi))
    return turned
