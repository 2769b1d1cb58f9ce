"""URDF files of random arms, and their kinematics by quaternions."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]


@dataclass(frozen=True)
class Part:
    """A joint of a URDF file."""

    kind: str
    xyz: Sequence[float]
    rpy: Sequence[float]
    axis: Sequence[float] = (0, 0, 1)


def urdf(parts: Sequence[Part], decimals: int = 9) -> bytes:
    """Return the URDF file of a chain of joints."""

    def words(numbers: Sequence[float]) -> str:
        return " ".join(f"{number:.{decimals}f}" for number in numbers)

    links = "".join(f'<link name="l{i}"/>' for i in range(len(parts) + 1))
    joints = "".join(
        f'<joint name="j{i}" type="{part.kind}"><parent link="l{i}"/><child link="l{i + 1}"/>'
        f'<origin xyz="{words(part.xyz)}" rpy="{words(part.rpy)}"/>'
        f'<axis xyz="{words(part.axis)}"/></joint>'
        for i, part in enumerate(parts)
    )
    return f'<?xml version="1.0"?><robot name="arm">{links}{joints}</robot>'.encode()


def quaternion(axis: Sequence[float], angle: float) -> Numbers:
    """Return the quaternion (w, x, y, z) of a rotation about an axis."""
    unit = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    return np.array([np.cos(angle / 2), *(np.sin(angle / 2) * unit)])


def times(p: Numbers, q: Numbers) -> Numbers:
    """Return the product of two quaternions."""
    w = p[0] * q[0] - p[1:] @ q[1:]
    return np.array([w, *(p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:]))])


def turned(q: Numbers, vector: Sequence[float]) -> Numbers:
    """Return a vector rotated by a quaternion."""
    conjugate = q * [1, -1, -1, -1]
    return times(times(q, np.array([0.0, *vector])), conjugate)[1:]


def tip(parts: Sequence[Part], values: Sequence[float]) -> tuple[Numbers, Numbers]:
    place, turn = np.zeros(3), np.array([1.0, 0, 0, 0])
    left = list(values)
    for part in parts:
        place = place + turned(turn, part.xyz)
        for axis, angle in zip(np.eye(3)[::-1], reversed(part.rpy), strict=True):
            turn = times(turn, quaternion(axis, angle))
        if part.kind == "prismatic":
            unit = np.asarray(part.axis) / np.linalg.norm(part.axis)
            place = place + turned(turn, left.pop(0) * unit)
        elif part.kind != "fixed":
            turn = times(turn, quaternion(part.axis, left.pop(0)))
    return place, turn


def random_parts(rng: np.random.Generator, *, crooked: bool) -> list[Part]:
    """Return a random arm with 2 to 7 moving joints."""
    parts = []
    for _ in range(rng.integers(2, 8)):
        if rng.random() < 0.3:
            parts.append(Part("fixed", _place(rng), _turn(rng, crooked=crooked)))
        kind = "prismatic" if rng.random() < 0.2 else rng.choice(["revolute", "continuous"])
        axis = rng.permutation([0, 0, rng.choice([-1, 1])])
        if crooked and rng.random() < 0.5:
            axis = rng.normal(size=3)
        parts.append(Part(str(kind), _place(rng), _turn(rng, crooked=crooked), list(axis)))
    parts.append(Part("fixed", _place(rng), _turn(rng, crooked=crooked)))
    return parts


def _place(rng: np.random.Generator) -> list[float]:
    return list(np.round(rng.uniform(-0.6, 0.6, 3) * (rng.random(3) < 0.5), 3))


def _turn(rng: np.random.Generator, *, crooked: bool) -> list[float]:
    if crooked and rng.random() < 0.4:
        return list(np.round(rng.uniform(-3, 3, 3), 4))
    return list(rng.integers(-2, 3, 3) * np.pi / 2)
