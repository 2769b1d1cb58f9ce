"""Slips in a composite rotation, such as a wrong axis or a missing turn."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, combinations, permutations

import numpy as np

from service.grading.diagnosis.matrices.matrix_case import Explanation, MatrixCase, as_explanations
from service.grading.diagnosis.wrong_value import Hypotheses
from service.grading.feedback import Finding
from service.grading.judging.expected import as_entries
from service.grading.misconception import Written, explanation, misconception, says
from service.grading.numerics.samples import Samples
from service.kinematics.rotations import composed
from service.kinematics.transforms import Matrices, Numbers
from service.translations import Sentence, listed, say, say_count

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
    for some in _subsets(steps):
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
    for some in _subsets(steps):
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


def _subsets(steps: Sequence[Step]) -> Iterator[tuple[int, ...]]:
    # If there are many turns, only sets of one turn are tried.
    most = len(steps) if len(steps) <= MAX_STEPS else 1
    return chain.from_iterable(combinations(range(len(steps)), k) for k in range(1, most + 1))


def _numbers(places: Sequence[int]) -> str:
    return listed([str(i + 1) for i in places])


def explain_steps(case: MatrixCase, steps: Sequence[Step]) -> list[Explanation]:
    """Return explanations of a wrong rotation that should be the product of these turns."""
    count = case.actual.shape[-1] // 2
    subset = [replace(step, rotation=Samples.subset_of(step.rotation.T, count).T) for step in steps]
    return as_explanations(case, explanation(case, subset, Step)) if steps else []
