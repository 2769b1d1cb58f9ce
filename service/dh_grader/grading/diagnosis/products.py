"""Slips in composite motions, rotations, single links, home positions and exponentials.

This file knows slips in how turns, displacements and links are put together. Slips that change the
numbers of any matrix are in ``matrices.py``, slips in the table in ``upstream.py``.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, combinations, permutations
from itertools import product as cartesian
from math import prod

import numpy as np

from dh_grader.catalogue import Exercise, Joint, ScrewRobot
from dh_grader.catalogue.robot import at_home
from dh_grader.grading.diagnosis.motions import (
    POSITION_BLOCK,
    ROTATION_BLOCK,
    UPPER_ROWS,
    Block,
    Displacement,
    Explanation,
    GivenMotion,
    MatrixCase,
    PositionBlock,
    RotationBlock,
    UpperRows,
    as_explanations,
    product,
)
from dh_grader.grading.diagnosis.screws_and_placements import WrongScrews
from dh_grader.grading.judging import as_entries
from dh_grader.grading.misconception import (
    Hypotheses,
    Mask,
    Written,
    explanation,
    hypotheses_of,
    misconception,
    register,
    says,
)
from dh_grader.grading.numbers import EXACT_VALUE, Samples
from dh_grader.grading.reading.entries import Entry
from dh_grader.grading.report import Finding
from dh_grader.kinematics import (
    A,
    Convention,
    D,
    Matrices,
    Numbers,
    composed,
    compound,
    inverse,
    moved,
    product_in_body,
    product_in_space,
    rot_z,
    row,
)
from dh_grader.translations import Sentence, listed, say, say_count

# --- Slips in a composite motion (turns and displacements) that an exercise gives in formulas


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
    ways = cartesian(*(list(_subsets_of_names(each.angles)) for each in found))
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
    """The answer is a single displacement instead of the sum.

    It may be described in any of the frames.
    """
    found = motion.displacements
    for i, each in enumerate(found) if len(found) > 1 else ():
        if _are_numbered(found):
            alone = say("This is the displacement of motion {motion} alone.", motion=i + 1)
        else:
            alone = say("This is the displacement of one motion alone.")
        for straight in _subsets_of_names(each.angles):
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
    for some in _subsets_of_names(motion.angles):
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


def _subsets_of_names(names: Sequence[str]) -> Iterator[tuple[str, ...]]:
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


# --- Slips in a composite rotation, such as a wrong axis or a missing turn


# With more steps, only one of them is assumed to be wrong.
MAX_STEPS = 4


@dataclass(frozen=True, slots=True)
class Step:
    """One turn of a composite rotation."""

    # "X", "Y" or "Z".
    axis: str
    # (SAMPLES, 3, 3).
    rotation: Matrices
    # True for a fixed axis, False for a moving axis.
    fixed: bool


def explain_steps(case: MatrixCase, steps: Sequence[Step]) -> list[Explanation]:
    """Return explanations of a wrong rotation that should be the product of these turns."""
    count = case.actual.shape[-1] // 2
    subset = [replace(step, rotation=Samples.subset_of(step.rotation.T, count).T) for step in steps]
    return as_explanations(case, explanation(case, subset, Step)) if steps else []


def _with_rule(sentence: Sentence) -> Finding:
    return says(
        say(
            "{sentence} A turn about a fixed axis is multiplied from the left, one about a moving "
            "axis from the right.",
            sentence=sentence,
        )
    )


def _made_of(steps: Sequence[Step], finding: Finding) -> Written[Numbers]:
    rotation = composed([(step.rotation, step.fixed) for step in steps])
    return Written(as_entries(rotation), finding)


@misconception(
    of=Step,
    rank=10,
    code="fixed_for_moving_axes",
    rule="elementary_turn",
    means="a turn about a moving axis is multiplied as one about a fixed axis, or the other "
    "way round",
    example=(
        "composite-rotations",
        "fixed",
        (
            "[cφ cψ, -sφ, sψ cφ; sφ cψ cθ + sψ sθ, cφ cθ, sφ sψ cθ - sθ cψ; sφ sθ cψ - sψ cθ, sθ "
            "cφ, sφ sψ sθ + cψ cθ]"
        ),
    ),
    unlike={"2/3": "cos(theta)*cos(psi)", "3/3": "-sin(theta)"},
)
def fixed_for_moving(steps: Sequence[Step]) -> Hypotheses:
    """The student took a moving axis for a fixed one, or a fixed axis for a moving one."""
    exchanged = [replace(step, fixed=not step.fixed) for step in steps]
    finding = _with_rule(say("Every turn was multiplied from the wrong side."))
    yield _made_of(exchanged, finding)
    for i in range(1, len(steps)):
        finding = _with_rule(say("Turn {turn} was multiplied from the wrong side.", turn=i + 1))
        yield _made_of([*steps[:i], exchanged[i], *steps[i + 1 :]], finding)


@misconception(
    of=Step,
    rank=20,
    code="turn_sign",
    rule="elementary_turn",
    means="a turn has the opposite sense",
    example=("fundamental-rotations", "about-y", {"1/3": "-sin(phi)", "3/1": "sin(phi)"}),
    unlike={"1/1": "1"},
)
def turned_back(steps: Sequence[Step]) -> Hypotheses:
    """One or more turns have the opposite sense."""
    back = [replace(step, rotation=np.swapaxes(step.rotation, 1, 2)) for step in steps]
    for some in _subsets_of_steps(steps):
        axes = listed(sorted({steps[i].axis.lower() for i in some}))
        finding = says(
            say_count(
                "Turn {turns} goes the wrong way: check the signs of the sines in the rotation "
                "about {axes}.",
                "Turns {turns} go the wrong way: check the signs of the sines in the rotation "
                "about {axes}.",
                count=len(some),
                turns=_numbers(some),
                axes=axes,
            ),
        )
        yield _made_of([(back if i in some else steps)[i] for i in range(len(steps))], finding)


@misconception(
    of=Step,
    rank=30,
    code="turn_axis",
    rule="elementary_turn",
    means="a turn is about the wrong axis",
    example=(
        "composite-rotations",
        "fixed",
        (
            "[-sψ sθ cφ + cφ cψ cθ, sφ sψ sθ - sφ cψ cθ, sψ cθ + sθ cψ; sφ, cφ, 0; -sψ cφ cθ - sθ "
            "cφ cψ, sφ sψ cθ + sφ sθ cψ, -sψ sθ + cψ cθ]"
        ),
    ),
    unlike={"2/1": "0"},
)
def about_another_axis(steps: Sequence[Step]) -> Hypotheses:
    """One turn is about the wrong coordinate axis."""
    for i, step in enumerate(steps):
        for axis in "XYZ".replace(step.axis, ""):
            finding = says(
                say(
                    "Turn {turn} was made about {axis}: check which axis it is about.",
                    turn=i + 1,
                    axis=axis.lower(),
                ),
                say("It is about {axis}.", axis=step.axis.lower()),
            )
            turned = replace(step, rotation=_about(axis, step))
            yield _made_of([*steps[:i], turned, *steps[i + 1 :]], finding)


@misconception(
    of=Step,
    rank=40,
    code="turn_angle",
    rule="elementary_turn",
    means="a turn has the angle of another turn",
    example=("rigid-motion-chain", "rotation", "[cφ, -sφ cφ, sφ sφ; sφ, cφ cφ, -cφ sφ; 0, sφ, cφ]"),
    unlike={"3/2": "0"},
)
def by_another_angle(steps: Sequence[Step]) -> Hypotheses:
    """A turn has the angle of another turn."""
    for i, j in permutations(range(len(steps)), 2):
        finding = says(
            say(
                "Turn {turn} was made by the angle of turn {other}: check which angle belongs to "
                "which axis.",
                turn=i + 1,
                other=j + 1,
            ),
        )
        turned = list(steps)
        turned[i] = replace(steps[i], rotation=_about(steps[i].axis, steps[j]))
        yield _made_of(turned, finding)
    for i, j in combinations(range(len(steps)), 2):
        finding = says(
            say(
                "The angles of turns {turn} and {other} are exchanged: check which angle belongs "
                "to which axis.",
                turn=i + 1,
                other=j + 1,
            ),
        )
        turned = list(steps)
        for one, other in ((i, j), (j, i)):
            turned[one] = replace(steps[one], rotation=_about(steps[one].axis, steps[other]))
        yield _made_of(turned, finding)


@misconception(
    of=Step,
    rank=50,
    code="missing_turn",
    rule="elementary_turn",
    means="a turn is missing",
    example=(
        "composite-rotations",
        "fixed",
        "[1, 0, 0; 0, cos(theta), -sin(theta); 0, sin(theta), cos(theta)]",
    ),
    unlike={"3/1": "1"},
)
def left_out(steps: Sequence[Step]) -> Hypotheses:
    """One or more turns are missing in the product."""
    for some in _subsets_of_steps(steps):
        if len(some) < len(steps):
            hint = say_count(
                "Turn {turns} is missing from this rotation.",
                "Turns {turns} are missing from this rotation.",
                count=len(some),
                turns=_numbers(some),
            )
            yield _made_of([step for i, step in enumerate(steps) if i not in some], says(hint))


@misconception(
    of=Step,
    rank=60,
    code="reversed_product",
    rule="elementary_turn",
    means="the link transforms, exponentials, turns or motions are multiplied in the wrong order",
    example=(
        "composite-rotations",
        "mobile",
        (
            "[cφ cψ, cφ sψ sθ - sφ cθ, cφ sψ cθ + sφ sθ; sφ cψ, sφ sψ sθ + cφ cθ, sφ sψ cθ - cφ "
            "sθ; -sψ, cψ sθ, cψ cθ]"
        ),
    ),
    unlike={"1/1": "0"},
)
def another_order(steps: Sequence[Step]) -> Hypotheses:
    """The turns were multiplied in the wrong order."""
    moving = [replace(step, fixed=False) for step in steps if not step.fixed]
    factors = [*(replace(step, fixed=False) for step in steps[::-1] if step.fixed), *moving]
    finding = _with_rule(say("The turns were multiplied in the wrong order."))
    for order in list(permutations(factors))[1:] if len(steps) <= MAX_STEPS else ():
        yield _made_of(order, finding)


def _about(axis: str, step: Step) -> Matrices:
    shift = (ord(axis) - ord(step.axis)) % 3
    return np.roll(step.rotation, (shift, shift), axis=(1, 2))


def _subsets_of_steps(steps: Sequence[Step]) -> Iterator[tuple[int, ...]]:
    # If there are many turns, only sets of one turn are tried.
    most = len(steps) if len(steps) <= MAX_STEPS else 1
    return chain.from_iterable(combinations(range(len(steps)), k) for k in range(1, most + 1))


def _numbers(places: Sequence[int]) -> str:
    return listed([str(i + 1) for i in places])


# --- Slips in a single link transform


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


# --- Find joint variables in answers for the home position, where these variables are 0


NOT_AT_HOME = register(
    of=WrongScrews,
    code="not_at_home",
    rule="screw_axis",
    means="an answer for the home position, such as a screw axis or the home pose M, contains "
    "a joint variable",
    example=("planar-rpr-poe", "space-screws", {"3/4": "q1 q2"}),
    unlike={"3/4": "1"},
).finding(
    say("In the home position every joint variable is 0: no joint variable belongs here."),
    say("Put 0 for each joint variable."),
)


def with_joint_variable(entries: Sequence[Sequence[Entry]], exercise: Exercise) -> Mask:
    """Return a mask ``(rows, columns)`` of the entries that contain a joint variable."""
    variables = {joint.variable for joint in exercise.joints}
    return np.array(
        [
            [
                entry.expression is not None and not variables.isdisjoint(entry.expression.symbols)
                for entry in row
            ]
            for row in entries
        ],
        dtype=np.bool_,
    )


def explain_moving(
    case: MatrixCase, entries: Sequence[Sequence[Entry]], exercise: Exercise
) -> list[Explanation]:
    """Return explanations for entries of a home pose that wrongly contain a joint variable."""
    moving = np.asarray(case.wrong & with_joint_variable(entries, exercise))
    return [Explanation(NOT_AT_HOME, moving)] if moving.any() else []


# --- Slips in a product of exponentials


@dataclass(frozen=True, slots=True)
class Exponentials:
    """The factors of a product of exponentials: screw axes, joint values and home pose."""

    # The screw axes in the space frame, (n, SAMPLES, 6).
    space: Numbers
    # The screw axes in the body frame, (n, SAMPLES, 6).
    body: Numbers
    amounts: Numbers
    home: Matrices

    @classmethod
    def of(cls, robot: ScrewRobot, samples: Samples) -> "Exponentials":
        """Return the factors for the exercise's robot."""
        values, count = samples.values, samples.count
        home = robot.frame("tool", at_home(robot.joints, values, count), count)
        space = robot.screws(values, count)
        amounts = np.array([values[joint.variable] for joint in robot.joints])
        return cls(space, moved(inverse(home), space), amounts, home)


def explain_product(case: MatrixCase, exercise: Exercise, samples: Samples) -> list[Explanation]:
    """Return explanations of a wrong pose that should be a product of exponentials."""
    if not isinstance(exercise.reference, ScrewRobot):
        return []
    subset = samples.subset(case.actual.shape[-1] // 2)
    product = Exponentials.of(exercise.reference, subset)
    return as_explanations(case, explanation(case, product))


def _pose(pose: Matrices, finding: Finding) -> Written[Numbers]:
    return Written(np.moveaxis(pose, 0, -1), finding)


@misconception(
    of=Exponentials,
    rank=10,
    code="home_on_wrong_side",
    rule="exponentials",
    means="M is on the wrong side of the exponentials: it comes after those of space axes and "
    "before those of body axes",
    example=(
        "planar-rpr-poe",
        "pose",
        (
            "[c13, -s13, 0, L1 c1 - L1 c13 + L1 + L2 + theta2 c1; s13, c13, 0, L1 s1 - L1 s13 + "
            "theta2 s1; 0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"4/2": "1"},
)
def home_on_the_wrong_side(product: Exponentials) -> Hypotheses:
    """The home pose M is on the wrong side of the exponentials."""
    finding = says(
        say(
            "M stands on the wrong side of the exponentials: space axes are multiplied in front "
            "of M, body axes behind it."
        ),
        say("T = e^[S1]θ1 … e^[Sn]θn M = M e^[B1]θ1 … e^[Bn]θn."),
    )
    yield _pose(product_in_body(product.space, product.amounts, product.home), finding)
    yield _pose(product_in_space(product.body, product.amounts, product.home), finding)


@misconception(
    of=Exponentials,
    rank=20,
    code="missing_home",
    rule="exponentials",
    means="M is missing in the product of exponentials",
    example=(
        "planar-rpr-poe",
        "pose",
        (
            "[c13, -s13, 0, c1 theta2 + L1 c1 - L1 c13; s13, c13, 0, s1 theta2 + L1 s1 - L1 s13; "
            "0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"2/1": "2*s13"},
)
def missing_home(product: Exponentials) -> Hypotheses:
    """The home pose M was left out."""
    finding = says(
        say("This is the product of the exponentials alone: the home pose M is missing."),
        say("Multiply M behind the space axes' exponentials."),
    )
    for axes in (product.space, product.body):
        yield _pose(product_in_space(axes, product.amounts, np.eye(4)), finding)


@misconception(
    of=Exponentials,
    rank=30,
    code="reversed_product",
    rule="exponentials",
    means="the link transforms, exponentials, turns or motions are multiplied in the wrong order",
    example=(
        "planar-rpr-poe",
        "pose",
        (
            "[c13, -s13, 0, -L1 c3 + L1 c13 + L1 + L2 c13 + theta2 c3; s13, c13, 0, -L1 s3 + "
            "L1 s13 "
            " + L2 s13 + theta2 s3; 0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"4/2": "1"},
)
def reversed_product(product: Exponentials) -> Hypotheses:
    """The exponentials were multiplied from the last joint to the first."""
    finding = says(
        say("The exponentials are multiplied in reverse order: check which joint comes first."),
        say("Begin with that of joint 1, nearest to the base."),
    )
    amounts = product.amounts[::-1]
    yield _pose(product_in_space(product.space[::-1], amounts, product.home), finding)
    yield _pose(product_in_body(product.body[::-1], amounts, product.home), finding)


@misconception(
    of=Exponentials,
    rank=40,
    code="moment_sign",
    rule="exponentials",
    means="v is ω × q instead of −ω × q in the exponentials",
    example=(
        "planar-rpr-poe",
        "pose",
        (
            "[c13, -s13, 0, -L1 c1 + 2 L1 c13 + L2 c13 + theta2 c1; s13, c13, 0, -L1 s1 + 2 L1 s13 "
            "+ L2 s13 + theta2 s1; 0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"4/2": "1"},
)
def moment_sign(product: Exponentials) -> Hypotheses:
    """The student wrote v = ω × q instead of −ω × q for every turning joint."""
    finding = says(
        say(
            "v has the wrong sign in the screw axes behind this: check the order of ω and q in the "
            "cross product."
        ),
    )
    for axes, multiply in ((product.space, product_in_space), (product.body, product_in_body)):
        turns = np.abs(axes[..., :3]).max(axis=-1, keepdims=True) > 0.5
        signs = np.where(turns, [1, 1, 1, -1, -1, -1], 1)
        yield _pose(multiply(axes * signs, product.amounts, product.home), finding)
