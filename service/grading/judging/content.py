"""Find the content cells of a correct answer: the cells that need knowledge and earn points.

An answer with only zeros and joint variables is called lazy. A content cell is a cell in which the
correct answer differs from the lazy one. ``known`` is a mask of the content cells.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from service.catalogue import Joint, PartSpec
from service.grading.numerics.comparison import difference
from service.grading.numerics.samples import Samples
from service.grading.numerics.tolerances import SAME_CONTENT
from service.grading.part import Content, Grading
from service.kinematics.transforms import Matrices, Numbers

KnownCells = NDArray[np.bool_]


def known_cells(
    right: Numbers, lazy: ArrayLike, scale: ArrayLike = 1.0, angle: ArrayLike = False
) -> KnownCells:
    """Return a mask of the cells in which the correct answer differs from the lazy one.

    A lazy answer needs no knowledge. ``scale`` is the unit of the tolerance.
    """
    # ``right`` is ``(..., samples)``, the result ``(...)``; ``angle`` is true for angles.
    error = np.abs(difference(right, np.asarray(lazy), angle)).max(axis=-1)
    return np.asarray(error > SAME_CONTENT * np.asarray(scale))


def of_rows(
    known: KnownCells,
    *,
    most: int | None = None,
    usual: tuple[int, int] | None = None,
) -> Content:
    """Return the content cells (those that earn points) of a table or of screw axes.

    ``Content`` explains ``most`` and ``usual``.
    """
    # ``known`` is ``(rows, cells)``. Each row is also worth something besides its content cells.
    rows = _rows(known)
    groups = tuple((i,) * len(row) for i, row in enumerate(rows))
    return Content(rows, groups, besides=True, most=most, usual=usual)


def of_one_row(known: KnownCells) -> Content:
    """Return the content cells (those that earn points) of a single row."""
    return Content(_rows(_all_if_none(known)[None]), ((0,) * len(known),))


def of_list(known: KnownCells, reference: KnownCells | None = None) -> Content:
    """Return the content cells (those that earn points) of a list of single values."""
    # At most as many values count as ``reference`` marks.
    return Content(
        _rows(_all_if_none(known)[:, None]), ((0,),) * len(known), most=_count(reference)
    )


def of_rigid(right: Numbers, part: PartSpec, grading: Grading) -> Content:
    """Return the content cells of a rotation or transform: the entries that earn points."""
    # If both the rotation and the position have content cells, each of the two is worth one half.
    exercise = grading.exercise
    if grading.following:
        return _of_rigid(right, exercise.length_scale)
    return _of_asked(_Asked(exercise.version, part.id, right, exercise.length_scale))


@dataclass(frozen=True)
class _Asked:
    # A cache key that does not depend on the samples.
    version: str
    part: str
    right: Numbers = field(compare=False)
    length_scale: float


@lru_cache(maxsize=256)
def _of_asked(asked: _Asked) -> Content:
    return _of_rigid(asked.right, asked.length_scale)


def _of_rigid(right: Numbers, length_scale: float) -> Content:
    known = _differs_from_identity(right, length_scale)
    halves = known[:, :3].any() and known[:, 3:].any()
    groups = tuple(int(halves and column == 3) for column in range(known.shape[1]))
    bottom = (3,) if len(known) == 4 else ()
    return Content(_rows(_all_if_none(known)), (groups,) * len(known), equal=True, bottom=bottom)


def of_matrix(right: Numbers, scale: Numbers) -> Content:
    """Return the content cells (those that earn points) of a matrix that is not a pose."""
    # The zero matrix and the identity are both lazy, so a content cell differs from both.
    known = known_cells(right, 0.0, scale)
    if known.shape[0] == known.shape[1]:
        known &= known_cells(right, np.eye(len(right))[..., None], scale)
    return Content(_rows(_all_if_none(known)), ((0,) * known.shape[1],) * len(known))


def of_links(
    right: Matrices, reference: Matrices, joints: Sequence[Joint], samples: Samples, scale: float
) -> Content:
    """Return the content cells of link transforms: the entries that earn points."""
    # At most as many cells count as the ``reference`` links have content cells.
    known = _differs_from_motion(right, joints, samples, scale)
    most = _differs_from_motion(reference, joints, samples, scale)
    groups = tuple((i // 4,) * 4 for i in range(4 * len(right)))
    bottom = tuple(range(3, 4 * len(right), 4))
    return Content(
        _rows(known.reshape(-1, 4)), groups, besides=True, most=_count(most), bottom=bottom
    )


def _differs_from_motion(
    links: Matrices, joints: Sequence[Joint], samples: Samples, scale: float
) -> KnownCells:
    lazy = np.tile(np.eye(4), (len(links), samples.count, 1, 1))
    for link, joint in zip(lazy, joints, strict=False):
        q = samples.values[joint.variable]
        if joint.prismatic:
            link[:, 2, 3] = q
        else:
            link[:, 0, 0] = link[:, 1, 1] = np.cos(q)
            link[:, 1, 0] = np.sin(q)
            link[:, 0, 1] = -np.sin(q)
    scales = np.array([1.0, 1.0, 1.0, scale])
    return known_cells(np.moveaxis(links, 1, -1), np.moveaxis(lazy, 1, -1), scales)


def _differs_from_identity(right: Numbers, length_scale: float) -> KnownCells:
    scales = np.ones(right.shape[1])
    scales[3:] = length_scale
    return known_cells(right, np.eye(len(right))[..., None], scales)


def _rows(known: KnownCells) -> tuple[tuple[bool, ...], ...]:
    return tuple(map(tuple, known.tolist()))


def _all_if_none(known: KnownCells) -> KnownCells:
    return known if known.any() else np.ones_like(known)


def _count(known: KnownCells | None) -> int | None:
    return None if known is None else int(np.count_nonzero(known))
