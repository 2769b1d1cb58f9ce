"""The chain as a path of straight pieces from the base frame to the tool.

A piece is along the axis of a joint, or across from one axis to the next.
"""

# A table gives both kinds: Z_i is along an axis, X_i is across (``kinematics.chain``). For a robot
# with screw axes, the path follows the common normals between the axes.

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from service.catalogue.robots.robot import ReferenceTable, Robot
from service.catalogue.robots.screw_robot import Reference, ScrewRobot
from service.expressions.evaluation.samples import SymbolValues
from service.kinematics.chain import A, D, frames
from service.kinematics.dh import Convention
from service.kinematics.screws import exponential, moved
from service.kinematics.transforms import Matrices, Numbers

# Two directions are parallel if their cross product is shorter.
PARALLEL = 1e-9


@dataclass(frozen=True, slots=True)
class ChainPath:
    """The corners ``(k + 1, samples, 3)`` of a path with ``k`` pieces.

    ``joints`` has, for each piece, the joint whose axis it follows, or None.
    """

    # The index counts from 0; None is a piece from one axis to the next.
    corners: Numbers
    joints: tuple[int | None, ...]


def motions(reference: Reference, values: SymbolValues, samples: int) -> Matrices:
    """Return each body's motion from its home position, ``(joints + 1, samples, 4, 4)``.

    Body 0 is the base; joints 1 to i move body i.
    """
    # The motion is e^{[S_1]q_1} … e^{[S_i]q_i}.
    screws = reference.screws(values, samples)
    moved_by = [np.broadcast_to(np.eye(4), (samples, 4, 4))]
    for joint, screw in zip(reference.joints, screws, strict=True):
        amount = np.broadcast_to(values[joint.variable], (samples,))
        moved_by.append(moved_by[-1] @ exponential(screw, amount))
    return np.stack(moved_by)


def axis_directions(screws: Numbers) -> Numbers:
    """Return the directions ``(..., 3)`` of the screw axes ``(..., 6)`` of joints."""
    omega = screws[..., :3]
    turns = np.linalg.norm(omega, axis=-1, keepdims=True) > PARALLEL
    return np.where(turns, omega, screws[..., 3:])


def path_of(reference: Reference, values: SymbolValues, samples: int) -> ChainPath:
    """Return the path of a robot at values of all its symbols and joint variables."""
    if isinstance(reference, Robot):
        return table_path(reference.tables[reference.convention], values, samples)
    return _screw_path(reference, values, samples)


def table_path(table: ReferenceTable, values: SymbolValues, samples: int) -> ChainPath:
    """Return the path of a table."""
    # Pieces of a fixed row do not count as along a joint axis.
    return path_of_rows(table.values(values, samples), table.convention, len(table.joints))


def path_of_rows(rows: Numbers, convention: Convention, joints: int) -> ChainPath:
    """Return the path of a table in numbers, ``(rows, 4, samples)``."""
    reached = frames(rows, convention)
    corners, along = [reached[0, :, :3, 3]], list[int | None]()
    for i, row in enumerate(rows):
        before, after = reached[i], reached[i + 1]
        if convention is Convention.STANDARD:
            between = before[:, :3, 3] + row[D, :, None] * before[:, :3, 2]
        else:
            between = before[:, :3, 3] + row[A, :, None] * before[:, :3, 0]
        corners += [between, after[:, :3, 3]]
        joint = i if i < joints else None
        along += [joint, None] if convention is Convention.STANDARD else [None, joint]
    return ChainPath(np.stack(corners), tuple(along))


def _screw_path(robot: ScrewRobot, values: SymbolValues, samples: int) -> ChainPath:
    bodies = motions(robot, values, samples)
    screws = moved(bodies[:-1], robot.screws(values, samples))
    tool = robot.frame("tool", values, samples)[:, :3, 3]
    slides = [joint.prismatic for joint in robot.joints]
    corners = [_corners(screws[:, s], slides, tool[s]) for s in range(samples)]
    along = [place for joint in range(len(slides)) for place in (None, joint)]
    return ChainPath(np.stack(corners, axis=1), (*along, None))


def _corners(screws: Numbers, slides: Sequence[bool], tool: Numbers) -> Numbers:
    # Across to each axis, along it, and at last to the tool. The axis of a prismatic joint has no
    # fixed place, so it goes through the point reached so far.
    directions = axis_directions(screws)
    points = np.cross(screws[:, :3], screws[:, 3:])
    here = np.zeros(3)
    corners = [here]
    for i, direction in enumerate(directions):
        point = here if slides[i] else points[i]
        here = point + direction * (direction @ (here - point))
        corners.append(here)
        if i + 1 == len(directions):
            target = tool
        elif slides[i + 1]:
            target = here
        else:
            target = _nearest(here, direction, points[i + 1], directions[i + 1])
        here = here + direction * (direction @ (target - here))
        corners.append(here)
    return np.stack([*corners, tool])


def _nearest(point: Numbers, direction: Numbers, other: Numbers, its_direction: Numbers) -> Numbers:
    # ``point`` if the lines are parallel.
    normal = np.cross(direction, its_direction)
    if np.linalg.norm(normal) < PARALLEL:
        return point
    across = np.cross(its_direction, normal)
    distance = ((other - point) @ across) / (direction @ across)
    return np.asarray(point + direction * distance)
