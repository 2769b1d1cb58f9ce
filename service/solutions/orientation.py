"""Euler angles as formulas.

If the turns already have the requested sequence, their own angles are returned. Otherwise the
angles are atan2 of matrix entries.
"""

# The ZYZ angles of a spherical wrist are its joint angles.

from collections.abc import Iterable
from itertools import product

import sympy

from service.solutions.motions import (
    Motion,
    Normal,
    X,
    Y,
    Z,
    multiplied,
    normalised,
    rotation_about,
)

Angles = tuple[sympy.Expr, sympy.Expr, sympy.Expr]

_AXES = {"X": X, "Y": Y, "Z": Z}
_QUARTERS = (0, sympy.pi / 2, sympy.pi, -sympy.pi / 2)


def euler_angles(motions: Iterable[Motion], sequence: str, axes: str) -> Angles:
    """Return the Euler angles, in a sequence such as "ZYZ", of the product of ``motions``.

    ``axes`` is "moving" or "fixed".
    """
    # Turns about fixed axes equal turns about moving axes in reverse order.
    steps = list(motions)
    if axes == "fixed":
        first, second, third = euler_angles(steps, sequence[::-1], "moving")
        return third, second, first
    direct = _own_angles(normalised(steps), sequence)
    return direct or _by_entries(multiplied(steps).rotation, sequence)


def _own_angles(normal: Normal, sequence: str) -> Angles | None:
    # None if the turns do not fit the sequence.
    angles = [sympy.S.Zero] * 3
    at = 0
    for turn, _ in normal.turns:
        while at < 3 and _AXES[sequence[at]] != turn.axis:
            at += 1
        if at == 3:
            return None
        angles[at] += turn.angle
    for quarters in product(*[(0,)] * at, *[_QUARTERS] * (3 - at)):
        rotation = sympy.eye(3)
        for letter, angle in zip(sequence, quarters, strict=True):
            rotation *= rotation_about(_AXES[letter], angle)
        if rotation == normal.end:
            first, second, third = (a + b for a, b in zip(angles, quarters, strict=True))
            return first, second, third
    return None


def _by_entries(rotation: sympy.Matrix, sequence: str) -> Angles:
    # The second angle is in [0, π] or in [−π/2, π/2]. Source: Spong, Hutchinson, Vidyasagar, *Robot
    # Modeling and Control*, §2.5.1 for ZYZ and §2.5.2 for ZYX. The other sequences follow by
    # renaming the axes, with a sign if the renamed frame is left-handed.
    i, j = map("XYZ".index, sequence[:2])
    k = 3 - i - j
    sign = 1 if (j - i) % 3 == 1 else -1
    R = rotation
    if sequence[0] == sequence[2]:
        return (
            sympy.atan2(R[j, i], -sign * R[k, i]),
            sympy.atan2(sympy.sqrt(R[i, j] ** 2 + R[i, k] ** 2), R[i, i]),
            sympy.atan2(R[i, j], sign * R[i, k]),
        )
    return (
        sympy.atan2(-sign * R[j, k], R[k, k]),
        sympy.atan2(sign * R[i, k], sympy.sqrt(R[i, i] ** 2 + R[i, j] ** 2)),
        sympy.atan2(-sign * R[i, j], R[i, i]),
    )


def as_angle(sine: sympy.Expr, cosine: sympy.Expr) -> sympy.Expr:
    """Return the angle with this sine and cosine: φ for sin φ and cos φ, else an atan2."""
    found = sine.atoms(sympy.sin, sympy.cos) | cosine.atoms(sympy.sin, sympy.cos)
    arguments = sorted((call.args[0] for call in found), key=str)
    for argument, quarter, sign in product((sympy.S.Zero, *arguments), _QUARTERS, (1, -1)):
        angle = quarter + sign * argument
        if sympy.sin(angle) == sine and sympy.cos(angle) == cosine:
            return angle
    return sympy.atan2(sine, cosine)
