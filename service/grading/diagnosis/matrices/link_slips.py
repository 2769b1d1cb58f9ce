"""Slips in one of several link transforms: what belongs in the links before it stands in it."""

from collections.abc import Callable, Sequence
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
from service.grading.feedback import Finding
from service.grading.judging.expected import as_entries
from service.grading.misconception import Written, explanation
from service.grading.numerics.samples import Samples
from service.kinematics.chain import A, D, compound
from service.kinematics.dh import Convention
from service.kinematics.dh_row import row
from service.kinematics.transforms import Matrices, Numbers, rot_z


@dataclass(frozen=True)
class LinkAmongOthers:
    """A link transform in its chain.

    ``links`` ``(k, samples, 4, 4)`` are the right ones up to it, the last its own. ``angles``
    ``(j, samples)`` are the joint angles of the links before it.
    """

    links: Matrices
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
        """The last of ``links`` ``(k, SAMPLES, 4, 4)``, at ``count`` samples of each half."""
        turning = [joint.variable for joint in joints[: len(links) - 1] if not joint.prismatic]
        values = samples.subset(count).values
        subset = Samples.subset_of(np.moveaxis(links, 1, -1), count)
        return cls(np.moveaxis(subset, -1, 1), [values[name] for name in turning], convention)


def absolute_angle(link: LinkAmongOthers) -> Hypotheses:
    """The angle was measured from the base: A2 holds θ1 + θ2, not θ2."""
    finding = Finding(
        "absolute_angle",
        "A link transform holds the variable of its own joint only. The joints before it have link "
        "transforms of their own.",
    )
    for first in range(len(link.angles)):
        total = np.sum(link.angles[first:], axis=0)
        for sign in (1, -1):
            turn = rot_z(sign * total)
            factors = (turn, link.links[-1])
            standard = link.convention is Convention.STANDARD
            product = np.matmul(*(factors if standard else factors[::-1]))
            yield Written(as_entries(product), finding)


def pose_for_link(link: LinkAmongOthers) -> Hypotheses:
    """The product of all links up to this one was handed in."""
    finding = Finding(
        "pose_for_link",
        "This is the product of all link transforms up to this one. A link transform leads from "
        "one frame to the next only.",
    )
    if len(link.links) > 1:
        yield Written(as_entries(compound(link.links)), finding)


def translation_not_turned(link: LinkAmongOthers) -> Hypotheses:
    """The translations were written beside the rotation, as if nothing turned them."""
    finding = Finding(
        "translation_not_turned",
        "The rotation is right, but the last column is not turned with it. Check the order of the "
        "four factors of a link transform.",
    )
    right = link.links[-1]
    cells = row(right, link.convention)
    beside = right.copy()
    beside[:, :3, 3] = np.stack([cells[A], np.zeros_like(cells[A]), cells[D]], axis=-1)
    yield Written(as_entries(beside), finding)


MISCONCEPTIONS = (absolute_angle, pose_for_link, translation_not_turned)


def explain_link(link: LinkAmongOthers, case: MatrixCase) -> list[Explanation]:
    """What explains a wrong link transform, or its rotation or position, by the links before it."""
    whole = as_explanations(case, explanation(case, MISCONCEPTIONS, link))
    return whole or [
        found
        for block in (ROTATION_BLOCK, POSITION_BLOCK)
        if case.wrong[block].any()
        for found in as_explanations(case, explanation(case, (_in_block(block),), link))
    ]


def _in_block(block: Block) -> Callable[[LinkAmongOthers], Hypotheses]:
    """The first misconception, in one block of the matrix alone."""

    def of_link(link: LinkAmongOthers) -> Hypotheses:
        for hypothesis in absolute_angle(link):
            yield replace(hypothesis, answer=hypothesis.answer[block], entries=block)

    return of_link
