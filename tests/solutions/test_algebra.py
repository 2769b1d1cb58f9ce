"""Test the algebra of model solutions."""

from collections.abc import Callable
from itertools import permutations, product
from typing import Any

import numpy as np
import pytest
import sympy
from dh_grader.catalogue import Exercise
from dh_grader.expressions import read
from dh_grader.expressions.printing import to_text
from dh_grader.kinematics import Convention, pose
from dh_grader.solutions.algebra import (
    Algebra,
    Fixed,
    Motion,
    Shift,
    Turn,
    Writer,
    X,
    Y,
    Z,
    as_angle,
    euler_angles,
    inverse,
    multiplied,
    rotation_about,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tests.together import together

# --- Print SymPy expressions in students' notation

ARM = """
title = "An arm"
source = "made for this test"
statement = "Three joints."
[robot]
structure = "RRP"
convention = "standard"
joints = ["q1", "q2", "q3"]
table = [["a", "0", "0", "q1"], ["b", "0", "0", "q2"], ["0", "0", "q3", "0"]]
[symbols]
a = { kind = "length", description = "a length" }
b = { kind = "length", description = "a length" }
s2 = { kind = "length", description = "takes the shorthand's place" }
phi = { kind = "angle", description = "an angle" }
[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
"""


@pytest.fixture
def arm(make_exercise: Callable[[str], Exercise]) -> Exercise:
    return make_exercise(ARM)


# A formula, and how the model solution prints it.
FORMULAS = {
    "cos(q1 + q2)": "c12",
    "sin(q2)": "sin(q2)",  # s2 is a length here
    "cos(phi)": "cos(phi)",
    "cos(q1 - q2)": "cos(q1 - q2)",
    "-sin(q1)*cos(q2)": "-s1*c2",
    "cos(q1)*a": "a*c1",
    "b*cos(q1+q2) + a*cos(q1)": "a*c1 + b*c12",
    "q3 + a": "a + q3",
    "-a - b": "-a - b",
    "cos(q1)*(-a - b)": "-c1*(a + b)",
    "0.27035 + a": "0.27035 + a",
    "a/3": "a/3",
    "0.25*a": "a/4",
    "1/7": "1/7",
    "1e-3*a": "0.001*a",
    "3*a/2": "3*a/2",
    "sqrt(3)/2*a": "sqrt(3)*a/2",
    "a/sqrt(b)": "a/sqrt(b)",
    "1/a": "1/a",
    "a^2*b": "a^2*b",
    "cos(q1)^2": "c1^2",
    "tan(q1)": "tan(q1)",
    "abs(phi)": "abs(phi)",
    "atan2(a, cos(phi))": "atan2(a, cos(phi))",
    "exp(a)": "exp(a)",
    "acos(a/b)": "acos(a/b)",
    "cos(phi + 0.5)": "cos(phi + (1/2)rad)",
    "cos(phi + 30deg)": "cos(phi + pi/6)",
    "2 - 2*cos(phi)": "2 - 2*cos(phi)",
}


@pytest.mark.parametrize("formula", FORMULAS)
def test_a_formula_is_printed_in_a_textbooks_form(formula: str, arm: Exercise) -> None:
    algebra, writer = Algebra(arm), Writer(arm)
    written = to_text(writer.number(algebra.of(read(formula, arm.vocabulary))))
    assert written == FORMULAS[formula]
    again, first = (algebra.of(read(text, arm.vocabulary)) for text in (written, formula))
    assert sympy.expand(again - first) == 0


ANGLES = {
    "phi + 0.5": "phi + (1/2)rad",
    "phi - 0.7": "phi - 0.7rad",
    "-90deg": "-pi/2",
    "q1 - pi/2": "q1 - pi/2",
    "pi - phi": "pi - phi",
    "0": "0",
}


@pytest.mark.parametrize("formula", ANGLES)
def test_a_printed_angle_means_the_same_in_degrees(formula: str, arm: Exercise) -> None:
    algebra, writer = Algebra(arm), Writer(arm)
    expected = algebra.of(read(formula, arm.vocabulary, quantity="angle"))
    written = to_text(writer.angle(expected))
    assert written == ANGLES[formula]
    for unit in ("radians", "degrees"):
        again = read(written, arm.vocabulary, quantity="angle", angle_unit=unit)
        assert sympy.simplify(algebra.of(again) - expected) == 0


def test_the_meaning_of_each_shorthand_is_recorded(arm: Exercise) -> None:
    algebra, writer = Algebra(arm), Writer(arm)
    writer.number(algebra.of(read("cos(q1 + q2) + sin(q1)", arm.vocabulary)))
    assert writer.used == {"c12": "cos(q1 + q2)", "s1": "sin(q1)"}


# --- Symbolic products of motions equal numeric products

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


# --- Compare formulas of Euler angles with SciPy

AXES = {"X": X, "Y": Y, "Z": Z}
TAIT_BRYAN = ["".join(letters) for letters in permutations("XYZ")]
PROPER = [a + b + a for a, b in permutations("XYZ", 2)]
q1, q2, q3 = sympy.symbols("q1:4", real=True)
AT = {q1: 0.7, q2: -0.4, q3: 1.9}
CHAINS: dict[str, list[Motion]] = {
    "general": [Turn(X, q1), Turn(Y, q2), Turn(X, sympy.pi / 6), Turn(Z, q3)],
    "planar": [Turn(Z, q1), Turn(Z, q2)],
    "planar, turned over": [Turn(Z, q1), Turn(X, sympy.pi)],
    "two axes": [Turn(Z, q1), Turn(Y, q2), Turn(X, sympy.pi / 2)],
}


@pytest.mark.long
@together("axes", ["moving", "fixed"])
@together("chain", CHAINS)
@together("sequence", TAIT_BRYAN + PROPER)
def test_the_angles_give_the_rotation(sequence: str, chain: str, axes: str) -> None:
    expected = np.eye(3)
    for motion in CHAINS[chain]:
        assert isinstance(motion, Turn)
        letter = next(name for name, axis in AXES.items() if axis == motion.axis)
        turn = Rotation.from_euler(letter, float(motion.angle.subs(AT)))
        expected = expected @ turn.as_matrix()
    angles = euler_angles(CHAINS[chain], sequence, axes)
    numbers = [float(angle.subs(AT)) for angle in angles]
    # In SciPy, lower case letters mean fixed axes.
    name = sequence if axes == "moving" else sequence.lower()
    found = Rotation.from_euler(name, numbers).as_matrix()
    np.testing.assert_allclose(found, expected, atol=1e-12)


def test_turns_in_the_requested_sequence_keep_their_angles() -> None:
    wrist: list[Motion] = [Turn(Z, q1), Turn(Y, -q2), Turn(Z, q3 + sympy.pi / 2)]
    assert euler_angles(wrist, "ZYZ", "moving") == (q1, -q2, q3 + sympy.pi / 2)


@pytest.mark.parametrize(
    ("sign", "other", "quarter"), list(product([1, -1], [1, -1], [0, sympy.pi / 2]))
)
def test_an_angle_is_found_from_its_sine_and_cosine(
    sign: int, other: int, quarter: sympy.Expr
) -> None:
    sine, cosine = sign * sympy.sin(q1 + quarter), other * sympy.cos(q1 + quarter)
    found = as_angle(sine, cosine)
    assert not found.has(sympy.atan2)
    assert (sympy.sin(found), sympy.cos(found)) == (sine, cosine)


def test_other_sines_and_cosines_give_an_atan2() -> None:
    assert as_angle(q1, q2) == sympy.atan2(q1, q2)
