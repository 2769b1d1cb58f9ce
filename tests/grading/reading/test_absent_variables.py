"""Test joint variables that a robot does not have."""

import pytest
from dh_grader.expressions import ExpressionError, Symbol, Vocabulary, joint_variable, read
from dh_grader.grading.reading.entries import joint_counted, with_absent_variables

# An RPR arm with a length that has the usual name of a joint variable.
WORDS = Vocabulary(
    [
        joint_variable(1),
        joint_variable(2, sliding=True),
        joint_variable(3),
        Symbol("d3", "length"),
    ]
)
TURNING = Vocabulary([joint_variable(1), joint_variable(2)])


@pytest.mark.parametrize(
    ("text", "name", "joint"),
    [
        ("theta2", "theta2", 2),
        ("θ_2*", "theta2", 2),
        ("th0", "theta0", 0),
        ("q0", "theta0", 0),
        ("d1 + 2", "d1", 1),
    ],
)
def test_names(text: str, name: str, joint: int) -> None:
    with pytest.raises(ExpressionError):
        read(text, WORDS)
    assert read(text, with_absent_variables(WORDS)).symbols == {name}
    assert joint_counted(name) == joint


@pytest.mark.parametrize("text", ["q1", "d2", "q2", "d3", "theta3"])
def test_declared_names_keep_their_meaning(text: str) -> None:
    assert read(text, with_absent_variables(WORDS)).symbols == read(text, WORDS).symbols


@pytest.mark.parametrize("text", ["theta4", "c2", "c0", "theta12"])
def test_other_names_stay_unknown(text: str) -> None:
    with pytest.raises(ExpressionError):
        read(text, with_absent_variables(WORDS))


def test_d1_is_a_length_if_no_joint_slides() -> None:
    with pytest.raises(ExpressionError):
        read("d1", with_absent_variables(TURNING))


def test_without_joints_nothing_is_absent() -> None:
    words = Vocabulary([Symbol("l1", "length")])
    assert with_absent_variables(words) is words
