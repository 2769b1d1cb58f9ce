"""Slips in a composite rotation: which of its turns was made about another axis, or not at all.

Each function is one misconception. It returns the rotations that the misconception leads to, with
what to say; where one is the student's matrix, and not the right one, the misconception explains
it.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from service.grading.diagnosis.matrix_case import Explanation, MatrixCase
from service.grading.feedback import Finding
from service.grading.samples import Samples
from service.kinematics.rotations import composed
from service.kinematics.transforms import Matrices


@dataclass(frozen=True, slots=True)
class Step:
    """One turn: axis "X", "Y" or "Z", rotation ``(SAMPLES, 3, 3)``, whether the axis is fixed."""

    axis: str
    rotation: Matrices
    fixed: bool


Misconception = tuple[Finding, list[Step]]

RULE = (
    "A turn about a fixed axis is multiplied from the left, one about a moving axis from the right."
)


def fixed_for_moving(steps: Sequence[Step]) -> Iterator[Misconception]:
    """A turn about a moving axis was multiplied as if the axis were fixed, or the other way."""
    exchanged = [replace(step, fixed=not step.fixed) for step in steps]
    everywhere = "Every turn was multiplied from the wrong side. "
    yield _finding("fixed_for_moving_axes", everywhere + RULE), exchanged
    for i in range(1, len(steps)):
        look = f"Turn {i + 1} was multiplied from the wrong side. {RULE}"
        yield (
            _finding("fixed_for_moving_axes", look),
            [*steps[:i], exchanged[i], *steps[i + 1 :]],
        )


def turned_back(steps: Sequence[Step]) -> Iterator[Misconception]:
    """One turn was made the wrong way round its axis."""
    for i, step in enumerate(steps):
        back = replace(step, rotation=np.swapaxes(step.rotation, 1, 2))
        look = (
            f"Turn {i + 1} goes the wrong way: check the sign of the sines in the fundamental "
            f"rotation about {step.axis.lower()}."
        )
        yield _finding("turn_sign", look), [*steps[:i], back, *steps[i + 1 :]]


def left_out(steps: Sequence[Step]) -> Iterator[Misconception]:
    """One turn is not in the product."""
    if len(steps) < 2:
        return
    for i in range(len(steps)):
        look = f"Turn {i + 1} is not contained in this rotation."
        yield _finding("missing_turn", look), [*steps[:i], *steps[i + 1 :]]


def about_another_axis(steps: Sequence[Step]) -> Iterator[Misconception]:
    """One turn was made about another coordinate axis."""
    for i, step in enumerate(steps):
        for axis in "XYZ".replace(step.axis, ""):
            shift = (ord(axis) - ord(step.axis)) % 3
            other = replace(step, rotation=np.roll(step.rotation, (shift, shift), axis=(1, 2)))
            look = f"Turn {i + 1} was made about {axis.lower()}: look at the axis it is about."
            correction = f"It is about {step.axis.lower()}."
            yield (
                _finding("turn_axis", look, correction),
                [*steps[:i], other, *steps[i + 1 :]],
            )


MISCONCEPTIONS: tuple[Callable[[Sequence[Step]], Iterator[Misconception]], ...] = (
    fixed_for_moving,
    turned_back,
    about_another_axis,
    left_out,
)


def explain_steps(case: MatrixCase, steps: Sequence[Step]) -> list[Explanation]:
    """What explains the whole of a wrong rotation that is made of ``steps``."""
    if not steps:
        return []
    everything = case.area((slice(None), slice(None)))
    for misconception in MISCONCEPTIONS:
        for finding, believed in misconception(steps):
            rotation = composed([(step.rotation, step.fixed) for step in believed])
            entries = Samples.subset_of(np.moveaxis(rotation, 0, -1), case.actual.shape[-1] // 2)
            if case.explained_by(entries).all():
                return [Explanation(finding, everything)]
    return []


def _finding(code: str, look: str, correction: str = "") -> Finding:
    return Finding(code, look, correction)
