"""Marks for what follows from an earlier answer of the student's own.

An early slip must not cost every later part. A part that follows from another one is judged by the
student's own answer there where the reference says that it is wrong; but only an answer that is
good enough to carry it, so that a trivial table cannot buy easy marks.
"""

from collections.abc import Mapping

import numpy as np

from service.catalogue import (
    DhTableSpec,
    Exercise,
    LinkTransformsSpec,
    PartSpec,
    TransformSpec,
)
from service.grading.dh_table import read_chain
from service.grading.expected import is_whole_chain
from service.grading.findings import Finding
from service.grading.link_transforms import read_links
from service.grading.matrices import UnreadableMatrixError, numbers_of, read_matrix
from service.grading.protocol import Grading, OwnChain
from service.grading.report import PartReport, Severity
from service.grading.samples import LANES
from service.grading.transform import HOMOGENEOUS
from service.kinematics.transforms import Matrices, identity


def followed_part(
    part: PartSpec, answers: Mapping[str, object], exercise: Exercise
) -> PartSpec | None:
    """The part that this one follows from: where that one has no answer, the one it follows."""
    while part.follows is not None:
        source = exercise.part(part.follows)
        if source is None or answers.get(source.id) is not None:
            return source
        part = source
    return None


def own_chain(part: PartSpec, answer: object, grading: Grading) -> OwnChain | None:
    """The student's answer to a part as a chain; None where it cannot be read as one."""
    if isinstance(part, DhTableSpec):
        return read_chain(part, answer, grading)
    if isinstance(part, LinkTransformsSpec):
        read = read_links(part, answer, grading)
        return None if read is None else _chain(read.values, read.variables)
    if isinstance(part, TransformSpec):
        return _pose_chain(answer, grading)
    return None


def _pose_chain(answer: object, grading: Grading) -> OwnChain | None:
    try:
        entries = read_matrix(answer, HOMOGENEOUS, grading.reader)
    except UnreadableMatrixError:
        return None
    values = np.moveaxis(numbers_of(entries, HOMOGENEOUS, grading.reader), -1, 0)
    found = [entry.expression for row in entries for entry in row if entry.expression]
    variables = frozenset().union(*(expression.symbols for expression in found))
    return _chain(values[None], variables)


def _chain(links: Matrices, variables: frozenset[str]) -> OwnChain | None:
    if np.isnan(links).any():
        return None
    frames = [identity((LANES,))]
    for link in links:
        frames.append(frames[-1] @ link)
    return OwnChain(np.array(frames), None, variables)


def carries(own: OwnChain, report: PartReport, part: PartSpec, exercise: Exercise) -> bool:
    """Whether an earlier answer is good enough to carry the part that follows from it."""
    earned = report.points >= part.follows_from * report.max_points
    return earned and own.variables >= {joint.variable for joint in exercise.joints}


def stands_still(part: PartSpec, grading: Grading) -> bool:
    """Whether something was read that should move with the joints, and holds no joint variable."""
    if isinstance(part, TransformSpec):
        should_move = is_whole_chain(part, grading.exercise)
    else:
        should_move = isinstance(part, DhTableSpec | LinkTransformsSpec)
    variables = {joint.variable for joint in grading.exercise.joints}
    return should_move and not variables & grading.reader.symbols


STANDS_STILL = Finding(
    "no_joint_variable",
    "The answer holds no joint variable at all, so it describes an arm that cannot move: it earns "
    "nothing.",
)


def follows_from(source: PartSpec) -> Finding:
    """What a student is told who earned the points by following through."""
    return Finding(
        "follow_through",
        f"This is not the robot's, but it follows from your own answer to {source.title!r}: it "
        f"earns its points.",
        severity=Severity.INFO,
    )
