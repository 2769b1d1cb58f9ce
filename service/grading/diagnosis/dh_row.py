"""Slips in the DH row of a transform: a condition overlooked, or the numbers of something else.

Each function is one misconception that the student may have held. It returns what to say where that
misconception explains the answer, else None.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from service.grading.comparison import Match, matches
from service.grading.feedback import Finding
from service.grading.reading.table import IS_ANGLE
from service.grading.tolerances import EXACT_VALUE
from service.kinematics.dh import Convention
from service.kinematics.dh_row import dh1_residual, dh2_residual, row
from service.kinematics.transforms import Matrices, Numbers, inverse


@dataclass(frozen=True, slots=True)
class RowCase:
    """A row ``(4, SAMPLES)`` that was given for a transform ``(SAMPLES, 4, 4)``."""

    actual: Numbers
    transform: Matrices
    convention: Convention
    length_scale: float

    def is_what_was_written(self, other: Numbers) -> bool:
        """Whether the row that was handed in is ``other``."""
        scale = np.where(IS_ANGLE, 1.0, self.length_scale)
        found = matches(self.actual, other, scale, IS_ANGLE[:, None])
        return bool((found >= Match.ROUNDED).all())

    @property
    def expected(self) -> Numbers:
        """The row that the transform has, ``(4, SAMPLES)``."""
        return row(self.transform, self.convention)


def axes_named(convention: Convention) -> tuple[str, str]:
    """The two axes that the conditions are about: x and z."""
    return ("x1", "z0") if convention is Convention.STANDARD else ("x0", "z1")


def not_perpendicular(transform: Matrices, convention: Convention) -> Finding | None:
    """The first condition was overlooked."""
    if np.abs(dh1_residual(transform, convention)).max() < EXACT_VALUE:
        return None
    x, z = axes_named(convention)
    entry = "third row, first column" if convention is Convention.STANDARD else "first row, third"
    return Finding(
        "dh_not_perpendicular",
        f"Check the first DH condition: is {x} perpendicular to {z}? The entry in the {entry} "
        f"tells.",
        f"It is not 0, so that {x} is not perpendicular to {z} and there is no row.",
    )


def not_intersecting(
    transform: Matrices, convention: Convention, length_scale: float
) -> Finding | None:
    """The second condition was overlooked."""
    if np.abs(dh2_residual(transform, convention)).max() < EXACT_VALUE * length_scale:
        return None
    x, z = axes_named(convention)
    return Finding(
        "dh_not_intersecting",
        f"Check the second DH condition: does the line of {x} meet the line of {z}?",
        f"It passes {z} at a distance, so that there is no row.",
    )


def violated(transform: Matrices, convention: Convention, length_scale: float) -> list[Finding]:
    """The conditions that a transform breaks; none where it has a row."""
    found = (
        not_perpendicular(transform, convention),
        not_intersecting(transform, convention, length_scale),
    )
    return [finding for finding in found if finding is not None]


def has_a_row(convention: Convention) -> Finding:
    """What to say to who found no row where there is one."""
    x, z = axes_named(convention)
    return Finding(
        "dh_row_exists",
        f"This transform has a row: {x} is perpendicular to {z} and meets it.",
    )


def exchanged_parameters(case: RowCase) -> Finding | None:
    """A and d, or α and θ, stand in each other's places."""
    a, alpha, d, theta = case.expected
    for names, other in (
        ("a and d", [d, alpha, a, theta]),
        ("α and θ", [a, theta, d, alpha]),
        ("a and d, and α and θ,", [d, theta, a, alpha]),
    ):
        if case.is_what_was_written(np.array(other)):
            return Finding(
                "exchanged_parameters",
                f"{names} stand in each other's places: a and α belong to the x axis, d and θ to "
                f"the z axis.",
            )
    return None


def inverse_row(case: RowCase) -> Finding | None:
    """The row is that of the inverse transform."""
    turned = inverse(case.transform)
    if violated(turned, case.convention, case.length_scale):
        return None
    if not case.is_what_was_written(row(turned, case.convention)):
        return None
    return Finding(
        "inverse_transform",
        "This is the row of the inverse: the transform describes the second frame in the first.",
    )


def other_convention(case: RowCase) -> Finding | None:
    """The row is that of the other convention."""
    other = next(each for each in Convention if each is not case.convention)
    if violated(case.transform, other, case.length_scale):
        return None
    if not case.is_what_was_written(row(case.transform, other)):
        return None
    return Finding(
        "other_convention",
        f"This is the row of the {other.value} convention; the {case.convention.value} one is "
        f"asked for.",
    )


MISCONCEPTIONS: tuple[Callable[[RowCase], Finding | None], ...] = (
    exchanged_parameters,
    other_convention,
    inverse_row,
)


def explain_row(case: RowCase) -> Finding | None:
    """The first misconception that explains the whole of a wrong row."""
    if case.is_what_was_written(case.expected):
        return None
    for misconception in MISCONCEPTIONS:
        finding = misconception(case)
        if finding is not None:
            return finding
    return None
