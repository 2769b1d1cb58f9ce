"""Slips that run through a whole matrix.

Each function is one misconception that the student may have held, or one property that the matrix
should have. It says what it explains; the entries that it explains need no word of their own.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import permutations

import numpy as np

from service.grading.diagnosis.link_products import Alternative, alternatives, as_entries
from service.grading.diagnosis.matrix_case import WHOLE, Block, Explanation, Mask, MatrixCase
from service.grading.diagnosis.wrong_value import UNEXPLAINED
from service.grading.feedback import Finding
from service.grading.report import Severity
from service.grading.tolerances import EXACT_VALUE, ROUNDED_VALUE
from service.kinematics.transforms import Numbers, inverse

ROTATION = (slice(0, 3), slice(0, 3))
POSITION = (slice(0, 3), slice(3, 4))
UPPER = (slice(0, 3), slice(None))
BOTTOM = (slice(3, 4), slice(None))
AXES = ("x", "y", "z")


def transposed_matrix(case: MatrixCase) -> Explanation | None:
    """Rows were written as columns, throughout."""
    if case.expected.shape[0] != case.expected.shape[1]:
        return None
    if not case.explained_by(np.swapaxes(case.expected, 0, 1)):
        return None
    code = "transposed_rotation" if case.rigid and not case.is_transform else "transposed_matrix"
    finding = Finding(code, "This matrix is transposed.", "Write its rows as columns.")
    return Explanation(finding, case.area(WHOLE))


def transposed_rotation(case: MatrixCase) -> Explanation | None:
    """The axes of the base were written down as seen from the last frame, not the other way."""
    if not case.explained_by(np.swapaxes(case.expected[ROTATION], 0, 1), ROTATION):
        return None
    finding = Finding(
        "transposed_rotation",
        "The rotation is transposed: its columns, not its rows, are the axes of the frame that is "
        "described.",
        "Write its rows as columns.",
    )
    return Explanation(finding, case.area(ROTATION))


def columns_exchanged(case: MatrixCase) -> Explanation | None:
    """The axes of the last frame were written down in another order."""
    orders = list(permutations(range(3)))[1:]
    candidates = np.array([case.expected[:3, order] for order in orders])
    found = _first(case.explained_by(candidates, ROTATION))
    if found is None:
        return None
    axes = ", ".join(AXES[j] for j in orders[found])
    finding = Finding(
        "columns_exchanged",
        "The columns of the rotation are in another order: they are the x, y and z axis of the "
        "frame that is described.",
        f"Your columns are its {axes} axes.",
    )
    return Explanation(finding, case.area(ROTATION))


def inverse_transform(case: MatrixCase) -> Explanation | None:
    """The base was described as seen from the last frame, not the other way."""
    if not case.explained_by(_inverted(case.expected)[UPPER], UPPER):
        return None
    return Explanation(_INVERSE, case.area(UPPER))


_INVERSE = Finding(
    "inverse_transform",
    "This matrix leads the other way: it is the inverse of the transform that is asked for.",
    "Its columns are the axes and the origin of the last frame, seen from the first.",
)


def _inverted(matrix: Numbers) -> Numbers:
    return as_entries(inverse(np.moveaxis(matrix, -1, 0)))


def bottom_row(case: MatrixCase) -> Explanation | None:
    """The bottom row was taken to hold anything but 0 0 0 1."""
    if not case.wrong[BOTTOM].any():
        return None
    finding = Finding(
        "bottom_row",
        "The bottom row of a homogeneous transform is the same for every transform.",
        "It is 0 0 0 1.",
    )
    return Explanation(finding, case.area(BOTTOM), row="4")


@dataclass(frozen=True, slots=True)
class _Offered:
    """The poses of all misconceptions ``(n, rows, columns, SAMPLES)``, compared with the answer.

    ``right`` is where they are what is expected: a misconception that changes nothing explains
    nothing.
    """

    alternatives: Sequence[Alternative]
    poses: Numbers
    agree: Mask
    right: Mask

    def whole(self) -> int | None:
        """The first pose that the student's matrix is."""
        return _first(_everywhere(self.agree[:, *UPPER]) & ~_everywhere(self.right[:, *UPPER]))

    def block(self, block: Block) -> int | None:
        """The first pose that the student's rotation or position is taken from.

        A constant block, such as a position of zeros, is no sign of where it came from.
        """
        moves = np.ptp(self.poses[:, *block], axis=-1).max(axis=(1, 2)) > EXACT_VALUE
        changed = ~_everywhere(self.right[:, *block])
        return _first(_everywhere(self.agree[:, *block]) & changed & moves)

    def told(self, subject: str, i: int) -> Finding:
        """What is said of misconception ``i``."""
        alternative = self.alternatives[i]
        look = f"{subject} {alternative.what}. {alternative.hint}"
        return Finding(alternative.code, look, alternative.correction)


def _offered(case: MatrixCase) -> _Offered | None:
    found = alternatives(case.chains)
    if not found:
        return None
    rows, columns = case.expected.shape[:2]
    poses = as_entries(np.array([alternative.pose for alternative in found]))[:, :rows, :columns]
    return _Offered(found, poses, case.agrees(poses), case.would_be_right(poses))


def other_pose(case: MatrixCase, offered: _Offered) -> list[Explanation]:
    """Another pose was worked out; all misconceptions of ``products``, and the inverse of each."""
    whole = offered.whole()
    if whole is not None:
        return [Explanation(offered.told("This matrix is", whole), case.area(UPPER))]
    if not case.is_transform:
        return []
    turned_back = replace(case, actual=_inverted(case.actual)).agrees(offered.poses)
    inner = replace(offered, agree=turned_back).whole()
    if inner is None:
        return []
    told = offered.told("What was inverted is", inner)
    return [Explanation(_INVERSE, case.area(UPPER)), Explanation(told, case.area(UPPER))]


def other_rotation(case: MatrixCase, offered: _Offered) -> Explanation | None:
    """The rotation, if nothing else, was taken from another pose."""
    found = offered.block(ROTATION)
    if found is None:
        return None
    return Explanation(offered.told("The rotation comes from", found), case.area(ROTATION))


def other_position(case: MatrixCase, offered: _Offered) -> Explanation | None:
    """The position, if nothing else, was taken from another pose."""
    found = offered.block(POSITION)
    if found is None:
        return None
    return Explanation(offered.told("The position comes from", found), case.area(POSITION))


def _everywhere(agree: Mask) -> Mask:
    return np.asarray(agree.all(axis=(1, 2)))


def _first(holds: Mask) -> int | None:
    found = np.flatnonzero(holds)
    return int(found[0]) if found.size else None


def line_sign(case: MatrixCase, left: Mask) -> Explanation | None:
    """A whole column or row has the wrong sign: an axis was taken to point the opposite way.

    ``left`` are the wrong entries that nothing else explains; a line with one of them is left to
    the entry itself.
    """
    opposite = case.agrees(-case.expected)
    rest = left & case.area(UPPER)
    columns = [j for j in range(rest.shape[1]) if opposite[:3, j].all() and rest[:, j].sum() > 1]
    rows = [i for i in range(3) if opposite[i].all() and rest[i].sum() > 1]
    by_column = case.area(*((slice(0, 3), slice(j, j + 1)) for j in columns))
    by_row = case.area(*((slice(i, i + 1), slice(None)) for i in rows))
    if columns and (by_column & rest).sum() >= (by_row & rest).sum():
        return Explanation(_column_sign(columns), by_column)
    return Explanation(_row_sign(rows), by_row) if rows else None


def _column_sign(columns: list[int]) -> Finding:
    parts = [f"{AXES[j]} axis" if j < 3 else "position" for j in columns]
    return Finding(
        "column_sign",
        f"{_lines('Column', columns)} the wrong sign throughout: check which way the "
        f"{_listed(parts)} of the last frame should point.",
        "Change the sign of each entry there.",
    )


def _row_sign(rows: list[int]) -> Finding:
    return Finding(
        "row_sign",
        f"{_lines('Row', rows)} the wrong sign throughout: check which way the "
        f"{_listed([f'{AXES[i]} axis' for i in rows])} of the first frame should point.",
        "Change the sign of each entry there.",
    )


def _lines(name: str, indices: list[int]) -> str:
    numbers = _listed([str(i + 1) for i in indices])
    return f"{name} {numbers} has" if len(indices) == 1 else f"{name}s {numbers} have"


def _listed(words: list[str]) -> str:
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def left_handed_rotation(rotation: Numbers) -> Finding | None:
    """The axes of a frame were taken to form a left hand: det R = −1."""
    if _fault(rotation) is not None or not (np.linalg.det(rotation) < 0).all():
        return None
    return Finding(
        "left_handed_rotation",
        "The columns of the rotation form a left-handed frame (the determinant is −1): x × y must "
        "be z.",
        severity=Severity.WARNING,
    )


def rotation_not_orthonormal(rotation: Numbers) -> Finding | None:
    """The columns of a rotation were not thought of as unit vectors at right angles."""
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
    """Which column of ``(SAMPLES, 3, 3)`` has not length 1, or else which are at no right angle."""
    products = np.swapaxes(rotation, 1, 2) @ rotation
    off = np.abs(products - np.eye(3)).max(axis=0) > 4 * ROUNDED_VALUE
    for j in range(3):
        if off[j, j]:
            return f"the length of column {j + 1} is not 1"
    for i, j in ((0, 1), (0, 2), (1, 2)):
        if off[i, j]:
            return f"columns {i + 1} and {j + 1} are not at right angles"
    return None


def explain(case: MatrixCase) -> list[Explanation]:
    """What is wrong with the matrix as a whole, or with a large part of it."""
    transposed = transposed_matrix(case)
    if transposed is not None:
        return [transposed]
    if not case.rigid:
        return []
    bottom = bottom_row(case) if case.is_transform else None
    found = [bottom] if bottom else []
    if case.wrong[UPPER].any():
        found += _of_pose(case)
    return found


def _of_pose(case: MatrixCase) -> list[Explanation]:
    inverted = inverse_transform(case) if case.is_transform else None
    if inverted is not None:
        return [inverted]
    offered = _offered(case)
    whole = other_pose(case, offered) if offered else []
    return whole or _of_blocks(case, offered)


def _of_blocks(case: MatrixCase, offered: _Offered | None) -> list[Explanation]:
    misconceptions: list[Explanation | None] = []
    if case.wrong[ROTATION].any():
        rearranged = transposed_rotation(case) or columns_exchanged(case)
        misconceptions.append(rearranged or (other_rotation(case, offered) if offered else None))
    if offered and case.is_transform and case.wrong[POSITION].any():
        misconceptions.append(other_position(case, offered))
    found = [misconception for misconception in misconceptions if misconception is not None]
    signs = line_sign(case, unexplained(case, found))
    return [*found, signs] if signs else found


def unexplained(case: MatrixCase, found: Sequence[Explanation]) -> Mask:
    """The wrong entries that none of the explanations covers."""
    left = case.wrong.copy()
    for explanation in found:
        left &= ~explanation.entries
    return left


def check_yourself(case: MatrixCase, slips: Mapping[tuple[int, int], Finding]) -> Finding | None:
    """Which property of a rotation the student's lacks, where ``slips`` leave it unexplained.

    A frame that is left-handed is always named, any other fault only where the entries say no more.
    """
    rotation = np.moveaxis(case.actual[ROTATION], -1, 0)
    inside = [finding.code for (i, j), finding in slips.items() if i < 3 and j < 3]
    if not (case.rigid and inside and np.isfinite(rotation).all()):
        return None
    left_handed = left_handed_rotation(rotation)
    if left_handed or UNEXPLAINED not in inside:
        return left_handed
    return rotation_not_orthonormal(rotation)
