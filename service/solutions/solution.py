"""The model solution of an exercise."""

from collections.abc import Mapping
from dataclasses import dataclass

from service.catalogue import Exercise, PartSpec, Robot
from service.solutions import layout
from service.solutions.algebra import Algebra
from service.solutions.chains import between
from service.solutions.kinds import ANSWERS, Work, link_matrices
from service.solutions.layout import Shown
from service.solutions.motions import multiplied
from service.solutions.trees import TooLongError, Writer


@dataclass(frozen=True, slots=True)
class PartSolution:
    """What is right in one part."""

    part: str
    kind: str
    title: str
    shown: Shown


@dataclass(frozen=True, slots=True)
class Solution:
    """What is right in each part of an exercise, and how one comes to it.

    ``links`` are the link transforms of the robot's own table by its row labels, ``pose`` their
    product; ``notation`` says what each shorthand stands for.
    """

    exercise: str
    version: str
    parts: tuple[PartSolution, ...]
    links: Mapping[str, Shown]
    pose: Shown | None
    notation: Mapping[str, str]

    @property
    def answers(self) -> dict[str, object]:
        """The parts' answers as a submission holds them."""
        return {part.part: part.shown.answer for part in self.parts}


def solve(exercise: Exercise) -> Solution:
    """The model solution. Takes a few hundredths of a second; the same exercise, the same text."""
    work = Work(exercise, Algebra(exercise), Writer(exercise))
    robot = exercise.reference
    links = link_matrices(work, robot.convention) if isinstance(robot, Robot) else {}
    parts = tuple(
        PartSolution(part.id, part.kind, part.title, _answer(part, work)) for part in exercise.parts
    )
    pose = None if robot is None else _pose(work, list(links))
    # By function and length: c1, c2, c12, s1, s2, s12.
    notation = sorted(work.writer.used, key=lambda name: (name[0], len(name), name))
    return Solution(
        exercise=exercise.id,
        version=exercise.version,
        parts=parts,
        links=links,
        pose=pose,
        notation={name: work.writer.used[name] for name in notation},
    )


def _answer(part: PartSpec, work: Work) -> Shown:
    try:
        return ANSWERS[part.kind](part, work)
    except TooLongError:
        return layout.too_long()


def _pose(work: Work, labels: list[str]) -> Shown:
    """The pose of the tool in the base frame, as a product of link transforms if need be."""
    pose = multiplied(between(work.exercise, "base", "tool", work.algebra))
    try:
        return work.matrix(pose.matrix())
    except TooLongError:
        return layout.product(labels) if labels else layout.too_long()
