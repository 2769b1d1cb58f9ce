"""Slips in a composite rotation: a turn about another axis, from the wrong side, or left out."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from service.grading.diagnosis.matrix_case import Explanation, MatrixCase, as_explanations
from service.grading.diagnosis.wrong_value import Hypotheses
from service.grading.feedback import Finding
from service.grading.judging.expected import as_entries
from service.grading.misconception import Written, explanation
from service.grading.samples import Samples
from service.kinematics.rotations import composed
from service.kinematics.transforms import Matrices, Numbers


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
    """One turn was made the wrong way round its axis."""
    for i, step in enumerate(steps):
        back = replace(step, rotation=np.swapaxes(step.rotation, 1, 2))
        finding = Finding(
            "turn_sign",
            f"Turn {i + 1} goes the wrong way: check the sign of the sines in the fundamental "
            f"rotation about {step.axis.lower()}.",
        )
        yield _made_of([*steps[:i], back, *steps[i + 1 :]], finding)


def about_another_axis(steps: Sequence[Step]) -> Hypotheses:
    """One turn was made about another coordinate axis."""
    for i, step in enumerate(steps):
        for axis in "XYZ".replace(step.axis, ""):
            shift = (ord(axis) - ord(step.axis)) % 3
            other = replace(step, rotation=np.roll(step.rotation, (shift, shift), axis=(1, 2)))
            finding = Finding(
                "turn_axis",
                f"Turn {i + 1} was made about {axis.lower()}: look at the axis it is about.",
                f"It is about {step.axis.lower()}.",
            )
            yield _made_of([*steps[:i], other, *steps[i + 1 :]], finding)


def left_out(steps: Sequence[Step]) -> Hypotheses:
    """One turn is not in the product."""
    for i in range(len(steps)) if len(steps) > 1 else ():
        finding = Finding("missing_turn", f"Turn {i + 1} is not contained in this rotation.")
        yield _made_of([*steps[:i], *steps[i + 1 :]], finding)


MISCONCEPTIONS = (fixed_for_moving, turned_back, about_another_axis, left_out)


def explain_steps(case: MatrixCase, steps: Sequence[Step]) -> list[Explanation]:
    """What explains the whole of a wrong rotation that is made of ``steps``."""
    count = case.actual.shape[-1] // 2
    subset = [replace(step, rotation=Samples.subset_of(step.rotation.T, count).T) for step in steps]
    return as_explanations(case, explanation(case, MISCONCEPTIONS, subset)) if steps else []
