"""The model answer of kind ``screw_axes``."""

import sympy

from service.catalogue import Exercise, ScrewRobot
from service.catalogue.parts.screw_axes import ScrewAxesSpec
from service.solutions import layout
from service.solutions.algebra import Algebra
from service.solutions.chains import between, joint_axes
from service.solutions.model_solution import PrintedAnswer
from service.solutions.motions import multiplied
from service.solutions.work import Work


def answer(part: ScrewAxesSpec, work: Work) -> PrintedAnswer:
    """The axes as the file gives them, or those of the robot's joints at home."""
    given = work.as_written(part)
    if given:
        return layout.matrix(given)
    return work.matrix(sympy.Matrix(_screw_axes(work.exercise, part.frame, work.algebra)))


def _screw_axes(exercise: Exercise, frame: str, algebra: Algebra) -> list[list[sympy.Expr]]:
    """The screw axis (ω; v) of each joint at home, seen from the "space" or the "body" frame."""
    axes = _in_space(exercise, algebra)
    if frame == "body":
        home = multiplied(between(exercise, "tool", "base", algebra, home=True))
        axes = [_seen_from(home.rotation, home.position, *axis) for axis in axes]
    return [[sympy.expand(number) for part in axis for number in part] for axis in axes]


def _in_space(exercise: Exercise, algebra: Algebra) -> list[tuple[sympy.Matrix, sympy.Matrix]]:
    if isinstance(exercise.reference, ScrewRobot):
        rows = algebra.matrix(exercise.reference.axes).tolist()
        return [(sympy.Matrix(row[:3]), sympy.Matrix(row[3:])) for row in rows]
    axes = zip(exercise.joints, joint_axes(exercise), strict=True)
    return [
        (sympy.zeros(3, 1), direction) if joint.prismatic else (direction, point.cross(direction))
        for joint, (direction, point) in axes
    ]


def _seen_from(
    rotation: sympy.Matrix, position: sympy.Matrix, omega: sympy.Matrix, v: sympy.Matrix
) -> tuple[sympy.Matrix, sympy.Matrix]:
    """Ad_T (ω; v) = (R ω; R v + p × R ω). Source: *Modern Robotics*, definition 3.20."""
    turned = rotation * omega
    return turned, rotation * v + position.cross(turned)
