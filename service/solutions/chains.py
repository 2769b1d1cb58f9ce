"""The reference robot as a product of motions."""

from itertools import chain

import sympy

from service.catalogue import Exercise, Robot, ScrewRobot
from service.catalogue.files.fields import FrameName
from service.catalogue.robots.robot import FormulaRow
from service.kinematics.dh import Convention
from service.solutions.algebra import Algebra
from service.solutions.motions import Fixed, Motion, Shift, Turn, X, Z, inverse, multiplied


def link(row: FormulaRow, convention: Convention, algebra: Algebra) -> list[Motion]:
    """Return the motions of one row of a DH table."""
    a, alpha, d, theta = map(algebra.of, row)
    along_z: list[Motion] = [Turn(Z, theta), Shift(d * Z)]
    along_x: list[Motion] = [Shift(a * X), Turn(X, alpha)]
    return along_z + along_x if convention is Convention.STANDARD else along_x + along_z


def between(
    exercise: Exercise, start: FrameName, end: FrameName, algebra: Algebra, *, home: bool = False
) -> list[Motion]:
    """Return the motions from one frame of the robot to another.

    With ``home``, all joint variables are 0. Raises LookupError if the exercise has no robot.
    """
    # Frames are "base", "tool" and the frame numbers of the robot's own table.
    motions = _steps(exercise, Algebra(exercise, home=True) if home else algebra)
    first, last = (_place(exercise, frame, len(motions)) for frame in (start, end))
    steps = list(chain.from_iterable(motions[min(first, last) : max(first, last)]))
    return steps if first <= last else inverse(steps)


def _steps(exercise: Exercise, algebra: Algebra) -> list[list[Motion]]:
    match exercise.reference:
        case Robot(tables=tables, convention=convention):
            return [link(row, convention, algebra) for row in tables[convention].rows]
        case ScrewRobot() as robot:
            return [_exponentials(robot, algebra)]
        case _:
            raise LookupError(f"exercise {exercise.id!r} has no robot")


def _place(exercise: Exercise, frame: FrameName, steps: int) -> int:
    if isinstance(frame, str):
        return {"base": 0, "tool": steps}[frame]
    return frame - exercise.joints[0].index + 1


def _exponentials(robot: ScrewRobot, algebra: Algebra) -> list[Motion]:
    # Single turns and shifts whose product is e^{[S_1]θ_1} … e^{[S_n]θ_n} M. A turn about a screw
    # axis is written about the point of the axis nearest to the origin.
    motions: list[Motion] = []
    for joint, axis in zip(robot.joints, algebra.matrix(robot.axes).tolist(), strict=True):
        amount = algebra.symbols[joint.variable]
        omega, v = sympy.Matrix(axis[:3]), sympy.Matrix(axis[3:])
        if omega.is_zero_matrix:
            motions.append(Shift(amount * v))
            continue
        point, pitch = omega.cross(v), omega.dot(v)
        turn = Turn(omega.as_immutable(), amount)
        motions += [Shift(point), turn, Shift(pitch * amount * omega - point)]
    home = algebra.matrix(robot.home)
    return [*motions, Shift(home[:3, 3]), Fixed(home[:3, :3])]


def joint_axes(exercise: Exercise) -> list[tuple[sympy.Matrix, sympy.Matrix]]:
    """Return a direction and a point of each joint axis, with all joint variables 0.

    Both are 3×1 in the base frame. Raises LookupError if the robot has no table.
    """
    robot, algebra = exercise.robot, Algebra(exercise, home=True)
    # The joint axis is z before the motions of a standard row, but after a and α of a modified one.
    at = 0 if robot.convention is Convention.STANDARD else 2
    rotation, position = sympy.eye(3), sympy.zeros(3, 1)
    axes = []
    for row, _ in zip(robot.tables[robot.convention].rows, robot.joints, strict=False):
        for i, motion in enumerate(link(row, robot.convention, algebra)):
            if i == at:
                axes.append((rotation * Z, position))
            step = multiplied([motion])
            position += rotation * step.position
            rotation *= step.rotation
    return axes
