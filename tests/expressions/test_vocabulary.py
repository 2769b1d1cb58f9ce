"""Test vocabularies: the symbols that an exercise declares."""

import pytest
from dh_grader.expressions import Symbol, Vocabulary, joint_variable
from dh_grader.expressions.vocabulary import normal_form


@pytest.mark.parametrize(
    "name", ["theta1", "q1", "θ1", "θ_1", "θ₁", r"\theta_{1}", "theta_1", "q_{1}"]
)
def test_a_symbol_is_found_by_all_its_names(name: str) -> None:
    symbol = joint_variable(1)
    assert Vocabulary([symbol]).by_name.get(normal_form(name)) is symbol


def test_an_unknown_name_is_not_found() -> None:
    assert Vocabulary([joint_variable(1)]).by_name.get(normal_form("q2")) is None


def test_a_greek_alias_is_found_by_its_ascii_name() -> None:
    symbol = Symbol("a", "angle", aliases=("φ_{12}",))
    assert Vocabulary([symbol]).by_name.get(normal_form("phi12")) is symbol


@pytest.mark.parametrize(
    "symbols",
    [
        [Symbol("a", "length"), Symbol("a", "number")],
        [Symbol("l1", "length"), Symbol("l_1", "length")],
        [joint_variable(1), Symbol("q1", "number")],
        [joint_variable(1), Symbol("θ₁x", "number")],
        [joint_variable(1), Symbol("x", "number", ("θ₁",))],
        [joint_variable(3, sliding=True), Symbol("d3", "length")],
        [joint_variable(1), Symbol("w1", "angle", joint=1)],
        [Symbol("sin", "number")],
        [Symbol("p", "number", ("π",))],
        [Symbol("1a", "number")],
        [Symbol("a", "number", ("b c",))],
        [Symbol("", "number")],
    ],
)
def test_clashing_or_unusable_names_are_refused(symbols: list[Symbol]) -> None:
    with pytest.raises(ValueError, match=r"name|joint"):
        Vocabulary(symbols)


def test_vocabularies_with_the_same_symbols_are_equal() -> None:
    one, other = Vocabulary([joint_variable(1)]), Vocabulary([joint_variable(1)])
    assert one == other
    assert hash(one) == hash(other)
    assert one != Vocabulary([joint_variable(2)])
    assert one != "vocabulary"


def test_a_symbol_is_known_by_its_canonical_name() -> None:
    # Formulas name their symbols so.
    arm = Symbol("l_arm", "length")
    assert Vocabulary([arm]).by_name["l_arm"] is arm
