"""Slips in a single link transform."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from service.catalogue import Joint
from service.grading.diagnosis.matrices.matrix_case import (
    POSITION_BLOCK,
    ROTATION_BLOCK,
    Block,
    Explanation,
    MatrixCase,
    as_explanations,
)
from service.grading.diagnosis.wrong_value import Hypotheses
from service.grading.judging.expected import as_entries
from service.grading.misconception import Written, explanation, hypotheses_of, misconception, says
from service.grading.numerics.samples import Samples
from service.kinematics.chain import A, D, compound
from service.kinematics.dh import Convention
from service.kinematics.dh_row import row
from service.kinematics.transforms import Matrices, Numbers, rot_z
from service.translations import say


@dataclass(frozen=True)
class LinkAmongOthers:
    """A link transform, together with the links before it."""

    # The correct transforms (k, samples, 4, 4); the last one is the link itself.
    links: Matrices
    # The joint angles (j, samples) of the links before it.
    angles: Sequence[Numbers]
    convention: Convention

    @classmethod
    def of(
        cls,
        links: Matrices,
        joints: Sequence[Joint],
        samples: Samples,
        convention: Convention,
        count: int,
    ) -> "LinkAmongOthers":
        """Return the last of the ``links`` with the links before it, at ``count`` samples."""
        turning = [joint.variable for joint in joints[: len(links) - 1] if not joint.prismatic]
        values = samples.subset(count).values
        subset = Samples.subset_of(np.moveaxis(links, 1, -1), count)
        return cls(np.moveaxis(subset, -1, 1), [values[name] for name in turning], convention)


@misconception(
    of=LinkAmongOthers,
    rank=10,
    code="absolute_angle",
    rule="product",
    means="a link transform also contains the angles of the joints before it: θ1 + θ2 in A2",
    example=(
        "planar-rr",
        "links",
        (
            "A1 = [c1, -s1, 0, a1 c1; s1, c1, 0, a1 s1; 0, 0, 1, 0; 0, 0, 0, 1] ↵ A2 = [c12, -s12, "
            "0, a2 c12; s12, c12, 0, a2 s12; 0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"A1.3/2": "1"},
)
def absolute_angle(link: LinkAmongOthers) -> Hypotheses:
    """The student added the angles of earlier joints: A2 contains θ1 + θ2 instead of θ2."""
    finding = says(
        say(
            "A link transform holds the variable of its own joint only. The joints before it have "
            "link transforms of their own."
        ),
    )
    for first in range(len(link.angles)):
        total = np.sum(link.angles[first:], axis=0)
        for sign in (1, -1):
            turn = rot_z(sign * total)
            factors = (turn, link.links[-1])
            standard = link.convention is Convention.STANDARD
            product = np.matmul(*(factors if standard else factors[::-1]))
            yield Written(as_entries(product), finding)


@misconception(
    of=LinkAmongOthers,
    rank=20,
    code="pose_for_link",
    rule="product",
    means="a link transform is replaced by the product of all up to it",
    example=(
        "planar-rr",
        "links",
        (
            "A1 = [c1, -s1, 0, a1 c1; s1, c1, 0, a1 s1; 0, 0, 1, 0; 0, 0, 0, 1] ↵ A2 = [c12, -s12, "
            "0, a1 c1 + a2 c12; s12, c12, 0, a1 s1 + a2 s12; 0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"A1.3/2": "1"},
)
def pose_for_link(link: LinkAmongOthers) -> Hypotheses:
    """The student submitted the product of all link transforms up to this link."""
    finding = says(
        say(
            "This is the product of all link transforms up to this one. A link transform leads "
            "from one frame to the next only."
        ),
    )
    if len(link.links) > 1:
        yield Written(as_entries(compound(link.links)), finding)


@misconception(
    of=LinkAmongOthers,
    rank=30,
    code="translation_not_turned",
    rule="convention",
    means="the position of a link transform holds a and d as they are, not turned",
    example=("spatial-rrr", "links", {"A1.1/4": "R", "A1.2/4": "0"}),
    unlike={"A1.2/4": "R*s2"},
)
def translation_not_turned(link: LinkAmongOthers) -> Hypotheses:
    """The student wrote a and d into the position without turning them."""
    finding = says(
        say(
            "The rotation is right, but the last column is not turned with it. Check the order of "
            "the four factors of a link transform."
        ),
    )
    right = link.links[-1]
    cells = row(right, link.convention)
    beside = right.copy()
    beside[:, :3, 3] = np.stack([cells[A], np.zeros_like(cells[A]), cells[D]], axis=-1)
    yield Written(as_entries(beside), finding)


class RotationAmongOthers:
    """The rotation of a link transform."""


class PositionAmongOthers:
    """The position of a link transform."""


@misconception(of=RotationAmongOthers, rank=10)
def angle_in_rotation(link: LinkAmongOthers) -> Hypotheses:
    """Only the rotation contains the angles of earlier joints."""
    return _in_block(link, ROTATION_BLOCK)


@misconception(
    of=PositionAmongOthers,
    rank=10,
    example=("planar-rr", "links", {"A2.1/4": "a2 c12", "A2.2/4": "a2 s12"}),
)
def angle_in_position(link: LinkAmongOthers) -> Hypotheses:
    """Only the position contains the angles of earlier joints."""
    return _in_block(link, POSITION_BLOCK)


def _in_block(link: LinkAmongOthers, block: Block) -> Hypotheses:
    for hypothesis in hypotheses_of(link):
        if hypothesis.record and hypothesis.record.function is absolute_angle:
            yield replace(hypothesis, answer=hypothesis.answer[block], entries=block)


def explain_link(link: LinkAmongOthers, case: MatrixCase) -> list[Explanation]:
    """Return explanations of a wrong link transform."""
    return as_explanations(case, explanation(case, link)) or [
        found
        for block, kind in (
            (ROTATION_BLOCK, RotationAmongOthers),
            (POSITION_BLOCK, PositionAmongOthers),
        )
        if case.wrong[block].any()
        for found in as_explanations(case, explanation(case, link, kind))
    ]
