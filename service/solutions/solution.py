"""The model solution of an exercise."""

from collections.abc import Sequence

from service.catalogue import Exercise, PartSpec, Robot
from service.solutions import layout
from service.solutions.algebra import Algebra
from service.solutions.chains import between
from service.solutions.kinds import ANSWERS
from service.solutions.model_solution import (
    LinkSolution,
    ModelSolution,
    PartAnswer,
    PrintedAnswer,
    Shown,
)
from service.solutions.motions import multiplied
from service.solutions.trees import TooLongError, Writer
from service.solutions.work import Work


def solved(exercise: Exercise) -> ModelSolution:
    """Return the model solution of an exercise."""
    # It depends only on the exercise.
    work = Work(exercise, Algebra(exercise), Writer(exercise))
    robot = exercise.reference
    links = work.link_matrices(robot.convention) if isinstance(robot, Robot) else {}
    parts = tuple(_part_answer(part, work) for part in exercise.parts)
    pose = None if robot is None else _pose(work, list(links))
    # Sort by function and length: c1, c2, c12, s1, s2, s12.
    notation = sorted(work.writer.used, key=lambda name: (name[0], len(name), name))
    return ModelSolution(
        exercise=exercise.id,
        version=exercise.version,
        notation={name: work.writer.used[name] for name in notation},
        parts=parts,
        links=tuple(LinkSolution(each.text, each.latex, label) for label, each in links.items()),
        pose=pose,
    )


def _part_answer(part: PartSpec, work: Work) -> PartAnswer:
    try:
        right: PrintedAnswer = ANSWERS[part.kind](part, work)
    except TooLongError:
        right = layout.too_long()
    return PartAnswer(right.text, right.latex, part.id, part.kind, part.title, right.answer)


def _pose(work: Work, labels: Sequence[str]) -> Shown:
    # A pose that is too long becomes a product of link transforms.
    pose = multiplied(between(work.exercise, "base", "tool", work.algebra))
    try:
        shown: Shown = work.matrix(pose.matrix())
    except TooLongError:
        shown = layout.product(labels) if labels else layout.too_long()
    return Shown(shown.text, shown.latex)
