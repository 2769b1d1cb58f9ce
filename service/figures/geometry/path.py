"""The chain as a path: from the base frame to the tool, straight piece by straight piece.

A piece leads along the axis of a joint, or from one axis to the next. A table gives both: Z_i lies
along an axis, X_i leads across (``kinematics.chain``). Where a robot has screw axes only, the path
takes the common normals.
"""

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

# Two directions are parallel whose cross product is shorter.
PARALLEL = 1e-9


@dataclass(frozen=True, slots=True)
class ChainPath:
    """The corners ``(k + 1, samples, 3)`` of the path, and where its ``k`` pieces lead.

    ``joints`` holds for each piece the place of the joint along whose axis it leads, None for a
    piece across.
    """

    corners: Numbers
    joints: tuple[int | None, ...]


def motions(reference: Reference, values: SymbolValues, samples: int) -> Matrices:
    """How far each body is from its place at home: ``(joints + 1, samples, 4, 4)``.

    Body 0 is the base; body i is what joint i carries: e^{[S_1]q_1} … e^{[S_i]q_i}.
    """
    screws = reference.screws(values, samples)
    moved_by = [np.broadcast_to(np.eye(4), (samples, 4, 4))]
    for joint, screw in zip(reference.joints, screws, strict=True):
        amount = np.broadcast_to(values[joint.variable], (samples,))
        moved_by.append(moved_by[-1] @ exponential(screw, amount))
    return np.stack(moved_by)


def axis_directions(screws: Numbers) -> Numbers:
    """The directions ``(..., 3)`` of screw axes ``(..., 6)`` that turn, or slide."""
    omega = screws[..., :3]
    turns = np.linalg.norm(omega, axis=-1, keepdims=True) > PARALLEL
    return np.where(turns, omega, screws[..., 3:])


def path_of(reference: Reference, values: SymbolValues, samples: int) -> ChainPath:
    """The path of a robot at the given values of its symbols, joint variables among them."""
    if isinstance(reference, Robot):
        return table_path(reference.tables[reference.convention], values, samples)
    return _screw_path(reference, values, samples)


def table_path(table: ReferenceTable, values: SymbolValues, samples: int) -> ChainPath:
    """The path of a table; a fixed row leads across only."""
    return path_of_rows(table.values(values, samples), table.convention, len(table.joints))


def path_of_rows(rows: Numbers, convention: Convention, joints: int) -> ChainPath:
    """The path of a table in numbers, ``(rows, 4, samples)``."""
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
    """The path along the axes and their common normals, one sample after the other."""
    bodies = motions(robot, values, samples)
    screws = moved(bodies[:-1], robot.screws(values, samples))
    tool = robot.frame("tool", values, samples)[:, :3, 3]
    slides = [joint.prismatic for joint in robot.joints]
    corners = [_corners(screws[:, s], slides, tool[s]) for s in range(samples)]
    along = [place for joint in range(len(slides)) for place in (None, joint)]
    return ChainPath(np.stack(corners, axis=1), (*along, None))


def _corners(screws: Numbers, slides: Sequence[bool], tool: Numbers) -> Numbers:
    """The corners: across to each axis and along it, and across to the tool.

    A sliding axis may lie anywhere: it goes through the point that the path has reached.
    """
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
    """The point of a line that is nearest to another line; where all are, its own point."""
    normal = np.cross(direction, its_direction)
    if np.linalg.norm(normal) < PARALLEL:
        return point
    across = np.cross(its_direction, normal)
    distance = ((other - point) @ across) / (direction @ across)
    return np.asarray(point + direction * distance)
