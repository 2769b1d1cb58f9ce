"""Transforms that a student may have worked out in place of the one asked for.

Each function is one misconception about how a pose comes from the links of a chain. It returns the
poses that the misconception leads to; where one is the student's matrix, or all of its rotation or
of its position, the misconception explains it.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from service.grading.diagnosis.matrix_case import Chain
from service.kinematics.chain import compound
from service.kinematics.transforms import Matrices


@dataclass(frozen=True, slots=True)
class Alternative:
    """Another pose ``(SAMPLES, 4, 4)`` and the misconception behind it.

    ``what`` names the pose, so that "This matrix is …" and "The position comes from …" are
    sentences; ``look`` says what to look at, ``correction`` what would be right.
    """

    code: str
    what: str
    hint: str
    correction: str
    pose: Matrices


def reversed_product(chain: Chain) -> list[Alternative]:
    """The link transforms were multiplied in reverse order."""
    order = range(len(chain.links))
    wrong_way = chain.product(order[::-1])
    return [
        Alternative(
            "reversed_product",
            f"the product of the link transforms in reverse order, {wrong_way}",
            "Each link transform describes its frame in the one before.",
            f"Multiply {chain.product(order)}.",
            compound(chain.links[::-1]),
        )
    ]


def other_convention(chain: Chain) -> list[Alternative]:
    """The link transform of the other convention was filled with this table's numbers."""
    used, right = chain.other_convention.value, chain.convention.value
    return [
        Alternative(
            "other_convention",
            f"the product that the table gives with the link transform of the {used} convention",
            "Check in which order a link transform turns and shifts about z and about x.",
            f"The table is written in the {right} convention.",
            compound(chain.misread_links),
        )
    ]


def wrong_frame(chain: Chain) -> list[Alternative]:
    """The pose of a frame before the last was handed in."""
    last = len(chain.links)
    return [
        Alternative(
            "wrong_frame",
            f"the pose of frame {chain.frame(k)}",
            f"The pose of frame {chain.frame(last)} is asked for.",
            f"Go on with {chain.product(range(k, last))}.",
            chain.from_base[k - 1],
        )
        for k in reversed(range(1, last))
    ]


def wrong_base(chain: Chain) -> list[Alternative]:
    """The pose was given as seen from a frame behind the base frame."""
    last = len(chain.links)
    return [
        Alternative(
            "wrong_base",
            f"the pose seen from frame {chain.frame(k)}",
            f"The pose in frame {chain.frame(0)} is asked for.",
            f"Put {chain.product(range(k))} in front.",
            chain.to_end[k],
        )
        for k in range(1, last)
    ]


def missing_link(chain: Chain) -> list[Alternative]:
    """One link transform between the first and the last was left out of the product."""
    last = len(chain.links)
    inner = range(1, last - 1)
    if not inner:
        return []
    poses = chain.from_base[: last - 2] @ chain.to_end[2:]
    return [
        Alternative(
            "missing_link",
            f"the product without A{chain.frames[i + 1]}",
            "Check that each row of the table takes part in the product.",
            f"Multiply {chain.product(range(last))}.",
            poses[i - 1],
        )
        for i in inner
    ]


def premultiplied(chain: Chain) -> list[Alternative]:
    """One link transform was multiplied from the left, as if it turned about the fixed base axes.

    Multiplied so throughout, the whole product is reversed, down to the turns and shifts in a link.
    """
    order = list(range(len(chain.links)))
    right = f"Multiply from the right throughout: {chain.product(order)}."
    look = "What happens about the axes of the frame reached so far is multiplied from the right."
    poses = chain.links[1:] @ chain.from_base[:-1]
    poses[:-1] = poses[:-1] @ chain.to_end[2:]
    alternatives = [
        Alternative(
            "premultiplied",
            f"the product with A{chain.frames[k + 1]} multiplied from the left, "
            f"{chain.product([k, *order[:k], *order[k + 1 :]])}",
            look,
            right,
            poses[k - 1],
        )
        for k in order[1:]
    ]
    throughout = Alternative(
        "premultiplied",
        "the product of all turns and shifts in reverse order, each multiplied from the left",
        look,
        right,
        compound(chain.misread_links[::-1]),
    )
    return [*alternatives, throughout]


MISCONCEPTIONS: tuple[Callable[[Chain], list[Alternative]], ...] = (
    reversed_product,
    other_convention,
    wrong_frame,
    wrong_base,
    missing_link,
    premultiplied,
)


def alternatives(chains: tuple[Chain, ...]) -> list[Alternative]:
    """The poses of all misconceptions, those of the exercise's own convention first."""
    return [
        alternative
        for chain in chains
        for misconception in MISCONCEPTIONS
        for alternative in misconception(chain)
    ]


def as_entries(poses: Matrices) -> Matrices:
    """``(..., SAMPLES, 4, 4)`` as ``(..., 4, 4, SAMPLES)``."""
    return np.moveaxis(poses, -3, -1)
