"""Slips in the DH row of a transform, or in the answer that a transform has no DH row."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from service.grading.diagnosis.wrong_value import Hypotheses, WrongNumbers
from service.grading.feedback import Finding
from service.grading.misconception import Written, misconception, register, says
from service.grading.numerics.tolerances import EXACT_VALUE
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import A
from service.kinematics.dh import Convention
from service.kinematics.dh_row import dh1_residual, dh2_residual, row
from service.kinematics.transforms import Matrices, Numbers, inverse
from service.translations import say


@dataclass(frozen=True)
class WrongRow(WrongNumbers):
    """A wrong DH row ``(4, SAMPLES)`` of a transform ``(SAMPLES, 4, 4)``."""

    transform: Matrices
    convention: Convention
    angle: ClassVar[ArrayLike] = IS_ANGLE[:, None]

    def row_of(self, transform: Matrices, convention: Convention) -> Numbers | None:
        """Return the DH row ``(4, SAMPLES)`` of a transform, or None if it has no DH row."""
        length_scale = float(np.asarray(self.scale)[A])
        if violated(transform, convention, length_scale):
            return None
        return row(transform, convention)


@misconception(
    of=WrongRow,
    rank=10,
    code="exchanged_parameters",
    rule="convention",
    means="a and d, or α and θ, are exchanged",
    example=("dh-conditions", "fourth", {"a": "2", "alpha": "0", "d": "3", "theta": "pi/2"}),
    unlike={"a": "pi/2", "alpha": "0", "d": "2", "theta": "3"},
)
def exchanged_parameters(case: WrongRow) -> Hypotheses:
    """The student exchanged a and d, or α and θ."""
    for first, last, order in (("a", "d", [2, 1, 0, 3]), ("α", "θ", [0, 3, 2, 1])):
        hint = say(
            "{first} and {last} are exchanged: a and α are measured along and about x, d and θ "
            "along and about z.",
            first=first,
            last=last,
        )
        yield Written(case.expected[order], says(hint))
    both = say(
        "a and d, and α and θ are exchanged: a and α are measured along and about x, d and θ along "
        "and about z."
    )
    yield Written(case.expected[[2, 3, 0, 1]], says(both))


@misconception(
    of=WrongRow,
    rank=20,
    code="other_convention",
    rule="convention",
    means="the row follows the other convention",
    example=("several-kinds", "turned-row", "l, 0, a, pi"),
    unlike="l, 0, 2*a, pi",
)
def other_convention(case: WrongRow) -> Hypotheses:
    """The row describes the transform in the other DH convention."""
    other = case.convention.other
    hint = say("This is the row of the modified convention; the standard one is asked for.")
    if other is Convention.STANDARD:
        hint = say("This is the row of the standard convention; the modified one is asked for.")
    found = case.row_of(case.transform, other)
    if found is not None:
        yield Written(found, says(hint))


@misconception(
    of=WrongRow,
    rank=30,
    code="inverse_transform",
    rule="rows",
    means="the row describes the inverse transform",
    example=("several-kinds", "turn-row", "0, 0, -a, -phi"),
    unlike="0, 0, -a, phi",
)
def inverse_row(case: WrongRow) -> Hypotheses:
    """The row describes the inverse transform."""
    finding = says(
        say(
            "This is the row of the inverse: the transform describes the second frame in the first."
        ),
    )
    found = case.row_of(inverse(case.transform), case.convention)
    if found is not None:
        yield Written(found, finding)


# --- the conditions for a transform to have a row
_NOT_PERPENDICULAR = register(
    of=WrongRow,
    code="dh_not_perpendicular",
    rule="convention",
    means="a row is given, but the transform has none: x is not perpendicular to z",
    example=("dh-conditions", "second", {"a": "l", "alpha": "0", "d": "h", "theta": "phi"}),
    unlike="l, 0, h",
)
_NOT_INTERSECTING = register(
    of=WrongRow,
    code="dh_not_intersecting",
    rule="convention",
    means="a row is given, but the transform has none: the lines of x and z do not meet",
    example=("dh-conditions", "third", {"a": "l", "alpha": "phi", "d": "h", "theta": "0"}),
    unlike="l, 0, h",
)
_ROW_EXISTS = register(
    of=WrongRow,
    code="dh_row_exists",
    rule="convention",
    means='the answer is "none", but the transform has a row',
    example=("dh-conditions", "fourth", {"none": True}),
    unlike={"a": "3", "alpha": "0", "d": "2", "theta": "0"},
)


def axes_named(convention: Convention) -> tuple[str, str]:
    """Return the names of the x axis and the z axis in the two DH conditions."""
    return ("x1", "z0") if convention is Convention.STANDARD else ("x0", "z1")


def violated(transform: Matrices, convention: Convention, length_scale: float) -> list[Finding]:
    """Return findings on the DH conditions that the transform violates."""
    x, z = axes_named(convention)
    row_of_entry, column = (3, 1) if convention is Convention.STANDARD else (1, 3)
    perpendicular = _NOT_PERPENDICULAR.finding(
        say(
            "Check the first DH condition: is {x} perpendicular to {z}? Check the entry in row "
            "{row}, column {column}.",
            x=x,
            z=z,
            row=row_of_entry,
            column=column,
        ),
        say("It is not 0, so that {x} is not perpendicular to {z} and there is no row.", x=x, z=z),
    )
    intersecting = _NOT_INTERSECTING.finding(
        say("Check the second DH condition: does the line of {x} meet the line of {z}?", x=x, z=z),
        say("It passes {z} at a distance, so that there is no row.", z=z),
    )
    conditions = (
        (perpendicular, dh1_residual, EXACT_VALUE),
        (intersecting, dh2_residual, EXACT_VALUE * length_scale),
    )
    return [
        finding
        for finding, residual, tolerance in conditions
        if np.abs(residual(transform, convention)).max() >= tolerance
    ]


def has_a_row(convention: Convention) -> Finding:
    """Return the finding on the wrong answer that a transform has no DH row."""
    x, z = axes_named(convention)
    return _ROW_EXISTS.finding(
        say(
            "Check both DH conditions: is {x} perpendicular to {z}, and does the line of {x} meet "
            "the line of {z}?",
            x=x,
            z=z,
        ),
        say("Both hold, so that there is a row."),
    )
