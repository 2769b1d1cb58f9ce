"""The figure of a student's table: its frames, drawn over the mechanism or alone.

The figure replaces the 3D view in browsers without 3D graphics.
"""

# It shows one configuration. It contains no text from the student: its only texts are the names of
# axes, x0 to z12.

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from service.catalogue import Joint
from service.figures.drawing.frame_axes import DrawnFrames, frame_axes
from service.figures.drawing.mechanism_solids import (
    ground_solid,
    joint_solid,
    link_solid,
    mechanism_solids,
)
from service.figures.drawing.placing import TakenRoom
from service.figures.drawing.sheet import LARGE_ROOM, Caption, Sheet, camera_for
from service.figures.drawing.solids import back_to_front, polyline
from service.figures.drawing.style import Theme
from service.figures.geometry.mechanism import Configuration, MovableMechanism, distinct
from service.figures.geometry.view import View
from service.kinematics.chain import joint_frames
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices, Numbers

# The view of a table without a mechanism; the 3D view begins with the same view.
_PLAIN: Final = View(-60, 25)
_UP: Final = np.array([0.0, 0.0, 1.0])
_NOTHING: Final = 1e-5
# The length of frame axes as a share of the parts' size, and the minimum length in pixels.
_FRAME: Final = 0.2
_LEAST: Final = 30.0
_CAPTION: Final = Caption(
    "table", "The robot as the table says", "The frames of the table; x is red, y green, z blue."
)


@dataclass(frozen=True, slots=True)
class WrittenChain:
    """A table at some joint values: its frames ``(frames, 4, 4)``, the base frame first.

    ``row_joints`` has the joint of each row, or None for a row without a joint.
    """

    frames: Matrices
    row_joints: tuple[Joint | None, ...]
    convention: Convention

    @property
    def links(self) -> list[Numbers]:
        """The line ``(3, 3)`` of each row, through three points: along z and along x."""
        # In the convention's order.
        return [
            np.array([before[:3, 3], before[:3, 3] + self._first(before, after), after[:3, 3]])
            for before, after in pairwise(self.frames)
        ]

    def _first(self, before: Numbers, after: Numbers) -> Numbers:
        axis = before[:3, 2 if self.convention is Convention.STANDARD else 0]
        return np.asarray(axis * (axis @ (after[:3, 3] - before[:3, 3])))

    @property
    def axes(self) -> Iterator[tuple[Joint, Numbers]]:
        """The joints, each with the frame ``(4, 4)`` whose z axis is the joint axis."""
        for joint, frame in zip(
            self.row_joints, joint_frames(self.frames, self.convention), strict=True
        ):
            if joint is not None:
                yield joint, frame


@dataclass(frozen=True, slots=True)
class SeenMechanism:
    """The mechanism of an exercise, its configuration and its view."""

    mechanism: MovableMechanism
    shown: Configuration
    view: View


def table_figure(
    written: WrittenChain | None, seen: SeenMechanism | None, theme: Theme = Theme.AUTO
) -> str:
    """Return the SVG of a table, of a mechanism, or of both; at least one must be given."""
    links = [] if written is None else written.links
    corners = [np.zeros((1, 3)), *links]
    if seen is not None:
        corners += [*seen.shown.links, seen.shown.base[None]]
    points = np.concatenate(corners)
    extent = float(np.linalg.norm(np.ptp(points, axis=0)))
    if extent < _NOTHING:
        # A table whose frames all coincide is drawn as large as its parts.
        points, extent = np.concatenate([points, _UP[None]]), 1.0
    size = seen.mechanism.size if seen else 0.9 * extent
    sheet = Sheet(
        camera_for(points, seen.view if seen else _PLAIN, LARGE_ROOM), size, TakenRoom(hasty=True)
    )
    if seen is not None:
        solids = mechanism_solids(sheet, seen.shown, seen.mechanism, _CAPTION.name)
        for line in links:
            drawn = sheet.camera.seen(line)
            sheet.above.append(polyline(drawn, "chain"))
            sheet.take(drawn, 1.3)
    else:
        solids = _solids(sheet, written, links) if written else []
    if written is not None:
        length = max(_FRAME * size, _LEAST / sheet.camera.scale)
        names = [str(i) for i in range(len(written.frames))]
        frames = DrawnFrames(written.frames, names, ["xyz"] * len(names))
        sheet.above += frame_axes(sheet.camera, frames, length, sheet.room)
    return sheet.svg(solids, _CAPTION, theme)


def _solids(sheet: Sheet, written: WrittenChain, links: list[Numbers]) -> list[str]:
    joints = [
        joint_solid(
            sheet, frame[:3, 3], frame[:3, 2], f"{_CAPTION.name}-{i}", slides=joint.prismatic
        )
        for i, (joint, frame) in enumerate(written.axes)
    ]
    lines = [line for line in map(distinct, links) if len(line) > 1]
    rods = [link_solid(sheet, line, line) for line in lines]
    floor = ground_solid(sheet, np.zeros(3), _UP)
    return [floor.svg, *(solid.svg for solid in back_to_front(sheet.camera, [*joints, *rods]))]
