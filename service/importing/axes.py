"""The joint axes of an arm at home, in the coordinates of its base link."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from service.importing.urdf import Arm
from service.kinematics.transforms import Matrices, Numbers
from service.translations import say

PARALLEL = 1e-6
# Axes that are less than this apart, in radians, but not parallel, are a maker's rounding: their
# common normal is hundreds of metres long.
_NEARLY = 2e-3


class UnclearAxesError(ValueError):
    """Two axes are nearly parallel; the message says which."""


@dataclass(frozen=True, slots=True)
class HomeAxis:
    """A joint axis: a point, a unit vector along it, and the joint's type."""

    point: Numbers
    direction: Numbers
    prismatic: bool

    def through(self, point: Numbers) -> "HomeAxis":
        """Return the axis moved so that it passes through ``point``."""
        return HomeAxis(point, self.direction, self.prismatic)

    def nearest(self, point: Numbers) -> Numbers:
        """Return the point of the axis that is nearest to ``point``."""
        along = float((point - self.point) @ self.direction)
        return np.asarray(self.point + along * self.direction)

    def parallel_to(self, direction: Numbers) -> bool:
        """True if the axis is parallel or antiparallel to ``direction``."""
        return float(np.linalg.norm(np.cross(self.direction, direction))) < PARALLEL


def home_axes(arm: Arm) -> tuple[list[HomeAxis], Matrices]:
    """Return the joint axes and the pose of the tip when all joint variables are 0."""
    pose = np.eye(4)
    axes = []
    for joint in arm.joints:
        pose = pose @ joint.before
        axes.append(HomeAxis(pose[:3, 3].copy(), pose[:3, :3] @ joint.axis, joint.prismatic))
    for i, (first, second) in enumerate(pairwise(axes), 1):
        apart = float(np.linalg.norm(np.cross(first.direction, second.direction)))
        if PARALLEL <= apart < _NEARLY:
            raise UnclearAxesError(
                say(
                    "the axes of joints {first} and {second} are nearly parallel ({angle}° apart); "
                    "write exact angles in the file",
                    first=i,
                    second=i + 1,
                    angle=f"{np.degrees(apart):.4f}",
                )
            )
    tip = pose @ arm.after
    return _sliding_axes_moved(axes, tip[:3, 3]), np.asarray(tip)


def _sliding_axes_moved(axes: list[HomeAxis], tip: Numbers) -> list[HomeAxis]:
    """Move each sliding axis to the next axis, which saves lengths in the table."""
    # Only the direction of a sliding axis matters.
    moved = list(axes)
    for i in reversed(range(len(axes))):
        if not axes[i].prismatic:
            continue
        if i + 1 == len(axes):
            moved[i] = axes[i].through(tip)
        elif moved[i + 1].parallel_to(axes[i].direction):
            moved[i] = axes[i].through(moved[i + 1].nearest(axes[i].point))
        else:
            moved[i] = axes[i].through(common_normal(axes[i], moved[i + 1])[1])
    return moved


def common_normal(first: HomeAxis, second: HomeAxis) -> tuple[Numbers, Numbers]:
    """Return both ends of the common normal of two axes, which must not be parallel."""
    normal = np.cross(first.direction, second.direction)
    between = second.point - first.point
    squared = float(normal @ normal)
    along_first = float(np.cross(between, second.direction) @ normal) / squared
    along_second = float(np.cross(between, first.direction) @ normal) / squared
    return (
        np.asarray(first.point + along_first * first.direction),
        np.asarray(second.point + along_second * second.direction),
    )
