"""Slips in the inverse of a homogeneous transform.

With R and p for the rotation and the position of the transform that is inverted, the inverse has Rᵀ
and −Rᵀp. Where no inverse is asked for, the same numbers tell that a vector is described in the
wrong frame, or points the opposite way.
"""

import numpy as np

from service.grading.diagnosis.matrices.matrix_case import (
    POSITION_BLOCK,
    ROTATION_BLOCK,
    UPPER_ROWS,
    MatrixCase,
)
from service.grading.diagnosis.wrong_value import Hypotheses
from service.grading.feedback import Finding
from service.grading.misconception import Written
from service.kinematics.transforms import Numbers

RULE = "The inverse of (R, p) is (Rᵀ, −Rᵀp)."


def _parts(case: MatrixCase) -> tuple[Numbers, Numbers]:
    """R ``(3, 3, samples)`` and p ``(3, samples)`` of the inverse of the right transform."""
    rotation = np.swapaxes(case.expected[ROTATION_BLOCK], 0, 1)
    return rotation, -_turned(rotation, case.expected[:3, 3])


def _turned(rotation: Numbers, vector: Numbers) -> Numbers:
    return np.asarray(np.einsum("ijs,js->is", rotation, vector))


def transposed_for_inverse(case: MatrixCase) -> Hypotheses:
    """The whole transform was transposed, as only a rotation may be."""
    finding = Finding(
        "transposed_for_inverse",
        "This is the transpose of the transform, not its inverse: only a rotation is inverted so. "
        f"{RULE}",
    )
    if case.is_transform:
        rotation, position = _parts(case)
        written = np.swapaxes(case.expected, 0, 1).copy()
        written[:3, :3] = np.swapaxes(rotation, 0, 1)
        written[3, :3], written[:3, 3] = position, 0.0
        yield Written(written, finding)


def negated_for_inverse(case: MatrixCase) -> Hypotheses:
    """Signs were changed, of all entries or of the position, and nothing was transposed."""
    if case.is_transform:
        rotation, position = _parts(case)
        for sign in (1, -1):
            written = np.concatenate([sign * rotation, -position[:, None]], axis=1)
            yield Written(written, NEGATED, UPPER_ROWS)


def negated_rotation(case: MatrixCase) -> Hypotheses:
    """The signs of the rotation were changed, as if that were its inverse."""
    rotation = case.expected[ROTATION_BLOCK]
    for written in (-np.swapaxes(rotation, 0, 1), -rotation):
        yield Written(written, NEGATED, ROTATION_BLOCK)


NEGATED = Finding(
    "negated_for_inverse",
    f"The signs were changed, but that does not invert a rotation. {RULE}",
)


def position_not_turned(case: MatrixCase) -> Hypotheses:
    """The position of the inverse was taken to be −p."""
    finding = Finding(
        "position_not_turned",
        "The position is the right vector, but seen in the axes of the other frame: it must be "
        f"turned, too. {RULE}",
    )
    if case.is_transform:
        _, position = _parts(case)
        yield _position(-position, finding)


def position_not_inverted(case: MatrixCase) -> Hypotheses:
    """The position was left as it was before the transform was inverted."""
    finding = Finding(
        "position_not_inverted",
        f"The position is still that of the transform that was to be inverted. {RULE}",
    )
    if case.is_transform:
        _, position = _parts(case)
        yield _position(position, finding)


def position_reversed(case: MatrixCase) -> Hypotheses:
    """The position was turned into the other frame, but not reversed."""
    finding = Finding(
        "reversed_position",
        f"Every coordinate of the position has the wrong sign. {RULE}",
    )
    if case.is_transform:
        yield _position(-case.expected[:3, 3], finding)


def position_turned_back(case: MatrixCase) -> Hypotheses:
    """The position of the inverse was taken to be −R p."""
    finding = Finding(
        "position_turned_back",
        f"The position was turned by R, not by its transpose. {RULE}",
    )
    if case.is_transform:
        rotation, position = _parts(case)
        for sign in (-1, 1):
            yield _position(sign * _turned(rotation, position), finding)


def _position(position: Numbers, finding: Finding) -> Written[Numbers]:
    return Written(position[:, None], finding, POSITION_BLOCK)


OF_MATRIX = (transposed_for_inverse,)
OF_UPPER_ROWS = (negated_for_inverse,)
OF_ROTATION = (negated_rotation,)
OF_POSITION = (
    position_not_turned,
    position_not_inverted,
    position_reversed,
    position_turned_back,
)
MISCONCEPTIONS = (*OF_MATRIX, *OF_UPPER_ROWS, *OF_ROTATION, *OF_POSITION)
