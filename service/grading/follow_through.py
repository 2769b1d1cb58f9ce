"""Marks for what follows from an earlier answer of the student's own.

An early slip must not cost every later part. A part that follows from another one is judged by the
student's own answer there where the reference says that it is wrong; but only an answer that is
good enough to carry it, so that a trivial table cannot buy easy marks.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from service.catalogue import Exercise, PartSpec
from service.catalogue.parts.dh_table import DhTableSpec
from service.catalogue.parts.link_transforms import LinkTransformsSpec
from service.catalogue.parts.transform import TransformSpec
from service.grading.feedback import Finding
from service.grading.judging.expected import is_whole_chain
from service.grading.kinds.dh_table import read_chain, read_frames
from service.grading.kinds.link_transforms import read_links
from service.grading.kinds.matrix_rows import UnreadableMatrixError, numbers_of, read_matrix
from service.grading.kinds.transform import HOMOGENEOUS
from service.grading.part import Grading, OwnChain
from service.grading.reading.entry import MAX_CHARACTERS
from service.grading.report import PartReport, Severity
from service.grading.samples import HALF, SAMPLES, Samples
from service.kinematics.chain import products
from service.kinematics.transforms import Matrices, inverse

# A joint's small motion, and what is small beside a chain's larger motions.
NUDGE = 1e-5
SMALL = 1e-3


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
        return None if read is None else _chain(read.values)
    if isinstance(part, TransformSpec):
        return _pose_chain(answer, grading)
    return None


def _pose_chain(answer: object, grading: Grading) -> OwnChain | None:
    try:
        entries = read_matrix(answer, HOMOGENEOUS, grading.reader)
    except UnreadableMatrixError:
        return None
    values = np.moveaxis(numbers_of(entries, HOMOGENEOUS, grading.reader), -1, 0)
    return _chain(values[None])


def _chain(links: Matrices) -> OwnChain | None:
    if np.isnan(links).any():
        return None
    return OwnChain(products(links), None)


def carries(
    source: PartSpec, answer: object, report: PartReport, part: PartSpec, grading: Grading
) -> bool:
    """Whether an earlier answer is good enough to carry the part that follows from it.

    It must have earned its share of the points, and describe an arm that moves in as many ways as
    the robot: one that has lost a freedom makes all that follows too easy.
    """
    if report.points < part.follows_from * report.max_points:
        return False

    def own_pose(grading: Grading) -> Matrices | None:
        if isinstance(source, DhTableSpec):
            own = read_frames(source, answer, grading)
            return None if own is None else own[-1]
        chain = own_chain(source, answer, grading)
        return None if chain is None else chain.frames[-1]

    def robot_s_pose(grading: Grading) -> Matrices | None:
        robot = grading.exercise.reference
        return None if robot is None else robot.frame("tool", grading.samples.values, SAMPLES)

    return _freedom(own_pose, grading) >= _freedom(robot_s_pose, grading)


def _freedom(pose: Callable[[Grading], Matrices | None], grading: Grading) -> int:
    """In how many ways the joints move a pose: the rank of its Jacobian, by small differences."""
    twists = []
    for joint in grading.exercise.joints:
        moved = pose(_nudged(grading, joint.variable))
        if moved is None:
            return 0
        twist = inverse(moved[:HALF]) @ moved[HALF:] - np.eye(4)
        twists.append(twist[:, :3].reshape(HALF, -1) / NUDGE)
    sizes = np.linalg.svd(np.array(twists).swapaxes(0, 1), compute_uv=False)
    ranks = np.sort((sizes > SMALL * sizes.max(initial=1.0)).sum(axis=-1))
    return int(ranks[len(ranks) // 2])


def _nudged(grading: Grading, variable: str) -> Grading:
    """The same grading at samples whose second half differs from the first in one joint only."""
    values = {name: np.tile(numbers[:HALF], 2) for name, numbers in grading.samples.values.items()}
    values[variable][HALF:] += NUDGE
    samples = Samples(values)
    reader = replace(grading.reader, samples=samples, left=MAX_CHARACTERS, unread=0)
    return replace(grading, samples=samples, reader=reader)


def stands_still(part: PartSpec, grading: Grading) -> bool:
    """Whether something was read that should move with the joints, and nothing in it does."""
    if isinstance(part, TransformSpec):
        should_move = is_whole_chain(part, grading.exercise)
    else:
        should_move = isinstance(part, DhTableSpec | LinkTransformsSpec)
    return should_move and not grading.reader.moving


STANDS_STILL = Finding(
    "no_joint_variable",
    "No joint variable has any effect in this answer, so it describes an arm that cannot move: it "
    "earns nothing.",
)


def follows_from(source: PartSpec) -> Finding:
    """What a student is told who earned the points by following through."""
    return Finding(
        "follow_through",
        f"This is not the robot's, but it follows from your own answer to {source.title!r}: it "
        f"earns its points.",
        severity=Severity.INFO,
    )
