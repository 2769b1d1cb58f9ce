"""Slips in a composite motion (turns and displacements) that an exercise gives in formulas."""

from collections.abc import Iterator, Sequence
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
    PositionBlock,
    RotationBlock,
    UpperRows,
)
from service.grading.diagnosis.motions.given_motion import Displacement, GivenMotion, product
from service.grading.diagnosis.wrong_value import Hypotheses
from service.grading.feedback import Finding
from service.grading.misconception import Written, hypotheses_of, misconception, says
from service.grading.numerics.tolerances import EXACT_VALUE
from service.translations import Sentence, listed, say, say_count

# If there are more ways to leave turns out, none is tried.
MAX_WAYS = 64


class WholeMotion:
    """A transform that is composed of turns and displacements."""


class TurnsOfMotion:
    """A rotation that is composed of turns."""


class Displacements:
    """A position that is a sum of displacements."""


def _with_sum(sentence: Sentence) -> Finding:
    return says(
        say(
            "{sentence} The position is the sum of all displacements, each turned by the turns "
            "before it.",
            sentence=sentence,
        )
    )


@misconception(
    of=Displacements,
    rank=10,
    code="displacement_not_turned",
    rule="product",
    means="a displacement is added without the turns before it: d1 + d2 for d1 + R1 d2",
    example=("rigid-motion-chain", "origin", "[l1, l2, h]"),
    unlike="[l1, 0, h]",
)
def displacement_not_turned(motion: GivenMotion) -> Hypotheses:
    """The student left out the turns before a displacement: d1 + d2 for d1 + R1 d2."""
    found = motion.displacements
    if prod(2 ** len(each.angles) for each in found) > MAX_WAYS:
        return
    ways = cartesian(*(list(_subsets(each.angles)) for each in found))
    for straight in sorted(ways, key=lambda each: sum(map(len, each))):
        if any(straight):
            pairs = zip(found, straight, strict=True)
            position = sum((motion.part(each, angles) for each, angles in pairs), np.zeros(1))
            # A position of zeros does not show which displacements it contains.
            if np.abs(position).max() > EXACT_VALUE:
                yield Written(position, _not_turned(found, straight))


def _not_turned(found: Sequence[Displacement], straight: Sequence[tuple[str, ...]]) -> Finding:
    said = [
        _clause(each.lengths, angles)
        for each, angles in zip(found, straight, strict=True)
        if angles
    ]
    # Translators: {clauses} is a list such as "l1 is not turned by phi".
    hint = say(
        "In this position {clauses}. Every turn before a displacement turns it: d = d1 + R1 d2.",
        clauses=listed(said),
    )
    return says(hint)


def _clause(lengths: Sequence[str], angles: Sequence[str]) -> Sentence:
    if not lengths:
        return say("the displacement is not turned by {angles}", angles=listed(angles))
    return say_count(
        "{lengths} is not turned by {angles}",
        "{lengths} are not turned by {angles}",
        count=len(lengths),
        lengths=listed(lengths),
        angles=listed(angles),
    )


@misconception(
    of=Displacements,
    rank=20,
    code="missing_displacement",
    rule="product",
    means="the displacement of one motion is missing in the sum, or is the whole answer",
    example=("rigid-motion-chain", "origin", "[l1, 0, h]"),
    unlike={"1/1": "0"},
)
def missing_displacement(motion: GivenMotion) -> Hypotheses:
    """One displacement is missing in the sum."""
    found = motion.displacements
    for i in range(len(found)) if len(found) > 1 else ():
        if _are_numbered(found):
            missing = say("The displacement of motion {motion} is missing.", motion=i + 1)
        else:
            missing = say("The displacement of one motion is missing.")
        yield Written(motion.position() - motion.part(found[i]), _with_sum(missing))


@misconception(
    of=Displacements,
    rank=30,
    code="missing_displacement",
    rule="product",
    means="the displacement of one motion is missing in the sum, or is the whole answer",
    example=("rigid-motion-chain", "point", "[l1, 0, h]"),
    unlike="[0, 0, 0]",
)
def lone_displacement(motion: GivenMotion) -> Hypotheses:
    """The answer is a single displacement instead of the sum."""
    # It may be described in any of the frames.
    found = motion.displacements
    for i, each in enumerate(found) if len(found) > 1 else ():
        if _are_numbered(found):
            alone = say("This is the displacement of motion {motion} alone.", motion=i + 1)
        else:
            alone = say("This is the displacement of one motion alone.")
        for straight in _subsets(each.angles):
            yield Written(motion.part(each, straight), _with_sum(alone))


def _are_numbered(found: Sequence[Displacement]) -> bool:
    # If displacement k comes after k - 1 turns, it belongs to motion k.
    return [len(each.angles) for each in found] == list(range(len(found)))


@misconception(
    of=TurnsOfMotion,
    rank=20,
    code="missing_turn",
    rule="product",
    means="a turn is missing",
    example=(
        "rigid-motion-chain",
        "transform",
        "[cφ, -sφ, 0, l1 - l2 sφ; sφ, cφ, 0, l2 cφ; 0, 0, 1, h; 0, 0, 0, 1]",
    ),
    unlike={"1/3": "1", "3/3": "cos(theta)/2"},
)
def turn_left_out(motion: GivenMotion) -> Hypotheses:
    """A turn is missing in the rotation."""
    for some in _subsets(motion.angles):
        if 0 < len(some) < len(motion.angles):
            hint = say("The turn by {angles} is missing from this rotation.", angles=listed(some))
            yield Written(motion.rotation(some), says(hint))


@misconception(
    of=TurnsOfMotion,
    rank=30,
    code="turn_sign",
    rule="product",
    means="a turn has the opposite sense",
    example=(
        "rigid-motion-chain",
        "transform",
        "[cφ, -sφ cθ, -sφ sθ, l1 - l2 sφ; sφ, cφ cθ, cφ sθ, l2 cφ; 0, -sθ, cθ, h; 0, 0, 0, 1]",
    ),
    unlike={"2/2": "0"},
)
def turn_reversed(motion: GivenMotion) -> Hypotheses:
    """A turn has the opposite sense."""
    for angle in motion.angles:
        values = {**motion.values, angle: -motion.values[angle]}
        rotation = replace(motion, values=values).rotation()
        finding = says(
            say(
                "The turn by {angle} goes the wrong way: check the signs of its sines.",
                angle=angle,
            )
        )
        yield Written(rotation, finding)


@misconception(
    of=TurnsOfMotion,
    rank=10,
    code="reversed_product",
    rule="product",
    means="the link transforms, exponentials, turns or motions are multiplied in the wrong order",
    example=(
        "rigid-motion-chain",
        "transform",
        "[cφ, -sφ, 0, l1 - l2 sφ; cθ sφ, cθ cφ, -sθ, l2 cφ; sθ sφ, sθ cφ, cθ, h; 0, 0, 0, 1]",
    ),
    unlike={"2/2": "0"},
)
def turns_in_another_order(motion: GivenMotion) -> Hypotheses:
    """The turns were multiplied in the wrong order."""
    for order in list(permutations(motion.angles))[1:] if motion.order else ():
        yield Written(motion.turned(order), OTHER_ORDER)


OTHER_ORDER = says(
    say(
        "The motions were multiplied in the wrong order. Each is described in the frame that the "
        "one before it has reached, so the first stands on the left."
    ),
)


@misconception(
    of=WholeMotion,
    rank=10,
    code="reversed_product",
    rule="product",
    means="the link transforms, exponentials, turns or motions are multiplied in the wrong order",
    example=(
        "rigid-motion-chain",
        "transform",
        "[cφ, -sφ, 0, l1; cθ sφ, cθ cφ, -sθ, l2 - h sθ; sθ sφ, sθ cφ, cθ, h cθ; 0, 0, 0, 1]",
    ),
    unlike={"2/2": "0"},
)
def steps_in_reverse(motion: GivenMotion) -> Hypotheses:
    """Some or all motions were multiplied in reverse order."""
    steps = motion.steps
    if steps is not None and len(steps) > 2:
        *moved, last = steps
        for factors in ([last, *moved[::-1]], [moved[-1] @ last, *moved[-2::-1]]):
            yield Written(np.moveaxis(product(factors), 0, -1)[:3], OTHER_ORDER)


def _subsets(names: Sequence[str]) -> Iterator[tuple[str, ...]]:
    return chain.from_iterable(combinations(names, count) for count in range(len(names) + 1))


def _in_matrix(case: MatrixCase, of: type, block: Block) -> Hypotheses:
    motion = None if block != ROTATION_BLOCK and not case.is_transform else case.motion
    for hypothesis in hypotheses_of(motion, of) if motion else ():
        answer = hypothesis.answer.reshape(case.expected[block].shape)
        yield replace(hypothesis, answer=answer, entries=block)


@misconception(of=UpperRows, rank=90)
def motion_of_rows(case: MatrixCase) -> Hypotheses:
    """A wrong sequence of motions explains the transform."""
    return _in_matrix(case, WholeMotion, UPPER_ROWS)


@misconception(of=RotationBlock, rank=90)
def turns_of_rotation(case: MatrixCase) -> Hypotheses:
    """Wrong turns explain the rotation."""
    return _in_matrix(case, TurnsOfMotion, ROTATION_BLOCK)


@misconception(of=PositionBlock, rank=90)
def displacements_of_position(case: MatrixCase) -> Hypotheses:
    """A wrong sum of displacements explains the position."""
    return _in_matrix(case, Displacements, POSITION_BLOCK)
