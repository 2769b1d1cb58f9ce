"""Slips that run through a whole matrix, or through its rotation or its position.

Entries that a hypothesis explains need no finding of their own.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import chain, permutations

import numpy as np

from service.grading.diagnosis.matrices import inverse_slips
from service.grading.diagnosis.matrices.matrix_case import (
    BOTTOM_ROW,
    POSITION_BLOCK,
    ROTATION_BLOCK,
    UPPER_ROWS,
    Block,
    Explanation,
    MatrixCase,
    as_explanations,
)
from service.grading.diagnosis.motions import motion_slips
from service.grading.diagnosis.motions.link_products import named
from service.grading.diagnosis.upstream.slip_search import BEHIND_SIGNS
from service.grading.diagnosis.wording import listed
from service.grading.diagnosis.wrong_value import UNEXPLAINED, Hypotheses, Mask
from service.grading.feedback import Finding
from service.grading.judging.expected import as_entries
from service.grading.misconception import Written, explanation
from service.grading.numerics.tolerances import EXACT_VALUE, ROUNDED_VALUE
from service.grading.report import Severity
from service.kinematics.transforms import Numbers, inverse

Misconceptions = tuple[Callable[[MatrixCase], Hypotheses], ...]


def transposed_matrix(case: MatrixCase) -> Hypotheses:
    """Rows were written as columns, throughout."""
    code = "transposed_rotation" if case.rigid and not case.is_transform else "transposed_matrix"
    finding = Finding(code, "This matrix is transposed.", "Write its rows as columns.")
    if case.expected.shape[0] == case.expected.shape[1]:
        yield Written(np.swapaxes(case.expected, 0, 1), finding)


def inverse_transform(case: MatrixCase) -> Hypotheses:
    """The first frame was described in the last."""
    if case.is_transform:
        yield Written(_inverted(case.expected)[UPPER_ROWS], INVERTED, UPPER_ROWS)


INVERTED = Finding(
    "inverse_transform",
    "This matrix leads the other way: it is the inverse of the transform that is asked for.",
    "Its columns are the axes and the origin of the last frame, seen from the first.",
)

# The inverse of something else than what is asked for.
OTHER_WAY = replace(
    INVERTED,
    hint="This matrix leads the other way: check which frame it describes, and from which frame.",
    correction="",
)


def _inverted(matrix: Numbers) -> Numbers:
    """The inverse of transforms ``(..., 4, 4, SAMPLES)``."""
    return as_entries(inverse(np.moveaxis(matrix, -1, -3)))


def other_pose(case: MatrixCase) -> Hypotheses:
    """Another pose was worked out."""
    for pose, entries in zip(*case.other_poses, strict=True):
        yield Written(entries[UPPER_ROWS], named(pose, "This matrix is"), UPPER_ROWS)


def inverse_of_other_pose(case: MatrixCase) -> Hypotheses:
    """Another pose was worked out, then inverted."""
    if case.is_transform:
        poses, entries = case.other_poses
        for pose, inverted in zip(poses, _inverted(entries), strict=True):
            finding = named(pose, "This is the inverse of", OTHER_WAY)
            yield Written(inverted[UPPER_ROWS], finding, UPPER_ROWS)


def transposed_rotation(case: MatrixCase) -> Hypotheses:
    """The axes of the first frame were written down as seen from the last."""
    finding = Finding(
        "transposed_rotation",
        "The rotation is transposed: its columns, not its rows, must be the axes of the frame that "
        "is described.",
        "Write its rows as columns.",
    )
    yield Written(np.swapaxes(case.expected[ROTATION_BLOCK], 0, 1), finding, ROTATION_BLOCK)


def columns_exchanged(case: MatrixCase) -> Hypotheses:
    """The axes of the last frame were written down in another order."""
    for order in list(permutations(range(3)))[1:]:
        finding = Finding(
            "columns_exchanged",
            "The columns of the rotation are in the wrong order: check which axis belongs in which "
            "column.",
            f"Your columns are its {', '.join('xyz'[j] for j in order)} axes.",
        )
        yield Written(case.expected[:3, order], finding, ROTATION_BLOCK)


def other_rotation(case: MatrixCase) -> Hypotheses:
    """The rotation, but not the position, was taken from another pose."""
    return _from_other_poses(case, ROTATION_BLOCK, "The rotation comes from")


def other_position(case: MatrixCase) -> Hypotheses:
    """The position, but not the rotation, was taken from another pose."""
    return _from_other_poses(case, POSITION_BLOCK, "The position comes from")


def _from_other_poses(case: MatrixCase, block: Block, subject: str) -> Hypotheses:
    poses, entries = case.other_poses
    # A constant block, such as a position of zeros, does not show which pose it was taken from.
    varies = np.ptp(entries[:, *block], axis=-1).max(axis=(1, 2)) > EXACT_VALUE
    for i in np.flatnonzero(varies).tolist():
        yield Written(entries[i][block], named(poses[i], subject), block)


def line_sign(case: MatrixCase) -> Hypotheses:
    """A whole column or row has the wrong sign: an axis was taken to point the opposite way.

    A line with one wrong entry is left to the entry itself.
    """
    opposite = case.agree(case.actual, -case.expected)
    wrong = case.wrong & case.mask(UPPER_ROWS)
    columns = [j for j in range(wrong.shape[1]) if opposite[:3, j].all() and wrong[:, j].sum() > 1]
    rows = [i for i in range(3) if opposite[i].all() and wrong[i].sum() > 1]
    by_column = case.mask(*((slice(0, 3), slice(j, j + 1)) for j in columns))
    by_row = case.mask(*((slice(i, i + 1), slice(None)) for i in rows))
    if columns and (by_column & wrong).sum() >= (by_row & wrong).sum():
        finding = _line_sign("column_sign", columns, "last")
        yield Written(-case.expected[by_column], finding, by_column)
    elif rows:
        yield Written(-case.expected[by_row], _line_sign("row_sign", rows, "first"), by_row)


def _line_sign(code: str, indices: list[int], frame: str) -> Finding:
    line = code.removesuffix("_sign").capitalize()
    numbers = listed([str(i + 1) for i in indices])
    have = f" {numbers} has" if len(indices) == 1 else f"s {numbers} have"
    parts = listed([("x axis", "y axis", "z axis", "position")[i] for i in indices])
    return Finding(
        code,
        f"{line}{have} the wrong sign throughout: check which way the {parts} of the "
        f"{frame} frame should point.",
        "Change the sign of each entry there.",
    )


# In front of the slips of tables stand misconceptions that are likelier than any of them, behind
# them those that are less so.
OF_UPPER_ROWS = ((), (inverse_transform, other_pose, inverse_of_other_pose))
OF_ROTATION = ((transposed_rotation,), (columns_exchanged, other_rotation))
OF_POSITION = ((), (other_position,))
# The same of transforms and rotations that the exercise gives in formulas.
GIVEN_UPPER_ROWS = (*inverse_slips.OF_UPPER_ROWS, *motion_slips.OF_UPPER_ROWS)
GIVEN_ROTATION = (*inverse_slips.OF_ROTATION, *motion_slips.OF_ROTATION)
GIVEN_POSITION = (*inverse_slips.OF_POSITION, *motion_slips.OF_POSITION)
MISCONCEPTIONS = (
    transposed_matrix,
    *chain.from_iterable(OF_UPPER_ROWS + OF_ROTATION + OF_POSITION),
    line_sign,
)


# --- checks


def bottom_row(case: MatrixCase) -> Finding | None:
    """The bottom row was taken to hold anything but 0 0 0 1."""
    if not (case.is_transform and case.wrong[BOTTOM_ROW].any()):
        return None
    return Finding(
        "bottom_row",
        "The bottom row of a homogeneous transform is the same for every transform.",
        "It is 0 0 0 1.",
    )


def left_handed_rotation(rotation: Numbers) -> Finding | None:
    """The axes ``(SAMPLES, 3, 3)`` of a frame were taken to form a left hand: det R = −1."""
    if _fault(rotation) is not None or not (np.linalg.det(rotation) < 0).all():
        return None
    return Finding(
        "left_handed_rotation",
        "The columns of the rotation form a left-handed frame (the determinant is negative): x × y "
        "must be z.",
        severity=Severity.WARNING,
    )


def rotation_not_orthonormal(rotation: Numbers) -> Finding | None:
    """The columns ``(SAMPLES, 3, 3)`` are no unit vectors at right angles."""
    fault = _fault(rotation)
    if fault is None:
        return None
    return Finding(
        "rotation_not_orthonormal",
        "The columns of a rotation are unit vectors at right angles to each other, so you can "
        f"check yours: {fault}.",
        severity=Severity.HINT,
    )


def _fault(rotation: Numbers) -> str | None:
    """The first column of another length than 1, or else the first two not at right angles."""
    products = np.swapaxes(rotation, 1, 2) @ rotation
    wrong = np.abs(products - np.eye(3)).max(axis=0) > 4 * ROUNDED_VALUE
    for j in range(3):
        if wrong[j, j]:
            return f"column {j + 1} is no unit vector"
    for i, j in ((0, 1), (0, 2), (1, 2)):
        if wrong[i, j]:
            return f"columns {i + 1} and {j + 1} are not at right angles"
    return None


CHECKS = (bottom_row, left_handed_rotation, rotation_not_orthonormal)


def explain(case: MatrixCase) -> list[Explanation]:
    """What is wrong with the matrix as a whole, or with a large part of it."""
    is_given = case.motion is not None
    of_matrix = inverse_slips.OF_MATRIX if is_given else ()
    transposed = explanation(case, (transposed_matrix, *of_matrix))
    if transposed is not None or not case.rigid:
        return as_explanations(case, transposed)
    bottom = bottom_row(case)
    explained = [Explanation(bottom, case.mask(BOTTOM_ROW))] if bottom else []
    if case.wrong[UPPER_ROWS].any():
        given = GIVEN_UPPER_ROWS if is_given and case.is_transform else ()
        explained += _of_block(case, UPPER_ROWS, *OF_UPPER_ROWS, given) or _of_blocks(case)
    return explained


def _of_blocks(case: MatrixCase) -> list[Explanation]:
    explained: list[Explanation] = []
    is_given = case.motion is not None
    of_rotation = (*OF_ROTATION, GIVEN_ROTATION if is_given else ())
    of_position = (*OF_POSITION, GIVEN_POSITION if is_given else ())
    for block, misconceptions in ((ROTATION_BLOCK, of_rotation), (POSITION_BLOCK, of_position)):
        if case.wrong[block].any():
            explained += _of_block(case, block, *misconceptions)
    rest = replace(case, wrong=unexplained(case, explained))
    return explained + as_explanations(rest, explanation(rest, (line_sign,)))


def _of_block(
    case: MatrixCase,
    block: Block,
    likelier: Misconceptions,
    less_likely: Misconceptions,
    given: Misconceptions,
) -> list[Explanation]:
    """What explains a block: a likely misconception, a slip of the table, or an unlikely one."""
    return (
        as_explanations(case, explanation(case, likelier))
        or _of_slips(case, block)
        or as_explanations(case, explanation(case, (*less_likely, *given)))
    )


def _of_slips(case: MatrixCase, block: Block) -> list[Explanation]:
    """The slips of the table that explain a block.

    A frame of which only axes have the wrong sign is left to ``line_sign``. So is a single
    wrong entry to itself, unless the slip explains the whole matrix.
    """
    entries = case.mask(block)
    if case.slips is None or (case.wrong[block].sum() == 1 and block != UPPER_ROWS):
        return []
    finding = case.slips.finding(entries)
    if finding is not None and finding.code in BEHIND_SIGNS:
        signs = _signs_alone(case, entries)
        if signs:
            return signs if block == UPPER_ROWS else []
    return [Explanation(finding, entries)] if finding else []


def _signs_alone(case: MatrixCase, entries: Mask) -> list[Explanation]:
    """The wrong signs of whole lines, where they explain all that is wrong in these entries."""
    signs = as_explanations(case, explanation(case, (line_sign,)))
    return signs if signs and not (unexplained(case, signs) & entries).any() else []


def unexplained(case: MatrixCase, explained: Sequence[Explanation]) -> Mask:
    """The wrong entries that none of the explanations covers."""
    return np.asarray(case.wrong & ~np.any([each.entries for each in explained], axis=0))


def check_yourself(case: MatrixCase, slips: Mapping[tuple[int, int], Finding]) -> Finding | None:
    """The property of a rotation that the student's lacks, where ``slips`` leave it unexplained.

    A left-handed frame is always named, any other fault only where the entries say no more.
    """
    rotation = np.moveaxis(case.actual[ROTATION_BLOCK], -1, 0)
    codes = [finding.code for (i, j), finding in slips.items() if i < 3 and j < 3]
    if not (case.rigid and codes and np.isfinite(rotation).all()):
        return None
    left_handed = left_handed_rotation(rotation)
    if left_handed or UNEXPLAINED not in codes:
        return left_handed
    return rotation_not_orthonormal(rotation)
