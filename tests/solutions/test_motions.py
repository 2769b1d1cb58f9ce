"""Symbolic products of motions equal numeric products."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import sympy
from dh_grader.kinematics import Convention, pose
from dh_grader.solutions.algebra import (
    Fixed,
    Motion,
    Shift,
    Turn,
    X,
    Y,
    Z,
    inverse,
    multiplied,
    rotation_about,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

Numbers = NDArray[np.float64]

Q = sympy.symbols("q1:8", real=True)
TWISTS = [sympy.S.Zero, sympy.pi / 2, -sympy.pi / 2, sympy.pi, sympy.pi / 6, sympy.Rational(2, 5)]
OFFSETS = [sympy.S.Zero, sympy.pi / 2, -sympy.pi, sympy.pi / 3, sympy.Rational(1, 4)]
LENGTHS = [sympy.S.Zero, sympy.Rational(1, 2), sympy.Rational(-3, 10)]

rows = st.tuples(
    st.sampled_from(LENGTHS),
    st.sampled_from(TWISTS),
    st.sampled_from(LENGTHS),
    st.sampled_from(OFFSETS),
    st.booleans(),
)


def motions_of(table: list[Any], convention: Convention) -> list[Motion]:
    found: list[Motion] = []
    for (a, alpha, d, theta, slides), q in zip(table, Q, strict=False):
        z: list[Motion] = [
            Turn(Z, theta + (0 if slides else q)),
            Shift((d + (q if slides else 0)) * Z),
        ]
        x: list[Motion] = [Shift(a * X), Turn(X, alpha)]
        found += z + x if convention is Convention.STANDARD else x + z
    return found


def numbers_of(table: list[Any], at: list[float]) -> Numbers:
    result = np.empty((len(table), 4, 1))
    for i, ((a, alpha, d, theta, slides), q) in enumerate(zip(table, at, strict=False)):
        result[i, :, 0] = [a, alpha, d + (q if slides else 0), theta + (0 if slides else q)]
    return result


def value(matrix: sympy.Matrix, at: list[float]) -> Numbers:
    found: Callable[..., Any] = sympy.lambdify(Q, matrix, "numpy")
    return np.asarray(found(*at), dtype=np.float64)


@pytest.mark.long
@pytest.mark.parametrize("convention", Convention)
@settings(max_examples=15)
@given(
    table=st.lists(rows, min_size=1, max_size=6),
    at=st.lists(st.floats(-3, 3), min_size=7, max_size=7),
)
def test_the_pose_of_a_chain_equals_the_numeric_pose(
    convention: Convention, table: list[Any], at: list[float]
) -> None:
    symbolic = multiplied(motions_of(table, convention)).matrix()
    expected = pose(numbers_of(table, at), convention)[0]
    np.testing.assert_allclose(value(symbolic, at), expected, atol=1e-12)


@pytest.mark.long
@settings(max_examples=15)
@given(
    table=st.lists(rows, min_size=1, max_size=4),
    at=st.lists(st.floats(-3, 3), min_size=7, max_size=7),
)
def test_the_inverse_undoes_the_motions(table: list[Any], at: list[float]) -> None:
    motions = motions_of(table, Convention.STANDARD)
    there, back = (value(multiplied(m).matrix(), at) for m in (motions, inverse(motions)))
    np.testing.assert_allclose(there @ back, np.eye(4), atol=1e-12)


def test_angles_about_parallel_axes_are_added() -> None:
    arm: list[Motion] = [Turn(Z, Q[0]), Shift(X), Turn(Z, Q[1]), Shift(X)]
    found = multiplied([*arm, Turn(X, sympy.pi), Turn(Z, Q[2])])
    assert found.rotation[0, 0] == sympy.cos(Q[0] + Q[1] - Q[2])
    assert found.position[0] == sympy.cos(Q[0]) + sympy.cos(Q[0] + Q[1])


def test_a_turn_and_its_inverse_cancel() -> None:
    found = multiplied([Turn(Y, Q[0]), Shift(Y), Turn(-Y, Q[0])])
    assert found.rotation == sympy.eye(3)
    assert list(found.position) == [0, 1, 0]


def test_a_fixed_rotation_is_applied_at_its_place() -> None:
    quarter = rotation_about(Z, sympy.pi / 2)
    found = multiplied([Fixed(quarter), Shift(X), Turn(X, Q[0]), Fixed(quarter.T)])
    assert list(found.position) == [0, 1, 0]
    assert found.rotation == rotation_about(Y, Q[0])


def test_a_turn_about_a_slanted_axis_keeps_the_axis() -> None:
    slant = sympy.ImmutableMatrix([0, sympy.Rational(3, 5), sympy.Rational(4, 5)])
    found = multiplied([Turn(slant, Q[0])]).rotation
    assert list(found * slant) == [0, sympy.Rational(3, 5), sympy.Rational(4, 5)] or np.allclose(
        value(found, [0.3] * 7) @ [0, 0.6, 0.8], [0, 0.6, 0.8]
    )
    np.testing.assert_allclose(np.trace(value(found, [0.3] * 7)), 1 + 2 * np.cos(0.3))
