"""Slips in a composite rotation: a turn about another axis, from the wrong side, or left out."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, combinations, permutations

import numpy as np

from service.grading.diagnosis.matrices.matrix_case import Explanation, MatrixCase, as_explanations
from service.grading.diagnosis.wording import listed
from service.grading.diagnosis.wrong_value import Hypotheses
from service.grading.feedback import Finding
from service.grading.judging.expected import as_entries
from service.grading.misconception import Written, explanation
from service.grading.numerics.samples import Samples
from service.kinematics.rotations import composed
from service.kinematics.transforms import Matrices, Numbers

# Of more steps one alone is taken to have a slip.
MAX_STEPS = 4


@dataclass(frozen=True, slots=True)
class Step:
    """One turn: axis "X", "Y" or "Z", rotation ``(SAMPLES, 3, 3)``, whether the axis is fixed."""

    axis: str
    rotation: Matrices
    fixed: bool


RULE = (
    "A turn about a fixed axis is multiplied from the left, one about a moving axis from the right."
)


def _made_of(steps: Sequence[Step], finding: Finding) -> Written[Numbers]:
    rotation = composed([(step.rotation, step.fixed) for step in steps])
    return Written(as_entries(rotation), finding)


def fixed_for_moving(steps: Sequence[Step]) -> Hypotheses:
    """A turn about a moving axis was multiplied as if the axis were fixed, or the other way."""
    exchanged = [replace(step, fixed=not step.fixed) for step in steps]
    hint = f"Every turn was multiplied from the wrong side. {RULE}"
    yield _made_of(exchanged, Finding("fixed_for_moving_axes", hint))
    for i in range(1, len(steps)):
        hint = f"Turn {i + 1} was multiplied from the wrong side. {RULE}"
        turns = [*steps[:i], exchanged[i], *steps[i + 1 :]]
        yield _made_of(turns, Finding("fixed_for_moving_axes", hint))


def turned_back(steps: Sequence[Step]) -> Hypotheses:
    """Some turns, or all of them, were made the wrong way round their axes."""
    back = [replace(step, rotation=np.swapaxes(step.rotation, 1, 2)) for step in steps]
    for some in _subsets(steps):
        axes = listed(sorted({steps[i].axis.lower() for i in some}))
        finding = Finding(
            "turn_sign",
            f"{_turns(some)} {'go' if len(some) > 1 else 'goes'} the wrong way: check the signs of "
            f"the sines in the rotation about {axes}.",
        )
        yield _made_of([(back if i in some else steps)[i] for i in range(len(steps))], finding)


def about_another_axis(steps: Sequence[Step]) -> Hypotheses:
    """One turn was made about another coordinate axis."""
    for i, step in enumerate(steps):
        for axis in "XYZ".replace(step.axis, ""):
            finding = Finding(
                "turn_axis",
                f"Turn {i + 1} was made about {axis.lower()}: check which axis it is about.",
                f"It is about {step.axis.lower()}.",
            )
            turned = replace(step, rotation=_about(axis, step))
            yield _made_of([*steps[:i], turned, *steps[i + 1 :]], finding)


def by_another_angle(steps: Sequence[Step]) -> Hypotheses:
    """A turn was made by the angle of another, or two by each other's."""
    for i, j in permutations(range(len(steps)), 2):
        finding = Finding(
            "turn_angle",
            f"Turn {i + 1} was made by the angle of turn {j + 1}: check which angle belongs to "
            "which axis.",
        )
        turned = list(steps)
        turned[i] = replace(steps[i], rotation=_about(steps[i].axis, steps[j]))
        yield _made_of(turned, finding)
    for i, j in combinations(range(len(steps)), 2):
        finding = Finding(
            "turn_angle",
            f"The angles of turns {i + 1} and {j + 1} are exchanged: check which angle belongs to "
            "which axis.",
        )
        turned = list(steps)
        for one, other in ((i, j), (j, i)):
            turned[one] = replace(steps[one], rotation=_about(steps[one].axis, steps[other]))
        yield _made_of(turned, finding)


def left_out(steps: Sequence[Step]) -> Hypotheses:
    """Some turns are not in the product."""
    for some in _subsets(steps):
        if len(some) < len(steps):
            verb = "are" if len(some) > 1 else "is"
            finding = Finding("missing_turn", f"{_turns(some)} {verb} missing from this rotation.")
            yield _made_of([step for i, step in enumerate(steps) if i not in some], finding)


def another_order(steps: Sequence[Step]) -> Hypotheses:
    """The turns were multiplied in another order."""
    moving = [replace(step, fixed=False) for step in steps if not step.fixed]
    factors = [*(replace(step, fixed=False) for step in steps[::-1] if step.fixed), *moving]
    finding = Finding("reversed_product", f"The turns were multiplied in the wrong order. {RULE}")
    for order in list(permutations(factors))[1:] if len(steps) <= MAX_STEPS else ():
        yield _made_of(order, finding)


def _about(axis: str, step: Step) -> Matrices:
    """The turn of a step about another axis."""
    shift = (ord(axis) - ord(step.axis)) % 3
    return np.roll(step.rotation, (shift, shift), axis=(1, 2))


def _subsets(steps: Sequence[Step]) -> Iterator[tuple[int, ...]]:
    """The places of some steps, the fewest first; of many steps one alone."""
    most = len(steps) if len(steps) <= MAX_STEPS else 1
    return chain.from_iterable(combinations(range(len(steps)), k) for k in range(1, most + 1))


def _turns(places: Sequence[int]) -> str:
    numbers = listed([str(i + 1) for i in places])
    return f"Turns {numbers}" if len(places) > 1 else f"Turn {numbers}"


OF_TURNS = (turned_back, about_another_axis, by_another_angle, left_out)
MISCONCEPTIONS = (fixed_for_moving, *OF_TURNS, another_order)


def explain_steps(case: MatrixCase, steps: Sequence[Step]) -> list[Explanation]:
    """What explains the whole of a wrong rotation that is made of ``steps``."""
    count = case.actual.shape[-1] // 2
    subset = [replace(step, rotation=Samples.subset_of(step.rotation.T, count).T) for step in steps]
    return as_explanations(case, explanation(case, MISCONCEPTIONS, subset)) if steps else []
