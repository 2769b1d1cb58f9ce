"""Compare angles and rotations with SciPy."""

import doctest
from typing import Any

import numpy as np
import pytest
from dh_grader import kinematics as rotations
from dh_grader.kinematics import (
    PROPER,
    SEQUENCES,
    Matrices,
    about,
    composed,
    from_angles,
    is_singular,
    last_angle,
    other_triple,
    to_angles,
)
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.together import together

RNG = np.random.default_rng(4)
ANGLES = RNG.uniform(-np.pi, np.pi, (40, 3))


def scipy_rotation(sequence: str, angles: object, fixed: bool) -> Matrices:
    # Return SciPy's rotation; SciPy uses upper case for moving and lower case for fixed axes.
    name = sequence.lower() if fixed else sequence
    return np.asarray(Rotation.from_euler(name, np.asarray(angles)).as_matrix())


def scipy_angles(sequence: str, rotation: Matrices, fixed: bool) -> Matrices:
    name: Any = sequence.lower() if fixed else sequence
    return np.asarray(Rotation.from_matrix(rotation).as_euler(name))


def test_the_examples_in_docstrings_are_right() -> None:
    assert doctest.testmod(rotations).attempted >= 5
    assert doctest.testmod(rotations).failed == 0


def test_there_are_twelve_sequences() -> None:
    assert len(set(SEQUENCES)) == 12
    assert all(a != b != c for a, b, c in SEQUENCES)


@together("fixed", [False, True])
@together("sequence", SEQUENCES)
def test_the_rotation_of_a_triple_is_scipys(sequence: str, fixed: bool) -> None:
    np.testing.assert_allclose(
        from_angles(sequence, ANGLES, fixed=fixed),
        scipy_rotation(sequence, ANGLES, fixed),
        atol=1e-14,
    )


@together("fixed", [False, True])
@together("sequence", SEQUENCES)
def test_both_triples_describe_the_rotation(sequence: str, fixed: bool) -> None:
    rotation = scipy_rotation(sequence, ANGLES, fixed)
    one = to_angles(sequence, rotation, fixed=fixed)
    other = other_triple(sequence, one)
    for triple in (one, other):
        np.testing.assert_allclose(scipy_rotation(sequence, triple, fixed), rotation, atol=1e-12)
    assert (np.abs(np.exp(1j * one) - np.exp(1j * other)).max(axis=-1) > 1e-3).all()
    np.testing.assert_allclose(one, scipy_angles(sequence, rotation, fixed), atol=1e-9)


@together("fixed", [False, True])
@together("sequence", SEQUENCES)
def test_one_outer_angle_is_zero_if_the_outer_axes_coincide(sequence: str, fixed: bool) -> None:
    singular = [0.0, np.pi] if sequence in PROPER else [np.pi / 2, -np.pi / 2]
    for middle in singular:
        rotation = scipy_rotation(sequence, [[0.7, middle, -1.1]], fixed)
        found = to_angles(sequence, rotation, fixed=fixed)
        np.testing.assert_allclose(scipy_rotation(sequence, found, fixed), rotation, atol=1e-12)
        assert found[0, 0 if fixed else 2] == 0.0
        assert is_singular(sequence, rotation, fixed=fixed).all()
    assert not is_singular(sequence, scipy_rotation(sequence, ANGLES, fixed), fixed=fixed).any()


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_the_first_angle_is_free_if_the_outer_axes_coincide(sequence: str) -> None:
    middle = 0.0 if sequence in PROPER else np.pi / 2
    rotation = scipy_rotation(sequence, [[0.7, middle, -1.1]], fixed=False)
    chosen = np.array([[2.5, middle]])
    triple = [[2.5, middle, last_angle(sequence, chosen, rotation)[0]]]
    np.testing.assert_allclose(scipy_rotation(sequence, triple, False), rotation, atol=1e-12)


def test_turns_about_fixed_axes_multiply_from_the_left() -> None:
    # Source: Direct Kinematics (Part 2), §1.5, compared with SciPy's two kinds of sequence.
    turns = [about(axis, ANGLES[:, i]) for i, axis in enumerate("XZY")]
    for fixed in (True, False):
        np.testing.assert_allclose(
            composed([(turn, fixed) for turn in turns]),
            scipy_rotation("XZY", ANGLES, fixed),
            atol=1e-14,
        )


def test_steps_about_fixed_and_moving_axes_can_be_mixed() -> None:
    # A turn about fixed z by φ, moving x by θ and fixed y by ψ is R_y(ψ) R_z(φ) R_x(θ).
    found = composed([(about("Z", 0.3), True), (about("X", 0.5), False), (about("Y", 0.7), True)])
    expected = Rotation.from_euler("YZX", [0.7, 0.3, 0.5]).as_matrix()
    np.testing.assert_allclose(found, expected, atol=1e-15)


@given(
    st.sampled_from(SEQUENCES),
    st.tuples(*[st.floats(-10, 10)] * 3),
    st.booleans(),
)
def test_a_triple_leads_to_its_rotation_and_back(
    sequence: str, angles: tuple[float, float, float], fixed: bool
) -> None:
    rotation = from_angles(sequence, np.array(angles), fixed=fixed)
    back = from_angles(sequence, to_angles(sequence, rotation, fixed=fixed), fixed=fixed)
    np.testing.assert_allclose(back, rotation, atol=3e-7)
