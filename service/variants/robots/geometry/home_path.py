"""The path of a generated robot's links, as its figure draws them."""

# Sliding joints are extended. The module uses plain floats and a table of sines, so that every
# machine refuses the same robots.

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from service.variants.robots.plan import PlannedRow

HomePoint = tuple[float, float, float]
# The range of a sliding joint's variable in centimetres, and its share that figures draw.
SLIDE: Final = (10, 60)
_EXTENDED: Final = 30.0
_SINES: Final = {0: 0.0, 30: 0.5, 45: 0.707106781, 60: 0.866025404, 90: 1.0}


@dataclass(frozen=True, slots=True)
class HomePath:
    """The corners of the path from the base to the tool, in centimetres."""

    # Consecutive corners differ.

    corners: tuple[HomePoint, ...]

    @property
    def pieces(self) -> list[tuple[HomePoint, HomePoint]]:
        """The line segments of the path."""
        return list(pairwise(self.corners))


def home_path(rows: Sequence[PlannedRow]) -> HomePath:
    """Return the path of a robot through the origins of its frames."""
    # It follows z, then x of each row.
    here: HomePoint = (0.0, 0.0, 0.0)
    x: HomePoint = (1.0, 0.0, 0.0)
    y: HomePoint = (0.0, 1.0, 0.0)
    z: HomePoint = (0.0, 0.0, 1.0)
    corners = [here]
    for row in rows:
        x, y = _turned(x, y, row.theta)
        for step, way in ((row.d + (_EXTENDED if row.sliding else 0.0), z), (float(row.a), x)):
            if step:
                here = _sum(here, _scaled(way, step))
                corners.append(here)
        y, z = _turned(y, z, row.alpha)
    return HomePath(tuple(corners))


def cosine_sine(degrees: int) -> tuple[float, float]:
    """Return the cosine and the sine of an angle in degrees, with 9 decimals."""
    # Only angles that robots have are in the table.
    return _sine(degrees + 90), _sine(degrees)


def _sine(degrees: int) -> float:
    turn = degrees % 360
    sign, turn = (-1.0, turn - 180) if turn >= 180 else (1.0, turn)
    return sign * _SINES[min(turn, 180 - turn)]


def _turned(first: HomePoint, second: HomePoint, degrees: int) -> tuple[HomePoint, HomePoint]:
    c, s = cosine_sine(degrees)
    return (
        _sum(_scaled(first, c), _scaled(second, s)),
        _sum(_scaled(second, c), _scaled(first, -s)),
    )


def _scaled(vector: HomePoint, factor: float) -> HomePoint:
    return vector[0] * factor, vector[1] * factor, vector[2] * factor


def _sum(first: HomePoint, second: HomePoint) -> HomePoint:
    return first[0] + second[0], first[1] + second[1], first[2] + second[2]


def difference(first: HomePoint, second: HomePoint) -> HomePoint:
    """Return ``first - second``."""
    return first[0] - second[0], first[1] - second[1], first[2] - second[2]


def dot(first: HomePoint, second: HomePoint) -> float:
    """Return the scalar product of two vectors."""
    return first[0] * second[0] + first[1] * second[1] + first[2] * second[2]


def gap(one: tuple[HomePoint, HomePoint], other: tuple[HomePoint, HomePoint]) -> float:
    """Return the distance between two line segments."""
    # Source: Ericson, *Real-Time Collision Detection*, §5.1.9.
    u, v = difference(one[1], one[0]), difference(other[1], other[0])
    w = difference(one[0], other[0])
    a, e, b, c, f = dot(u, u), dot(v, v), dot(u, v), dot(u, w), dot(v, w)
    parting = a * e - b * b
    s = _clamped((b * f - c * e) / parting) if parting > 1e-6 * a * e else 0.0
    t = (b * s + f) / e
    if not 0.0 <= t <= 1.0:
        t = _clamped(t)
        s = _clamped((b * t - c) / a)
    apart = difference(_sum(one[0], _scaled(u, s)), _sum(other[0], _scaled(v, t)))
    return float(dot(apart, apart) ** 0.5)


def _clamped(share: float) -> float:
    return min(max(share, 0.0), 1.0)


def seen(
    points: Sequence[HomePoint], azimuth: int, elevation: int
) -> Iterator[tuple[float, float]]:
    """Yield the coordinates of points in a view, to the right and upwards."""
    # These are the coordinates of ``service/figures/geometry/view.py``.
    ca, sa, ce, se = _VIEWS[azimuth, elevation]
    for px, py, pz in points:
        yield ca * py - sa * px, ce * pz - se * (ca * px + sa * py)


# Views as (azimuth, elevation), the best ones first: cos and sin of each, with 9 decimals.
_VIEWS: Final = {
    (-60, 25): (0.5, -0.866025404, 0.906307787, 0.422618262),
    (30, 25): (0.866025404, 0.5, 0.906307787, 0.422618262),
    (-50, 30): (0.64278761, -0.766044443, 0.866025404, 0.5),
    (40, 30): (0.766044443, 0.64278761, 0.866025404, 0.5),
    (-35, 20): (0.819152044, -0.573576436, 0.939692621, 0.342020143),
    (55, 20): (0.573576436, 0.819152044, 0.939692621, 0.342020143),
    (-70, 35): (0.342020143, -0.939692621, 0.819152044, 0.573576436),
    (20, 35): (0.939692621, 0.342020143, 0.819152044, 0.573576436),
    (125, 25): (-0.573576436, 0.819152044, 0.906307787, 0.422618262),
    (-145, 25): (-0.819152044, -0.573576436, 0.906307787, 0.422618262),
}
VIEWS: Final = tuple(_VIEWS)
