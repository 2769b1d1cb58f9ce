"""The reasons to refuse a random robot."""

# If a robot is refused, another random robot gets its number.

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import Final

import numpy as np

from service.kinematics.chain import ALPHA, THETA, A, D, Table
from service.kinematics.dh import Convention
from service.kinematics.jacobian import rank, space_jacobian
from service.variants.robots.geometry.home_path import (
    VIEWS,
    HomePath,
    HomePoint,
    difference,
    dot,
    gap,
    seen,
)
from service.variants.robots.plan import Plan, PlannedRow

# Links are drawn about 6 cm thick, joints 10.
_CLEARANCE: Final = 13.3
# In shares of the larger side of the picture, which is about 330 pixels on a phone.
_CORNERS_APART: Final = 0.0531
_LABELS_APART: Final = 0.0713
_FORESHORTENED: Final = 0.2703
# A table must have about as many cells with something to know as rows, or a lazy answer earns much.
_LEAST_CONTENT: Final = 0.7903
# With few rows, wrong cells that are not counted matter more: more cells than rows, and even more
# if the last row is split. The few robots in which a lazy answer earns more all the same are not
# dealt (``asks_enough``).
_FEW: Final = 4
_SPLIT: Final = 3
_SPATIAL: Final = 6
# Joint values without any relation, in radians and in metres.
_GENERIC: Final = (0.731, -1.157, 0.419, 1.933, -0.587, 2.311, -1.723)


@dataclass(frozen=True, slots=True)
class Seen:
    """The direction from which a figure shows a robot."""

    azimuth: int
    elevation: int


def reason_against(plan: Plan, path: HomePath) -> str | None:
    """Return the reason to refuse a planned robot, or None."""
    if _tells_little(plan.rows):
        return "a lazy answer earns too much"
    if _turns_back(path) or _touches(path):
        return "links go through each other"
    if rank_of(plan) < min(len(plan.rows), _SPATIAL):
        return "joints depend on each other"
    return None


def _tells_little(rows: Sequence[PlannedRow]) -> bool:
    known = sum(bool(row.a) + bool(row.alpha) + bool(row.d) + bool(row.theta) for row in rows)
    if len(rows) <= _FEW:
        # In the modified table, the angle of the last joint and the length from there to the tool
        # are in two rows, and marks may give up the second one to save the angle.
        last = rows[-1]
        is_split = bool(last.a and last.theta and not last.sliding)
        return known <= len(rows) + (_SPLIT if is_split else 0)
    return known < _LEAST_CONTENT * len(rows)


def _turns_back(path: HomePath) -> bool:
    """True if a segment of the path leads back along the segment before it."""
    steps = [difference(end, start) for start, end in path.pieces]
    return any(
        dot(one, other) < -0.87 * (dot(one, one) * dot(other, other)) ** 0.5
        for one, other in pairwise(steps)
    )


def _touches(path: HomePath) -> bool:
    """True if two segments of the path that are not neighbours come near each other."""
    pieces = path.pieces
    for i, j in combinations(range(len(pieces)), 2):
        if j > i + 1 and gap(pieces[i], pieces[j]) < _CLEARANCE:
            return True
    return False


def table_of(plan: Plan) -> Table:
    """Return the standard DH table of a robot with all joint variables 0, in metres and radians."""
    table = np.zeros((len(plan.rows), 4))
    for i, row in enumerate(plan.rows):
        table[i, A], table[i, D] = row.a / 100, row.d / 100
        table[i, ALPHA], table[i, THETA] = np.radians([row.alpha, row.theta])
    return table


def rank_of(plan: Plan) -> int:
    """Return the number of independent motions of the robot's tool."""
    # At a generic configuration.
    count = len(plan.rows)
    table = np.repeat(table_of(plan)[..., None], 3, axis=2)
    for i, row in enumerate(plan.rows):
        values = [_GENERIC[(i + k) % len(_GENERIC)] for k in (0, 2, 5)]
        table[i, D if row.sliding else THETA] += values
    slides = [row.sliding for row in plan.rows]
    return rank(space_jacobian(table, Convention.STANDARD, range(count), slides))


def clear_view(path: HomePath) -> Seen | None:
    """Return the first view in which the figure's corners and labels do not overlap, or None."""
    pieces = path.pieces
    middles = [((p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2) for p, q in pieces]
    different = _different(path.corners)
    for azimuth, elevation in VIEWS:
        flat = list(seen(different, azimuth, elevation))
        size = max(max(each[k] for each in flat) - min(each[k] for each in flat) for k in (0, 1))
        if not _apart(flat, _CORNERS_APART * size):
            continue
        if not _apart(list(seen(middles, azimuth, elevation)), _LABELS_APART * size):
            continue
        if _long_enough(pieces, azimuth, elevation):
            return Seen(azimuth, elevation)
    return None


def _different(points: Sequence[HomePoint]) -> list[HomePoint]:
    found: list[HomePoint] = []
    for point in points:
        if all(dot(d := difference(point, other), d) > 1e-3 for other in found):
            found.append(point)
    return found


def _apart(points: Sequence[tuple[float, float]], least: float) -> bool:
    square = least * least
    return all((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 > square for p, q in combinations(points, 2))


def _long_enough(
    pieces: Sequence[tuple[HomePoint, HomePoint]], azimuth: int, elevation: int
) -> bool:
    """True if no link points at the viewer."""
    for start, end in pieces:
        (a, b), (c, d) = seen((start, end), azimuth, elevation)
        along = difference(end, start)
        if (c - a) ** 2 + (d - b) ** 2 < _FORESHORTENED**2 * dot(along, along):
            return False
    return True
