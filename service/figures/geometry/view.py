"""The direction from which a figure is seen, in parallel projection with z0 upwards."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.figures.geometry.mechanism import Configuration
from service.kinematics.transforms import Numbers

_AZIMUTHS = (-60, 30, -50, 40, -40, 50, -30, 60, -70, 20, -20, 70, 120, -150, 130, -140, 150, -120)
_ELEVATIONS = (25, 30, 20, 35, 15)
_SAME = 1e-6


@dataclass(frozen=True, slots=True)
class View:
    """The direction to the viewer: degrees about z0 from x0, and degrees above the x0-y0 plane."""

    azimuth: float
    elevation: float

    @property
    def rotation(self) -> Numbers:
        """The rotation ``(3, 3)``; its rows are the directions right, up and to the viewer."""
        a, e = np.radians([self.azimuth, self.elevation])
        right = [-np.sin(a), np.cos(a), 0.0]
        towards = [np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)]
        return np.array([right, np.cross(towards, right), towards])


def best_view(shown: Configuration, extent: float) -> View:
    """Return the clearest view of the mechanism."""
    # Of equally clear views, the first. In a clear view, no joint axis points at the viewer, no
    # link is much foreshortened, different directions look different, distinct points are apart,
    # and the arm extends to the right.
    views = [View(azimuth, elevation) for elevation in _ELEVATIONS for azimuth in _AZIMUTHS]
    rotations = np.array([view.rotation for view in views])
    steps = np.concatenate([np.diff(link, axis=0) for link in shown.links])
    lengths = np.linalg.norm(steps, axis=1, keepdims=True)
    seen = lengths[:, 0] > 0.02 * extent
    steps = steps[seen] / lengths[seen]
    directions = _different(np.concatenate([shown.axes, steps]), _parallel)
    flat = _flat(directions, rotations)
    sizes = np.maximum(np.linalg.norm(flat, axis=-1), _SAME)
    i, j = np.triu_indices(len(directions), 1)
    crossed = np.abs(flat[:, i, 0] * flat[:, j, 1] - flat[:, i, 1] * flat[:, j, 0])
    angles = crossed / (sizes[:, i] * sizes[:, j])

    points = _different(
        np.concatenate([shown.centres, *shown.links]),
        lambda points, point: np.linalg.norm(points - point, axis=1) < 0.02 * extent,
    )
    i, j = np.triu_indices(len(points), 1)
    gaps = np.linalg.norm(np.diff(_flat(points, rotations)[:, [i, j]], axis=1)[:, 0], axis=-1)
    apart = np.maximum(np.linalg.norm(points[i] - points[j], axis=-1), 0.1 * extent)
    rightwards = _flat((shown.tool - shown.base)[None], rotations)[:, 0, 0]
    clarity = (
        2.0 * np.minimum(sizes.min(axis=1), 0.75)
        + 1.2 * angles.min(axis=1, initial=0.55)
        + 1.2 * (gaps / apart).min(axis=1, initial=0.5)
        + 0.5 * np.minimum(gaps / extent, 0.3).mean(axis=1)
        + 0.4 * np.clip(3 * rightwards / extent, -1.0, 1.0)
    )
    return views[int(clarity.argmax())]


def _flat(points: Numbers, rotations: Numbers) -> Numbers:
    # ``(points, 3)`` becomes ``(views, points, 2)``.
    return np.asarray((points @ np.swapaxes(rotations, 1, 2))[..., :2])


def _parallel(directions: Numbers, direction: Numbers) -> NDArray[np.bool_]:
    return np.asarray(np.linalg.norm(np.cross(directions, direction), axis=1) < _SAME)


def _different(rows: Numbers, alike: Callable[[Numbers, Numbers], NDArray[np.bool_]]) -> Numbers:
    kept = rows[:1]
    for row in rows[1:]:
        if not alike(kept, row).any():
            kept = np.concatenate([kept, row[None]])
    return kept
