"""Slips in the inverse of a homogeneous transform.

If R and p are the rotation and position of a transform, its inverse has Rᵀ and −Rᵀp.
"""

# The same wrong numbers also occur in transforms that are not inverses. They then mean a vector in
# the wrong frame or in the opposite direction.

import numpy as np

from service.grading.diagnosis.matrices.matrix_case import (
    POSITION_BLOCK,
    ROTATION_BLOCK,
    UPPER_ROWS,
    MatrixCase,
    PositionBlock,
    RotationBlock,
    UpperRows,
)
from service.grading.diagnosis.wrong_value import Hypotheses
from service.grading.feedback import Finding
from service.grading.misconception import Written, misconception, says
from service.kinematics.transforms import Numbers
from service.translations import Sentence, say


def _with_rule(sentence: Sentence) -> Finding:
    return says(say("{sentence} The inverse of (R, p) is (Rᵀ, −Rᵀp).", sentence=sentence))


def _parts(case: MatrixCase) -> tuple[Numbers, Numbers]:
    # The rotation (3, 3, samples) and the position (3, samples) of the inverse.
    rotation = np.swapaxes(case.expected[ROTATION_BLOCK], 0, 1)
    return rotation, -_turned(rotation, case.expected[:3, 3])


def _turned(rotation: Numbers, vector: Numbers) -> Numbers:
    return np.asarray(np.einsum("ijs,js->is", rotation, vector))


@misconception(
    of=MatrixCase,
    rank=20,
    code="transposed_for_inverse",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="the answer is the transpose of the transform instead of its inverse",
    example=(
        "homogeneous-inverse",
        "about-z",
        "[cos(phi), sin(phi), 0, 0; -sin(phi), cos(phi), 0, 0; 0, 0, 1, 0; px, py, pz, 1]",
    ),
    unlike={"1/4": "-px", "2/4": "-py"},
)
def transposed_for_inverse(case: MatrixCase) -> Hypotheses:
    """The student transposed the whole transform to invert it."""
    finding = _with_rule(
        say(
            "This is the transpose of the transform, not its inverse: only a rotation is inverted "
            "so."
        )
    )
    if case.is_transform:
        rotation, position = _parts(case)
        written = np.swapaxes(case.expected, 0, 1).copy()
        written[:3, :3] = np.swapaxes(rotation, 0, 1)
        written[3, :3], written[:3, 3] = position, 0.0
        yield Written(written, finding)


@misconception(
    of=UpperRows,
    rank=80,
    code="negated_for_inverse",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="signs are changed instead of inverting: −R for Rᵀ, or R with −p",
    example=(
        "homogeneous-inverse",
        "about-z",
        "[cos(phi), -sin(phi), 0, -px; sin(phi), cos(phi), 0, -py; 0, 0, 1, -pz; 0, 0, 0, 1]",
    ),
    unlike={"1/4": "-px", "2/4": "-py"},
)
def negated_for_inverse(case: MatrixCase) -> Hypotheses:
    """The student changed signs to invert a transform."""
    if case.is_transform:
        rotation, position = _parts(case)
        for sign in (1, -1):
            written = np.concatenate([sign * rotation, -position[:, None]], axis=1)
            yield Written(written, NEGATED, UPPER_ROWS)


@misconception(
    of=RotationBlock,
    rank=80,
    code="negated_for_inverse",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="signs are changed instead of inverting: −R for Rᵀ, or R with −p",
    example=("rigid-motion-chain", "parallel-axes", {"1/1": "-1"}),
    unlike={"1/1": "0", "1/3": "1"},
)
def negated_rotation(case: MatrixCase) -> Hypotheses:
    """The student changed signs to invert a rotation."""
    rotation = case.expected[ROTATION_BLOCK]
    for written in (-np.swapaxes(rotation, 0, 1), -rotation):
        yield Written(written, NEGATED, ROTATION_BLOCK)


NEGATED = _with_rule(say("The signs were changed, but that does not invert a rotation."))


@misconception(
    of=PositionBlock,
    rank=80,
    code="position_not_turned",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="the position is described in the other frame: in an inverse, −p for −Rᵀp",
    example=("homogeneous-inverse", "about-z", {"1/4": "-px", "2/4": "-py"}),
    unlike={"1/1": "0", "1/4": "0", "3/4": "0", "4/4": "0"},
)
def position_not_turned(case: MatrixCase) -> Hypotheses:
    """The student wrote −p instead of −Rᵀp for the position of the inverse."""
    finding = _with_rule(
        say(
            "The position is the right vector, but seen in the axes of the other frame: it must "
            "be turned, too."
        )
    )
    if case.is_transform:
        _, position = _parts(case)
        yield _position(-position, finding)


@misconception(
    of=PositionBlock,
    rank=82,
    code="position_not_inverted",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="the position is not inverted: in an inverse, p for −Rᵀp",
    example=("simple-twist", "exponential", {"2/4": "2*sin(theta)"}),
    unlike={"3/3": "0", "3/4": "1"},
)
def position_not_inverted(case: MatrixCase) -> Hypotheses:
    """The student wrote p instead of −Rᵀp for the position of the inverse."""
    finding = _with_rule(
        say("The position is still that of the transform that was to be inverted.")
    )
    if case.is_transform:
        _, position = _parts(case)
        yield _position(position, finding)


@misconception(
    of=PositionBlock,
    rank=84,
    code="reversed_position",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="the whole position has the wrong sign: in an inverse, Rᵀp for −Rᵀp",
    example=(
        "homogeneous-inverse",
        "about-z",
        "[cφ, sφ, 0, px cφ + py sφ; -sφ, cφ, 0, py cφ - px sφ; 0, 0, 1, pz; 0, 0, 0, 1]",
    ),
    unlike={"3/4": "2*pz"},
)
def position_reversed(case: MatrixCase) -> Hypotheses:
    """The student wrote Rᵀp instead of −Rᵀp for the position of the inverse."""
    finding = _with_rule(say("Every coordinate of the position has the wrong sign."))
    if case.is_transform:
        yield _position(-case.expected[:3, 3], finding)


@misconception(
    of=PositionBlock,
    rank=86,
    code="position_turned_back",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="the position is turned by R instead of Rᵀ: in an inverse, −R p for −Rᵀp",
    example=("homogeneous-inverse", "numbers", {"1/4": "1"}),
    unlike={"2/4": "3"},
)
def position_turned_back(case: MatrixCase) -> Hypotheses:
    """The student wrote −R p instead of −Rᵀp for the position of the inverse."""
    finding = _with_rule(say("The position was turned by R, not by its transpose."))
    if case.is_transform:
        rotation, position = _parts(case)
        for sign in (-1, 1):
            yield _position(sign * _turned(rotation, position), finding)


def _position(position: Numbers, finding: Finding) -> Written[Numbers]:
    return Written(position[:, None], finding, POSITION_BLOCK)
