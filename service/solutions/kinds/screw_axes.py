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


def answer_screw_axes(part: ScrewAxesSpec, work: Work) -> PrintedAnswer:
    """Return the screw axes that the exercise file gives, or else those of the robot."""
    # The robot's joints are at home.
    given = work.as_written(part)
    if given:
        return layout.matrix(given)
    axes = _in_space(work.exercise, work.algebra)
    if part.frame == "body":
        home = multiplied(between(work.exercise, "tool", "base", work.algebra, home=True))
        R, p = home.rotation, home.position
        # Ad_T (ω; v) = (R ω; R v + p × R ω). Source: *Modern Robotics*, definition 3.20.
        axes = [(R * omega, R * v + p.cross(R * omega)) for omega, v in axes]
    rows = [[sympy.expand(number) for half in axis for number in half] for axis in axes]
    return work.matrix(sympy.Matrix(rows))


def _in_space(exercise: Exercise, algebra: Algebra) -> list[tuple[sympy.Matrix, sympy.Matrix]]:
    if isinstance(exercise.reference, ScrewRobot):
        rows = algebra.matrix(exercise.reference.axes).tolist()
        return [(sympy.Matrix(row[:3]), sympy.Matrix(row[3:])) for row in rows]
    axes = zip(exercise.joints, joint_axes(exercise), strict=True)
    return [
        (sympy.zeros(3, 1), direction) if joint.prismatic else (direction, point.cross(direction))
        for joint, (direction, point) in axes
    ]


def lazy_screw_axes(part: ScrewAxesSpec, exercise: Exercise) -> list[object]:
    """Return two answers: every axis is the z axis of the base frame, and every axis is zero."""
    kinds = [joint.prismatic for joint in exercise.joints]
    prismatic = kinds if part.expected is None else [False] * len(part.expected)
    axes = [["0"] * 5 + ["1"] if slides else [*"001000"] for slides in prismatic]
    return [axes, [["0"] * 6] * len(axes)]
