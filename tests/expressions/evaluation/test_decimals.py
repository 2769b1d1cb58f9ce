"""Find the rounded decimals in a formula."""

import numpy as np
import pytest
from dh_grader.expressions import Vocabulary, decimals_of, joint_variable, read

ARM = Vocabulary([joint_variable(1)])


@pytest.mark.parametrize(
    ("text", "units"),
    [
        ("1.57", [0.01]),
        ("0.100", [0.001]),
        ("0.0505", [0.0001]),
        ("1.57e-2", [0.0001]),
        ("q1 + 1.5708", [0.0001]),
        ("0.866 c1 + 2.50 s1", [0.001, 0.01]),
        ("1.6", []),
        ("0.05", []),
        ("0.000", []),
        ("57", []),
        ("1000", []),
        ("1000.", []),
        ("1e-3", []),
    ],
)
def test_the_unit_of_a_decimal_is_one_in_its_last_place(text: str, units: list[float]) -> None:
    assert decimals_of(read(text, ARM)).units == pytest.approx(units)


def test_a_shift_moves_a_decimal_by_units() -> None:
    decimals = decimals_of(read("2*cos(q1) + 0.125*q1 - 57.3deg", ARM))
    q1 = np.array([0.0, 1.0])
    found = decimals.shifted(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, -0.5]]), {"theta1": q1})
    written = 2 * np.cos(q1) + 0.125 * q1 - np.radians(57.3)
    assert found[0] == pytest.approx(written)
    assert found[1] == pytest.approx(written + 0.001 * q1)
    assert found[2] == pytest.approx(written + np.radians(0.05))


@pytest.mark.parametrize(
    ("text", "sign"),
    [
        ("1.571", 1), ("-1.571", -1), ("(1.571)", 1), ("1.571 + 0", 0), ("2*1.571", 0),
        ("1.571*q1", 0), ("sin(1.571)", 0), ("90.0deg", 0), ("1.57 + 1.57", 0), ("q1", 0),
    ],
)  # fmt: skip
def test_only_a_single_decimal_has_a_sign(text: str, sign: int) -> None:
    assert decimals_of(read(text, ARM)).sign == sign
