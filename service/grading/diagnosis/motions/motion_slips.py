"""Slips in a motion made of several, where the exercise gives the result in formulas."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import chain, combinations, permutations
from itertools import product as cartesian
from math import prod

import numpy as np

from service.grading.diagnosis.matrices.matrix_case import (
    POSITION_BLOCK,
    ROTATION_BLOCK,
    UPPER_ROWS,
    Block,
    MatrixCase,
)
from service.grading.diagnosis.motions.given_motion import Displacement, GivenMotion, product
from service.grading.diagnosis.wording import listed
from service.grading.diagnosis.wrong_value import Hypotheses, WrongNumbers
from service.grading.feedback import Finding
from service.grading.misconception import Written, explanation, hypotheses_of
from service.grading.numerics.tolerances import EXACT_VALUE

# More ways to leave turns out are not tried.
MAX_WAYS = 64
ORDINALS = ("first", "second", "third", "fourth", "fifth")
SUM = "The position is the sum of all displacements, each turned by the turns before it."


def displacement_not_turned(motion: GivenMotion) -> Hypotheses:
    """A displacement was added as it stands in its own frame: d1 + d2 for d1 + R1 d2."""
    found = motion.displacements
    if prod(2 ** len(each.angles) for each in found) > MAX_WAYS:
        return
    ways = cartesian(*(list(_subsets(each.angles)) for each in found))
    for straight in sorted(ways, key=lambda each: sum(map(len, each))):
        if any(straight):
            pairs = zip(found, straight, strict=True)
            position = sum((motion.part(each, angles) for each, angles in pairs), np.zeros(1))
            # A position of zeros does not show how it came about.
            if np.abs(position).max() > EXACT_VALUE:
                yield Written(position, _not_turned(found, straight))


def _not_turned(found: Sequence[Displacement], straight: Sequence[tuple[str, ...]]) -> Finding:
    said = [
        f"{listed(each.lengths) or 'the displacement'} "
        f"{'are' if len(each.lengths) > 1 else 'is'} not turned by {listed(angles)}"
        for each, angles in zip(found, straight, strict=True)
        if angles
    ]
    return Finding(
        "displacement_not_turned",
        f"In this position {listed(said)}. Every turn before a displacement turns it: "
        "d = d1 + R1 d2.",
    )


def missing_displacement(motion: GivenMotion) -> Hypotheses:
    """The displacement of one motion is not in the sum."""
    found = motion.displacements
    for i in range(len(found)) if len(found) > 1 else ():
        finding = Finding(
            "missing_displacement",
            f"The displacement of {_which(found, i)} is missing. {SUM}",
        )
        yield Written(motion.position() - motion.part(found[i]), finding)


def lone_displacement(motion: GivenMotion) -> Hypotheses:
    """The displacement of one motion was given for the sum of all, in whatever frame."""
    found = motion.displacements
    for i, each in enumerate(found) if len(found) > 1 else ():
        finding = Finding(
            "missing_displacement",
            f"This is the displacement of {_which(found, i)} alone. {SUM}",
        )
        for straight in _subsets(each.angles):
            yield Written(motion.part(each, straight), finding)


def _which(found: Sequence[Displacement], i: int) -> str:
    """The motion that a displacement belongs to, where each has one and turns about one axis."""
    is_plain = [len(each.angles) for each in found] == list(range(len(found)))
    return f"the {ORDINALS[i]} motion" if is_plain else "one motion"


def turn_left_out(motion: GivenMotion) -> Hypotheses:
    """A turn is not in the rotation."""
    for some in _subsets(motion.angles):
        if 0 < len(some) < len(motion.angles):
            hint = f"The turn by {listed(some)} is missing from this rotation."
            yield Written(motion.rotation(some), Finding("missing_turn", hint))


def turn_reversed(motion: GivenMotion) -> Hypotheses:
    """A turn goes the wrong way."""
    for angle in motion.angles:
        values = {**motion.values, angle: -motion.values[angle]}
        rotation = replace(motion, values=values).rotation()
        finding = Finding(
            "turn_sign",
            f"The turn by {angle} goes the wrong way: check the signs of its sines.",
        )
        yield Written(rotation, finding)


def turns_in_another_order(motion: GivenMotion) -> Hypotheses:
    """The turns were multiplied in another order."""
    for order in list(permutations(motion.angles))[1:] if motion.order else ():
        yield Written(motion.turned(order), OTHER_ORDER)


OTHER_ORDER = Finding(
    "reversed_product",
    "The motions were multiplied in the wrong order. Each is described in the frame that the one "
    "before it has reached, so the first stands on the left.",
)


def steps_in_reverse(motion: GivenMotion) -> Hypotheses:
    """The motions were multiplied in reverse order, the last displacement with either turn."""
    steps = motion.steps
    if steps is not None and len(steps) > 2:
        *moved, last = steps
        for factors in ([last, *moved[::-1]], [moved[-1] @ last, *moved[-2::-1]]):
            yield Written(np.moveaxis(product(factors), 0, -1)[:3], OTHER_ORDER)


def _subsets(names: Sequence[str]) -> Iterator[tuple[str, ...]]:
    return chain.from_iterable(combinations(names, count) for count in range(len(names) + 1))


OF_MOTION = (steps_in_reverse,)
OF_TURNS = (turns_in_another_order, turn_left_out, turn_reversed)
OF_DISPLACEMENTS = (displacement_not_turned, missing_displacement, lone_displacement)
MISCONCEPTIONS = (*OF_MOTION, *OF_TURNS, *OF_DISPLACEMENTS)


def _in_matrix(
    misconceptions: Sequence[Callable[[GivenMotion], Hypotheses]], block: Block
) -> Callable[[MatrixCase], Hypotheses]:
    """The misconceptions about one block of a matrix."""

    def of_case(case: MatrixCase) -> Hypotheses:
        motion = None if block != ROTATION_BLOCK and not case.is_transform else case.motion
        for hypothesis in hypotheses_of(motion, misconceptions) if motion else ():
            answer = hypothesis.answer.reshape(case.expected[block].shape)
            yield replace(hypothesis, answer=answer, entries=block)

    return of_case


# The same of matrices.
OF_UPPER_ROWS = (_in_matrix(OF_MOTION, UPPER_ROWS),)
OF_ROTATION = (_in_matrix(OF_TURNS, ROTATION_BLOCK),)
OF_POSITION = (_in_matrix(OF_DISPLACEMENTS, POSITION_BLOCK),)


def explain_displacements(case: WrongNumbers, motion: GivenMotion | None) -> Finding | None:
    """The finding that explains a wrong position by the displacements that it is the sum of."""
    found = explanation(case, OF_DISPLACEMENTS, motion) if motion else None
    return found.findings[0] if found else None
