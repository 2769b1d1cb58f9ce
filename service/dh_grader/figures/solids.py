"""Draw the parts of a mechanism as outlines: cylinders, boxes, rods, a gripper, the ground."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from dh_grader.figures.mechanism import View
from dh_grader.kinematics import Numbers

_FLAT = 1e-9


@dataclass(frozen=True, slots=True)
class Camera:
    """The projection of points in the base frame to the picture: x to the right, y down."""

    rotation: Numbers
    scale: float

    @classmethod
    def of(cls, view: View, scale: float) -> "Camera":
        """Return the camera of a view, with ``scale`` pixels per unit of length."""
        return cls(view.rotation, scale)

    @property
    def towards(self) -> Numbers:
        """The direction ``(3,)`` towards the viewer."""
        return np.asarray(self.rotation[2])

    def seen(self, points: Numbers) -> Numbers:
        """Project points ``(..., 3)`` to the picture, ``(..., 2)``."""
        flat = (points @ self.rotation.T)[..., :2]
        return np.asarray(flat * [self.scale, -self.scale])

    def nearness(self, points: Numbers) -> Numbers:
        """Return how near points ``(..., 3)`` are to the viewer, in pixels."""
        return np.asarray(points @ self.rotation[2] * self.scale)


@dataclass(frozen=True, slots=True)
class Solid:
    """A drawn part of a mechanism: its SVG and its place.

    The part is within ``radius`` pixels of the points ``spine``.
    """

    # Parts nearer to the viewer are drawn later. ``spine`` is ``(points, 3)``.
    svg: str
    spine: Numbers
    radius: float


def numbers(*values: float) -> str:
    """Return coordinates in the notation of SVG."""
    return " ".join(f"{value + 0.0:.2f}".rstrip("0").rstrip(".") for value in values)


def points_text(points: Numbers) -> str:
    """Return points ``(points, 2)`` in the notation of SVG."""
    return " ".join(f"{numbers(x)},{numbers(y)}" for x, y in points.tolist())


def polygon(points: Numbers, kind: str) -> str:
    """Return the SVG of a closed outline."""
    return f'<polygon class="{kind}" points="{points_text(points)}"/>'


def polyline(points: Numbers, kind: str, width: float | None = None) -> str:
    """Return the SVG of an open line. ``width`` is in pixels; None if the style sheet sets it."""
    stroke = "" if width is None else f' stroke-width="{numbers(width)}"'
    return f'<polyline class="{kind}" points="{points_text(points)}"{stroke}/>'


def perpendicular(direction: Numbers, wanted: Numbers) -> Numbers:
    """Return the unit vector perpendicular to ``direction`` that is nearest to ``wanted``."""
    across = wanted - direction * (direction @ wanted)
    size = np.linalg.norm(across)
    if size > 1e-6:
        return np.asarray(across / size)
    return perpendicular(direction, np.roll(wanted, 1) + np.array([0.1, 0.0, 0.0]))


def cylinder(
    camera: Camera, centre: Numbers, axis: Numbers, half: float, radius: float, fill: str
) -> Solid:
    """Return a revolute joint, drawn as a cylinder about its axis."""
    # ``fill`` is the id of its gradient.
    spine = np.linspace(centre - half * axis, centre + half * axis, 9)
    near = axis if axis @ camera.towards >= 0 else -axis
    tilt = float(near @ camera.towards)
    top, bottom = camera.seen(np.array([centre + half * near, centre - half * near]))
    flat = camera.seen(near)
    flat = flat / max(float(np.linalg.norm(flat)), _FLAT)
    across = np.array([-flat[1], flat[0]])
    r = radius * camera.scale
    sides = [top + r * across, bottom + r * across, bottom - r * across, top - r * across]
    turn = np.degrees(np.arctan2(across[1], across[0]))
    arc = f"A {numbers(r, r * tilt, turn)} 0 1"
    one, two, three, four = (numbers(*side) for side in sides)
    body = f"M {one} L {two} {arc} {three} L {four} Z"
    cap = (
        f'<ellipse class="cap" cx="{numbers(top[0])}" cy="{numbers(top[1])}" rx="{numbers(r)}" '
        f'ry="{numbers(r * tilt)}" transform="rotate({numbers(turn, *top)})"/>'
    )
    gradient = (
        f'<linearGradient id="{fill}" gradientUnits="userSpaceOnUse" x1="{numbers(sides[0][0])}" '
        f'y1="{numbers(sides[0][1])}" x2="{numbers(sides[3][0])}" y2="{numbers(sides[3][1])}">'
        '<stop class="shade" offset="0"/><stop class="light" offset="0.35"/>'
        '<stop class="shade" offset="1"/></linearGradient>'
    )
    svg = f'{gradient}<path class="turning" d="{body}" fill="url(#{fill})"/>{cap}'
    return Solid(svg, spine, r)


def box(camera: Camera, centre: Numbers, axis: Numbers, half: float, width: float) -> Solid:
    """Return a prismatic joint, drawn as a box along its axis."""
    # ``half`` is half the length of the box, and ``width`` is half its width.
    one = perpendicular(axis, np.array([0.0, 0.0, 1.0]))
    edges = [axis * half, one * width, np.cross(axis, one) * width]
    faces = []
    for i, normal in enumerate(edges):
        outwards = normal if normal @ camera.towards > 0 else -normal
        u, v = edges[(i + 1) % 3], edges[(i + 2) % 3]
        corners = centre + outwards + np.array([u + v, u - v, -u - v, v - u])
        facing = float(outwards @ camera.towards / np.linalg.norm(outwards))
        if facing > 0.02:
            lit = float(outwards @ np.array([0.0, 0.0, 1.0]) / np.linalg.norm(outwards))
            faces.append((-lit - 0.2 * facing, polygon(camera.seen(corners), "sliding")))
    ordered = [svg for _, svg in sorted(faces)]
    shaded = [
        svg.replace('"sliding"', f'"sliding side{shade}"') for shade, svg in enumerate(ordered)
    ]
    spine = np.linspace(centre - half * axis, centre + half * axis, 9)
    return Solid("".join(shaded), spine, 1.2 * width * camera.scale)


def rod(camera: Camera, corners: Numbers, width: float) -> Solid:
    """Return a link, drawn as a rod along its corners ``(points, 3)``."""
    # ``width`` is in pixels.
    flat = camera.seen(corners)
    svg = polyline(flat, "rim", width + 2.6) + polyline(flat, "rod", width)
    return Solid(svg, along(corners), width / 2)


def along(corners: Numbers, pieces: int = 8) -> Numbers:
    """Return points along each piece of a line ``(points, 3)``, including its corners."""
    found = [np.linspace(a, b, pieces, endpoint=False) for a, b in pairwise(corners)]
    return np.concatenate([*found, corners[-1:]])


def gripper(
    camera: Camera, tool: Numbers, direction: Numbers, length: float, width: float
) -> Solid:
    """Return a gripper whose two fingertips are at the tool point."""
    # It is opened across the picture. ``width`` is the width of its fingers in pixels.
    aside = np.cross(direction, camera.towards)
    size = float(np.linalg.norm(aside))
    aside = perpendicular(direction, camera.rotation[0]) if size < 1e-6 else aside / size
    palm, wide = tool - length * direction, 0.42 * length
    shape = [
        tool + wide * aside,
        palm + 0.45 * length * direction + wide * aside,
        palm + 0.2 * length * direction + wide * aside,
        palm + 0.2 * length * direction - wide * aside,
        palm + 0.45 * length * direction - wide * aside,
        tool - wide * aside,
    ]
    fingers = camera.seen(np.array(shape))
    stem = camera.seen(np.array([palm, palm + 0.2 * length * direction]))
    svg = "".join(
        polyline(line, kind, stroke)
        for kind, stroke in (("grip-rim", width + 2.6), ("grip", width))
        for line in (fingers, stem)
    )
    x, y = camera.seen(tool)
    svg += f'<circle class="point" cx="{numbers(x)}" cy="{numbers(y)}" r="2.6"/>'
    return Solid(svg, np.array([palm, tool]), wide * camera.scale)


def ground(camera: Camera, base: Numbers, normal: Numbers, half: float) -> Solid:
    """Return a piece of ground, hatched below its near edge."""
    right = np.cross(camera.towards, normal)
    size = float(np.linalg.norm(right))
    right = perpendicular(normal, camera.rotation[0]) if size < 1e-6 else -right / size
    near = np.cross(normal, right)
    near = near if near @ camera.towards > 0 else -near
    deep = 0.72 * half
    corners = [half * right + deep * near, deep * near - half * right]
    corners += [-half * right - deep * near, half * right - deep * near]
    outline = camera.seen(base + np.array(corners))
    end, start = outline[0], outline[1]
    down = camera.seen(-normal)
    down = down / max(float(np.linalg.norm(down)), _FLAT)
    step = (end - start) / 8
    stroke = 0.8 * float(np.linalg.norm(step)) * down - 0.7 * step
    strokes = "".join(
        polyline(np.array([start + (i + 0.9) * step, start + (i + 0.9) * step + stroke]), "hatch")
        for i in range(8)
    )
    svg = polygon(outline, "ground") + strokes + polyline(np.array([start, end]), "edge")
    return Solid(svg, base[None], half * camera.scale)


def back_to_front(camera: Camera, solids: Sequence[Solid]) -> list[Solid]:
    """Sort solids for drawing: of two that overlap in the picture, the nearer one comes later."""
    behind: dict[int, set[int]] = {i: set() for i in range(len(solids))}
    shapes = [_Shape.of(camera, solid) for solid in solids]
    for i, one in enumerate(shapes):
        for j in range(i):
            nearer = one.nearer_than(shapes[j])
            if nearer > 0:
                behind[i].add(j)
            elif nearer < 0:
                behind[j].add(i)
    middle = [float(shape.nearness.mean()) for shape in shapes]
    left, found = set(behind), list[int]()
    while left:
        # If solids hide each other in a cycle, the farthest comes first.
        free = [i for i in left if not behind[i] & left] or sorted(left)
        following = min(free, key=lambda i: (middle[i], i))
        found.append(following)
        left.remove(following)
    return [solids[i] for i in found]


@dataclass(frozen=True, slots=True)
class _Shape:
    # ``spine`` is ``(points, 2)``.
    spine: Numbers
    left: float
    top: float
    right: float
    bottom: float
    nearness: Numbers
    radius: float

    @classmethod
    def of(cls, camera: Camera, solid: Solid) -> "_Shape":
        spine = camera.seen(solid.spine)
        left, top = spine.min(axis=0).tolist()
        right, bottom = spine.max(axis=0).tolist()
        nearness = camera.nearness(solid.spine)
        return cls(spine, left, top, right, bottom, nearness, solid.radius)

    def nearer_than(self, other: "_Shape") -> float:
        # By how much ``self`` is nearer than ``other`` where they overlap; else 0.
        reach = self.radius + other.radius
        # A fast path: most solids are far from each other.
        across = max(self.left - other.right, other.left - self.right)
        if max(across, self.top - other.bottom, other.top - self.bottom) > reach:
            return 0.0
        overlap = np.linalg.norm(self.spine[:, None] - other.spine, axis=-1) < reach
        if not overlap.any():
            return 0.0
        ahead = self.nearness[:, None] - other.nearness
        return float(ahead[overlap].mean())
