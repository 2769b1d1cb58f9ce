"""Compare formulas of Euler angles with SciPy."""

from itertools import permutations, product

import numpy as np
import pytest
import sympy
from dh_grader.solutions.algebra import Motion, Turn, X, Y, Z, as_angle, euler_angles
from scipy.spatial.transform import Rotation

from tests.together import together

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
