"""The axis directions of simple robots, determined by the robot's number."""

# There are few simple robots: of 500 random robots, 100 are like an earlier robot. So the number of
# a simple robot determines its directions, and only the rest is random.

from dataclasses import dataclass
from functools import cache
from itertools import product
from math import gcd
from typing import Final

from service.variants.robots.level import Grammar

AxisDirection = tuple[int, int, int]
_AXES: Final[tuple[AxisDirection, ...]] = (
    (1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1),
)  # fmt: skip
# A step through all numbers, which leads far from similar ones.
_STEP: Final = 377
# How far to go if some directions make no robot. It has no divisor in common with the number of
# all directions of a level, and the first 500 seeds get different robots with it.
DIFFERENT: Final = 711


@dataclass(frozen=True, slots=True)
class Skeleton:
    """The joints of a robot, and the directions of its axes and of the tool's x axis."""

    # The directions of the axes 2 to n, at home. ``beside`` is True if the tool is not on the last
    # axis.

    sliding: tuple[bool, ...]
    headings: tuple[AxisDirection, ...]
    tool_x: AxisDirection
    beside: bool


def skeleton(level: Grammar, number: int) -> Skeleton | None:
    """Return the skeleton (joints and axis directions) with this number, or None."""
    # Numbers after the last skeleton repeat the skeletons. None if two consecutive sliding joints
    # would be parallel.
    sizes = _sizes(level)
    total = sum(size for _, size in sizes)
    step = next(each for each in range(_STEP, total + _STEP) if gcd(each, total) == 1)
    left = number * step % total
    for sliding, size in sizes:
        if left < size:
            return _decoded(sliding, left)
        left -= size
    raise AssertionError("the sizes add up to more than their sum")


@cache
def _patterns(joints: int, most_sliding: int) -> tuple[tuple[bool, ...], ...]:
    return tuple(
        each for each in product((False, True), repeat=joints) if sum(each) <= most_sliding
    )


def _sizes(level: Grammar) -> list[tuple[tuple[bool, ...], int]]:
    return [
        (sliding, 5 ** (joints - 1) * 4 * (1 if sliding[-1] else 2))
        for joints, _ in level.joints
        for sliding in _patterns(joints, level.most_sliding)
    ]


def _decoded(sliding: tuple[bool, ...], left: int) -> Skeleton | None:
    headings: list[AxisDirection] = []
    here: AxisDirection = (0, 0, 1)
    for i in range(1, len(sliding)):
        left, digit = divmod(left, 5)
        if digit == 4:
            if sliding[i - 1] and sliding[i]:
                return None
        else:
            here = perpendicular(here)[digit]
        headings.append(here)
    left, digit = divmod(left, 4)
    return Skeleton(sliding, tuple(headings), perpendicular(here)[digit], beside=bool(left))


def perpendicular(direction: AxisDirection) -> list[AxisDirection]:
    """Return the four directions perpendicular to ``direction``, in a fixed order."""
    return [each for each in _AXES if not any(a * b for a, b in zip(each, direction, strict=True))]


def cross(first: AxisDirection, second: AxisDirection) -> AxisDirection:
    """Return the vector product of two directions."""
    a, b, c = first
    d, e, f = second
    return b * f - c * e, c * d - a * f, a * e - b * d


def turn(start: AxisDirection, end: AxisDirection, about: AxisDirection) -> int:
    """Return the angle in degrees from one direction to another about a third direction."""
    # Both directions are at a right angle to ``about``.
    if start == end:
        return 0
    across = cross(about, start)
    if end == across:
        return 90
    return -90 if end == (-across[0], -across[1], -across[2]) else 180
