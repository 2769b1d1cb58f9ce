"""The model answer of kind ``frames``."""

import sympy

from service.catalogue import Exercise
from service.catalogue.parts.frames import FRAME_CELLS, FramesSpec, frame_labels
from service.expressions.tree import Node
from service.kinematics.dh import Convention
from service.solutions import layout
from service.solutions.algebra import Algebra
from service.solutions.chains import link
from service.solutions.model_solution import PrintedAnswer
from service.solutions.motions import multiplied
from service.solutions.work import Work

_BASE = "xyz"


def answer_frames(part: FramesSpec, work: Work) -> PrintedAnswer:
    """Return the frames of the robot's own table, with all joint variables 0."""
    exercise = work.exercise
    robot, algebra = exercise.robot, Algebra(exercise, home=True)
    labels = frame_labels(robot, part.convention)
    standard = part.convention is Convention.STANDARD
    motions = []
    rows = []
    table = robot.tables[part.convention].rows
    for i, label in enumerate(labels):
        motions += link(table[i], part.convention, algebra)
        reached = multiplied(motions)
        origin = [work.writer.number(sympy.expand(each)) for each in reached.position]
        joint = robot.joints[i + 1 if standard else i].index
        z, x = (_direction(reached.rotation[:, column], work) for column in (2, 0))
        rows.append(layout.PrintedFrame(label, str(joint), z, origin, x))
    return layout.frames(rows)


def _direction(vector: sympy.Matrix, work: Work) -> str | list[Node]:
    simple = [sympy.simplify(each) for each in vector]
    for axis, component in enumerate(simple):
        if component in (1, -1):
            return f"{'+' if component == 1 else '-'}{_BASE[axis]}"
    return [work.writer.number(each) for each in simple]


def lazy_frames(part: FramesSpec, exercise: Exercise) -> list[object]:
    """Return frames on the correct joints that are all equal to the base frame."""
    standard = part.convention is Convention.STANDARD
    joints = [joint.index for joint in exercise.joints][int(standard) :]
    labels = frame_labels(exercise.robot, part.convention)
    rows = [
        dict(zip(FRAME_CELLS, [str(joint), "+z", "0", "0", "0", "+x"], strict=True))
        for joint, _ in zip(joints, labels, strict=False)
    ]
    return [rows]
