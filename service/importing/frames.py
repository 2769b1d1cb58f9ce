"""Make a standard DH table from joint axes, by the rules that are taught.

z_{i-1} is along the axis of joint i, in its positive direction. x_i is along the common normal. On
parallel axes d_i = 0.
"""

# If the sign of x_i is free, the sign with fewer offsets is chosen.

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from service.importing.axes import PARALLEL, HomeAxis, common_normal
from service.importing.snapping import Snaps
from service.kinematics.chain import ALPHA, COLUMNS, THETA, Table, pose
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices, Numbers, inverse
from service.translations import say

_NONE = 1e-9


@dataclass(frozen=True, slots=True)
class Placed:
    """A standard table of constants ``(joints, 4)``, and the poses of both ends of the arm.

    ``base`` is the pose of frame {0} in the base link, and ``tool`` is the pose of the tip in the
    last frame.
    """

    # A pose is the identity if its two frames are the same.

    table: Table
    base: Matrices
    tool: Matrices


def placed(axes: list[HomeAxis], tip: Matrices, snaps: Snaps | None = None) -> Placed:
    """Return the DH table of an arm with these joint axes and this pose of the tip.

    Angles that inexact axes leave inexact are snapped; ``snaps`` lists them.
    """
    base = _base_frame(axes[0])
    frame, rows = base, []
    for before, axis in pairwise(axes):
        row, frame = _row(frame, *_normal(before, axis, frame), axis.direction)
        rows.append(row)
    row, frame = _last_row(frame, tip)
    rows.append(row)
    table, snaps = np.array(rows), snaps or Snaps()
    for i, row in enumerate(table):
        for j in (ALPHA, THETA):
            place = say("row {row}, column {column}", row=i + 1, column=COLUMNS[j])
            row[j] = snaps.angle(place, float(row[j]))
    return Placed(table, base, inverse(frame) @ tip)


def _base_frame(axis: HomeAxis) -> Matrices:
    # Return frame {0}.
    # Its origin is the point of the axis that is nearest to the base link. Its x axis is as near as
    # possible to the x axis of the base link.
    x = np.eye(3)[int(axis.parallel_to(np.eye(3)[0]))]
    x = x - (x @ axis.direction) * axis.direction
    return _frame(axis.nearest(np.zeros(3)), x / np.linalg.norm(x), axis.direction)


def _frame(origin: Numbers, x: Numbers, z: Numbers) -> Matrices:
    frame = np.eye(4)
    frame[:3, 0], frame[:3, 1], frame[:3, 2], frame[:3, 3] = x, np.cross(z, x), z, origin
    return frame


def _normal(before: HomeAxis, axis: HomeAxis, frame: Matrices) -> tuple[Numbers, Numbers]:
    if not axis.parallel_to(before.direction):
        foot, origin = common_normal(before, axis)
        between = origin - foot
        crossed = np.cross(before.direction, axis.direction)
    else:
        origin = axis.nearest(frame[:3, 3])
        between = origin - before.nearest(origin)
        crossed = frame[:3, 0]
    long = float(np.linalg.norm(between)) > _NONE
    x = between if long else crossed
    return x / np.linalg.norm(x), origin


def _row(frame: Matrices, x: Numbers, origin: Numbers, z: Numbers) -> tuple[Numbers, Matrices]:
    choices = []
    for sign in (1.0, -1.0):
        here = _frame(origin, sign * x, z)
        row = _parameters(frame, here)
        a, alpha, _, theta = row
        cost = (abs(theta) > _NONE) + 0.4 * (a < -_NONE) + 0.2 * (alpha < -_NONE)
        choices.append((cost, row, here))
    _, row, here = min(choices, key=lambda choice: choice[0])
    return row, here


def _parameters(before: Matrices, here: Matrices) -> Numbers:
    between = inverse(before) @ here
    theta = np.arctan2(between[1, 0], between[0, 0])
    alpha = np.arctan2(between[2, 1], between[2, 2])
    a = between[0, 3] * np.cos(theta) + between[1, 3] * np.sin(theta)
    return np.array([a, _half_turn_positive(alpha), between[2, 3], _half_turn_positive(theta)])


def _half_turn_positive(angle: float) -> float:
    return np.pi if abs(angle + np.pi) < _NONE else float(angle)


def _last_row(frame: Matrices, tip: Matrices) -> tuple[Numbers, Matrices]:
    axis, origin = frame[:3, 2], tip[:3, 3]
    along = (origin - frame[:3, 3]) @ axis
    off = origin - frame[:3, 3] - along * axis
    if np.linalg.norm(off) > _NONE:
        x = off / np.linalg.norm(off)
    elif np.linalg.norm(np.cross(axis, tip[:3, 2])) < PARALLEL:
        x = tip[:3, 0] - (tip[:3, 0] @ axis) * axis
        x = x / np.linalg.norm(x)
    else:
        x = np.cross(axis, tip[:3, 2])
        x = x / np.linalg.norm(x)
    z = tip[:3, 2]
    if abs(z @ x) > PARALLEL:
        z = axis
    choices = [_frame(origin, sign * x, z) for sign in (1.0, -1.0)]
    here = max(choices, key=lambda choice: float(choice[:3, 0] @ tip[:3, 0]))
    return _parameters(frame, here), here


def greatest_difference(
    placed_arm: Placed,
    structure: str,
    exact_pose: Callable[[Numbers], Matrices],
    samples: int = 100,
) -> tuple[float, float]:
    """Return the greatest differences in position and in angle between the table and the robot.

    Their poses are compared at random values of the joint variables.
    """
    values = np.random.default_rng(1).uniform(-np.pi, np.pi, (samples, len(structure)))
    lengths, angles = [], []
    for each in values:
        table = placed_arm.table.copy()
        for i, letter in enumerate(structure):
            table[i, 2 if letter == "P" else 3] += each[i]
        reached = placed_arm.base @ pose(table, Convention.STANDARD) @ placed_arm.tool
        expected = exact_pose(each)
        lengths.append(float(np.linalg.norm(reached[:3, 3] - expected[:3, 3])))
        turn = reached[:3, :3].T @ expected[:3, :3]
        # The norm of R - 1 is exact for small angles; the arc cosine of its trace is not.
        angles.append(float(np.linalg.norm(turn - np.eye(3)) / np.sqrt(2)))
    return max(lengths), max(angles)
