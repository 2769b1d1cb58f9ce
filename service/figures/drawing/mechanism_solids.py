"""Draw a mechanism: ground, links, joints and gripper, from the farthest to the nearest."""

from typing import Final

import numpy as np

from service.figures.drawing.sheet import Sheet
from service.figures.drawing.solids import (
    Solid,
    back_to_front,
    box,
    cylinder,
    gripper,
    ground,
    polyline,
    rod,
)
from service.figures.geometry.mechanism import (
    GRIPPER_LENGTH,
    JOINT_LENGTH,
    JOINT_RADIUS,
    Configuration,
    MovableMechanism,
)
from service.kinematics.transforms import Numbers

_BOX_WIDTH = 1.05 * JOINT_RADIUS
_ROD: Final = 0.036
_AXIS_BEYOND: Final = 0.11


def mechanism_solids(
    sheet: Sheet, shown: Configuration, mechanism: MovableMechanism, name: str
) -> list[str]:
    """Return the SVG of the whole mechanism, and mark its room on the sheet as taken."""
    size = sheet.size
    solids = [
        joint_solid(sheet, centre, axis, f"{name}-{i + 1}", slides=joint.prismatic)
        for i, (joint, centre, axis) in enumerate(
            zip(mechanism.joints, shown.centres, shown.axes, strict=True)
        )
    ]
    reach = GRIPPER_LENGTH * size
    for i, corners in enumerate(shown.links):
        line = corners if i + 1 < len(shown.links) else _shortened(corners, reach)
        if len(line) > 1:
            solids.append(link_solid(sheet, line, _clear_of_joints(line, i, shown, mechanism)))
    width = 0.42 * _ROD * sheet.unit
    grip = gripper(sheet.camera, shown.tool, shown.tool_direction, reach, width)
    sheet.take(sheet.camera.seen(grip.spine), grip.radius)
    floor = ground_solid(sheet, shown.base, shown.base_normal)
    return [floor.svg, *(solid.svg for solid in back_to_front(sheet.camera, [*solids, grip]))]


def joint_solid(sheet: Sheet, centre: Numbers, axis: Numbers, fill: str, *, slides: bool) -> Solid:
    """Return the solid of a joint, and draw the joint axis behind it."""
    camera, size = sheet.camera, sheet.size
    half, radius = JOINT_LENGTH / 2 * size, JOINT_RADIUS * size
    ends = centre + np.array([[-1.0], [1.0]]) * (half + _AXIS_BEYOND * size / 2) * axis
    sheet.below.append(polyline(camera.seen(ends), "axis"))
    sheet.take(camera.seen(ends), 1.0, 0.6)
    inner = centre + np.array([[-1.0], [1.0]]) * half * axis
    sheet.take(camera.seen(inner), (1.3 if slides else 1.0) * radius * camera.scale)
    if slides:
        return box(camera, centre, axis, half, _BOX_WIDTH * size)
    return cylinder(camera, centre, axis, half, radius, fill)


def link_solid(sheet: Sheet, line: Numbers, drawn: Numbers) -> Solid:
    """Return the solid of a link with the corners ``drawn``, and mark its room as taken."""
    # The room is along ``line``.
    sheet.take(sheet.camera.seen(line), _ROD * sheet.unit / 2)
    return rod(sheet.camera, drawn, _ROD * sheet.unit)


def ground_solid(sheet: Sheet, base: Numbers, normal: Numbers) -> Solid:
    """Return the solid of the ground under a robot, and mark its room as taken."""
    camera = sheet.camera
    floor = ground(camera, base, normal, 0.13 * sheet.size)
    width = floor.radius * camera.seen(camera.rotation[0]) / camera.scale
    for down in (-0.02, 0.05):
        middle = camera.seen(base - down * sheet.size * normal)
        sheet.take(np.array([middle - width, middle + width]), 0.06 * sheet.unit)
    return floor


def _shortened(corners: Numbers, by: float) -> Numbers:
    line = corners
    while len(line) > 1:
        last = line[-1] - line[-2]
        length = float(np.linalg.norm(last))
        if length > by:
            return np.concatenate([line[:-1], line[-1:] - by / length * last])
        by, line = by - length, line[:-1]
    return line


def _clear_of_joints(
    line: Numbers, link: int, shown: Configuration, mechanism: MovableMechanism
) -> Numbers:
    # Between the surfaces of the joints at the link's two ends.
    first, last = line[0], line[-1]
    if link > 0:
        first = _surface(line[0], line[1], shown, link - 1, mechanism)
    if link < len(mechanism.joints):
        last = _surface(line[-1], line[-2], shown, link, mechanism)
    return np.concatenate([first[None], line[1:-1], last[None]])


def _surface(
    start: Numbers, towards: Numbers, shown: Configuration, joint: int, mechanism: MovableMechanism
) -> Numbers:
    # Slightly inside a joint, where a line from the joint's middle leaves it.
    step = towards - start
    length = float(np.linalg.norm(step))
    if length == 0:  # two joints in one place, where a short wrist has no room for both
        return start
    direction = step / length
    along = abs(float(direction @ shown.axes[joint]))
    across = float(np.sqrt(max(1.0 - along**2, 0.0)))
    radius = _BOX_WIDTH if mechanism.joints[joint].prismatic else JOINT_RADIUS
    inside = min(JOINT_LENGTH / 2 / max(along, 1e-9), 0.9 * radius / max(across, 1e-9))
    return np.asarray(start + min(inside * mechanism.size, 0.5 * length) * direction)
