"""Slips in a whole matrix, or in its whole rotation or position."""

# If such a slip explains an entry, the entry gets no finding of its own.

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import permutations

import numpy as np

from service.grading.diagnosis.matrices.line_signs import Lines
from service.grading.diagnosis.matrices.matrix_case import (
    BOTTOM_ROW,
    POSITION_BLOCK,
    ROTATION_BLOCK,
    UPPER_ROWS,
    Block,
    Explanation,
    MatrixCase,
    PositionBlock,
    RotationBlock,
    UpperRows,
    as_explanations,
)
from service.grading.diagnosis.motions.link_products import named
from service.grading.diagnosis.upstream.slip_search import AFTER_SIGNS
from service.grading.diagnosis.wording import UNIT_FACTORS, other_length_unit
from service.grading.diagnosis.wrong_value import UNEXPLAINED, Hypotheses, Mask
from service.grading.feedback import Finding
from service.grading.judging.expected import as_entries
from service.grading.misconception import (
    Explained,
    Hypothesis,
    Written,
    check,
    diagnosed,
    explanation,
    misconception,
    says,
)
from service.grading.numerics.tolerances import EXACT_VALUE, ROUNDED_VALUE
from service.grading.report import Severity
from service.kinematics.transforms import Numbers, inverse
from service.translations import Sentence, say, template


class BottomRow:
    """The bottom row of a wrong matrix."""


@misconception(
    of=MatrixCase,
    rank=10,
    code=("transposed_matrix", "transposed_rotation"),
    rule="rotation_columns",
    means=(
        "the whole matrix is transposed",
        "the rotation is transposed: its columns are the axes of the first frame in the last",
    ),
    example=("planar-rpr-poe", "home", {"1/4": "0", "4/1": "L1 + L2"}),
    unlike={"3/3": "0", "3/4": "1"},
)
def transposed_matrix(case: MatrixCase) -> Hypotheses:
    """The student exchanged the rows and the columns of the whole matrix."""
    code = "transposed_rotation" if case.rigid and not case.is_transform else "transposed_matrix"
    finding = Finding(code, say("This matrix is transposed."), say("Write its rows as columns."))
    if case.expected.shape[0] == case.expected.shape[1]:
        yield Written(np.swapaxes(case.expected, 0, 1), finding)


@misconception(
    of=UpperRows,
    rank=50,
    code="inverse_transform",
    rule="inverse",
    means="the answer is the inverse: the first frame in the last",
    example=(
        "homogeneous-inverse",
        "about-z",
        "[cos(phi), -sin(phi), 0, px; sin(phi), cos(phi), 0, py; 0, 0, 1, pz; 0, 0, 0, 1]",
    ),
    unlike={"1/4": "-px", "2/4": "-py"},
)
def inverse_transform(case: MatrixCase) -> Hypotheses:
    """The student submitted the inverse of the correct transform."""
    if case.is_transform:
        yield Written(_inverted(case.expected)[UPPER_ROWS], INVERTED, UPPER_ROWS)


INVERTED = says(
    say("This matrix leads the other way: it is the inverse of the transform that is asked for."),
    say("Its columns are the axes and the origin of the last frame, seen from the first."),
)

# The message for the inverse of another pose than the one asked for.
OTHER_WAY = replace(
    INVERTED,
    hint=say(
        "This matrix leads the other way: check which frame it describes, and from which frame."
    ),
    correction="",
)


def _inverted(matrix: Numbers) -> Numbers:
    return as_entries(inverse(np.moveaxis(matrix, -1, -3)))


@misconception(of=UpperRows, rank=60)
def other_pose(case: MatrixCase) -> Hypotheses:
    """The student submitted a wrong pose, such as the pose of a wrong frame."""
    for pose, entries in zip(*case.other_poses, strict=True):
        # Translators: {pose} is a name such as "the pose of frame {2}".
        found = named(pose, template("This matrix is {pose}. {advice}"))
        yield Written(entries[UPPER_ROWS], found, UPPER_ROWS, record=pose.record)


@misconception(
    of=UpperRows,
    rank=70,
    code=("inverse_transform",),
    rule="inverse",
    means="the answer is the inverse: the first frame in the last",
    example=(
        "scara",
        "pose",
        "[c12, s12, 0, -a2 - a1 c2; s12, -c12, 0, -a1 s2; 0, 0, -1, -d3; 0, 0, 0, 1]",
    ),
    unlike={"2/2": "90"},
)
def inverse_of_other_pose(case: MatrixCase) -> Hypotheses:
    """The student submitted the inverse of a wrong pose."""
    if case.is_transform:
        poses, entries = case.other_poses
        for pose, inverted in zip(poses, _inverted(entries), strict=True):
            # Translators: {pose} is a name such as "the pose of frame {2}".
            finding = named(pose, template("This is the inverse of {pose}. {advice}"), OTHER_WAY)
            yield Written(inverted[UPPER_ROWS], finding, UPPER_ROWS)


@misconception(
    of=RotationBlock,
    rank=10,
    code="transposed_rotation",
    rule="rotation_columns",
    means="the rotation is transposed: its columns are the axes of the first frame in the last",
    example=("planar-rrr", "pose", {"1/2": "s123", "2/1": "-s123"}),
    unlike={"1/3": "1", "4/4": "0"},
)
def transposed_rotation(case: MatrixCase) -> Hypotheses:
    """The rotation is transposed."""
    finding = says(
        say(
            "The rotation is transposed: its columns, not its rows, must be the axes of the frame "
            "that is described."
        ),
        say("Write its rows as columns."),
    )
    yield Written(np.swapaxes(case.expected[ROTATION_BLOCK], 0, 1), finding, ROTATION_BLOCK)


@misconception(
    of=RotationBlock,
    rank=50,
    code="columns_exchanged",
    rule="rotation_columns",
    means="the columns of the rotation are in the wrong order",
    example=("rigid-motion-chain", "parallel-axes", "[0, 1, 0; 0, 0, -1; 1, 0, 0]"),
    unlike={"1/1": "0", "1/3": "1"},
)
def columns_exchanged(case: MatrixCase) -> Hypotheses:
    """The columns of the rotation are in the wrong order."""
    for order in list(permutations(range(3)))[1:]:
        finding = says(
            say(
                "The columns of the rotation are in the wrong order: check which axis belongs in "
                "which column."
            ),
            say("Your columns are its {axes} axes.", axes=", ".join("xyz"[j] for j in order)),
        )
        yield Written(case.expected[:3, order], finding, ROTATION_BLOCK)


@misconception(of=RotationBlock, rank=60)
def other_rotation(case: MatrixCase) -> Hypotheses:
    """The rotation is that of a wrong pose, such as the pose of a wrong frame."""
    # Translators: {pose} is a name such as "the pose of frame {2}".
    told = template("The rotation comes from {pose}. {advice}")
    return _from_other_poses(case, ROTATION_BLOCK, told)


@misconception(
    of=PositionBlock,
    rank=50,
    code="other_length_unit",
    rule="position_vector",
    means=template("all lengths are in another unit, such as millimetres instead of metres"),
    example=("ur5e", "home", {"1/4": "-817.2", "2/4": "-232.9", "3/4": "62.8"}),
    unlike={"1/4": "-817.2"},
)
def length_unit(case: MatrixCase) -> Hypotheses:
    """The position is in a wrong unit of length."""
    for times in UNIT_FACTORS if case.is_transform else ():
        position = times * case.expected[POSITION_BLOCK]
        yield Written(position, other_length_unit(times), POSITION_BLOCK)


@misconception(of=PositionBlock, rank=60)
def other_position(case: MatrixCase) -> Hypotheses:
    """The position is that of a wrong pose, such as the pose of a wrong frame."""
    # Translators: {pose} is a name such as "the pose of frame {2}".
    told = template("The position comes from {pose}. {advice}")
    return _from_other_poses(case, POSITION_BLOCK, told)


def _from_other_poses(case: MatrixCase, block: Block, told: str) -> Hypotheses:
    poses, entries = case.other_poses
    # A constant block, such as a position of zeros, does not show which pose it belongs to.
    varies = np.ptp(entries[:, *block], axis=-1).max(axis=(1, 2)) > EXACT_VALUE
    for i in np.flatnonzero(varies).tolist():
        found = named(poses[i], told)
        yield Written(entries[i][block], found, block, record=poses[i].record)


@check(of=UpperRows, rank=20)
def slip_of_rows(case: MatrixCase) -> Explained | None:
    """A mistake in the DH table explains the wrong rotation and position."""
    return _of_slips(case, UPPER_ROWS)


@check(of=RotationBlock, rank=20)
def slip_of_rotation(case: MatrixCase) -> Explained | None:
    """A mistake in the DH table explains the wrong rotation."""
    return _of_slips(case, ROTATION_BLOCK)


@check(of=PositionBlock, rank=20)
def slip_of_position(case: MatrixCase) -> Explained | None:
    """A mistake in the DH table explains the wrong position."""
    return _of_slips(case, POSITION_BLOCK)


def _of_slips(case: MatrixCase, block: Block) -> Explained | None:
    # If axes with wrong signs explain the block, too, that simpler explanation is preferred.
    entries = case.mask(block)
    if case.slips is None or (case.wrong[block].sum() == 1 and block != UPPER_ROWS):
        return None
    found = case.slips.explanation(entries)
    if found is not None and found.findings[0].code in AFTER_SIGNS:
        signs = explanation(case, of=Lines)
        left = case.wrong & entries
        if signs is not None and not (left & ~case.mask(signs.entries)).any():
            return signs if block == UPPER_ROWS else None
    return found


@check(
    of=BottomRow,
    rank=10,
    code="bottom_row",
    rule="rotation_columns",
    means="the bottom row is not 0 0 0 1",
    example=("homogeneous-inverse", "numbers", {"4/3": "1"}),
    unlike={"3/3": "1"},
)
def bottom_row(case: MatrixCase) -> Explained | None:
    """The bottom row is not 0 0 0 1."""
    if not (case.is_transform and case.wrong[BOTTOM_ROW].any()):
        return None
    hint = say("The bottom row of a homogeneous transform is the same for every transform.")
    return Hypothesis(None, says(hint, say("It is 0 0 0 1.")), BOTTOM_ROW)


@dataclass(frozen=True)
class WrongAxes:
    """The rotation ``(SAMPLES, 3, 3)`` of a wrong matrix."""

    rotation: Numbers
    # The codes of the findings on the entries of the rotation.
    codes: list[str]


@check(
    of=WrongAxes,
    rank=10,
    code="left_handed_rotation",
    rule="rotation_columns",
    means="the columns form a left-handed frame (a warning)",
    example=("rigid-motion-chain", "parallel-axes", {"2/3": "1"}),
    unlike={"2/3": "0"},
)
def left_handed_rotation(axes: WrongAxes) -> Finding | None:
    """The columns form a left-handed frame: det R = −1."""
    if _fault(axes.rotation) is not None or not (np.linalg.det(axes.rotation) < 0).all():
        return None
    finding = says(
        say(
            "The columns of the rotation form a left-handed frame (the determinant is negative): "
            "x × y must be z."
        ),
    )
    return replace(finding, severity=Severity.WARNING)


@check(
    of=WrongAxes,
    rank=20,
    code="rotation_not_orthonormal",
    rule="rotation_columns",
    when=lambda axes: UNEXPLAINED in axes.codes,
    means="the columns are not unit vectors at right angles; appears only with an unexplained "
    "entry (a hint)",
    example=("rigid-motion-chain", "parallel-axes", {"2/3": "0"}),
    unlike={"1/1": "l1"},
)
def rotation_not_orthonormal(axes: WrongAxes) -> Finding | None:
    """The columns are not perpendicular unit vectors."""
    fault = _fault(axes.rotation)
    if fault is None:
        return None
    return replace(says(fault), severity=Severity.HINT)


def _fault(rotation: Numbers) -> Sentence | None:
    products = np.swapaxes(rotation, 1, 2) @ rotation
    wrong = np.abs(products - np.eye(3)).max(axis=0) > 4 * ROUNDED_VALUE
    for j in range(3):
        if wrong[j, j]:
            return say(
                "The columns of a rotation are unit vectors at right angles to each other, so you "
                "can check yours: column {column} is no unit vector.",
                column=j + 1,
            )
    for i, j in ((0, 1), (0, 2), (1, 2)):
        if wrong[i, j]:
            return say(
                "The columns of a rotation are unit vectors at right angles to each other, so you "
                "can check yours: columns {first} and {second} are not at right angles.",
                first=i + 1,
                second=j + 1,
            )
    return None


def explain(case: MatrixCase) -> list[Explanation]:
    """Return explanations of the whole matrix, its rotation or its position."""
    whole = explanation(case)
    if whole is not None or not case.rigid:
        return as_explanations(case, whole)
    explained = as_explanations(case, explanation(case, of=BottomRow))
    if case.wrong[UPPER_ROWS].any():
        explained += as_explanations(case, explanation(case, of=UpperRows)) or _of_blocks(case)
    return explained


def _of_blocks(case: MatrixCase) -> list[Explanation]:
    explained: list[Explanation] = []
    for block, kind in ((ROTATION_BLOCK, RotationBlock), (POSITION_BLOCK, PositionBlock)):
        if case.wrong[block].any():
            explained += as_explanations(case, explanation(case, of=kind))
    rest = replace(case, wrong=unexplained(case, explained))
    return explained + as_explanations(rest, explanation(rest, of=Lines))


def unexplained(case: MatrixCase, explained: Sequence[Explanation]) -> Mask:
    """Return a mask of the wrong entries that no explanation covers."""
    return np.asarray(case.wrong & ~np.any([each.entries for each in explained], axis=0))


def check_yourself(case: MatrixCase, slips: Mapping[tuple[int, int], Finding]) -> Finding | None:
    """Return a finding if the student's rotation is left-handed or not orthonormal, else None.

    ``slips`` are the findings on the single entries.
    """
    rotation = np.moveaxis(case.actual[ROTATION_BLOCK], -1, 0)
    codes = [finding.code for (i, j), finding in slips.items() if i < 3 and j < 3]
    if not (case.rigid and codes and np.isfinite(rotation).all()):
        return None
    return diagnosed(case, WrongAxes(rotation, codes))
