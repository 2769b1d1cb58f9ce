"""Test what holds for all formulas and for random texts."""

import xml.etree.ElementTree as ET
from operator import add, mul, sub

import numpy as np
import pytest
import sympy
from dh_grader.expressions import LIMITS, ExpressionError, Symbol, Vocabulary, joint_variable, read
from dh_grader.expressions.parser import in_degrees
from dh_grader.expressions.printing import to_text
from dh_grader.expressions.vocabulary import (
    Binary,
    Call,
    Negation,
    Node,
    Number,
    Pi,
    SymbolNode,
    Unit,
)
from hypothesis import example, given
from hypothesis import strategies as st

from tests.expressions.corpus_files import ROBOT
from tests.expressions.fuzzing import PIECES, hostile, outcome, seeds, texts
from tests.guards import STALL
from tests.together import together

# --- Test properties that hold for every formula

ARM = Vocabulary(
    [
        joint_variable(1),
        joint_variable(2),
        joint_variable(3, sliding=True),
        Symbol("l1", "length"),
        Symbol("k", "number"),
        Symbol("beta", "angle"),
    ]
)

literals = st.one_of(
    st.integers(0, 999).map(str),
    st.floats(0.001, 1e6).map(repr),
    st.sampled_from([".5", "5.", "1e-3", "2E2"]),
)
numbers = literals.map(lambda literal: Number(float(literal), literal))
leaves = numbers | st.builds(Pi) | st.sampled_from(ARM.symbols).map(SymbolNode)
units = st.builds(Unit, numbers | numbers.map(lambda n: Binary("/", n, Number(2.0, "2"))),
                  st.sampled_from(["deg", "rad"]))  # fmt: skip


def _without_zero_power(tree: Binary) -> Binary:
    # Replace x^0 by x*0, because 90^0 is refused (it may mean 90°).
    is_zero = isinstance(tree.right, Number) and tree.right.value == 0
    return Binary("*", tree.left, tree.right) if tree.operator == "^" and is_zero else tree


def _inner(trees: st.SearchStrategy[Node]) -> st.SearchStrategy[Node]:
    one = st.sampled_from(["sin", "cos", "tan", "asin", "acos", "atan", "sqrt", "abs", "exp"])
    return st.one_of(
        st.builds(Negation, trees),
        st.builds(Binary, st.sampled_from("+-*/^"), trees, trees).map(_without_zero_power),
        st.builds(Call, one, st.tuples(trees)),
        st.builds(Call, st.just("atan2"), st.tuples(trees, trees)),
    )


trees: st.SearchStrategy[Node] = st.recursive(leaves | units, _inner, max_leaves=12)


@given(trees)
def test_a_printed_tree_reads_back(tree: Node) -> None:
    assert read(to_text(tree), ARM).tree == tree


@given(trees)
def test_converting_to_degrees_twice_changes_nothing_more(tree: Node) -> None:
    once = in_degrees(tree, is_angle=True, notes=[])
    assert in_degrees(once, is_angle=True, notes=[]) == once
    text = to_text(once)
    assert read(text, ARM, quantity="angle", angle_unit="degrees").tree == once


@given(trees)
def test_mathml_is_well_formed_and_latex_is_balanced(tree: Node) -> None:
    expression = read(to_text(tree), ARM)
    ET.fromstring(expression.mathml())
    latex = expression.latex()
    assert latex.count("{") == latex.count("}")
    assert latex.count(r"\left") == latex.count(r"\right")


@given(trees)
def test_latex_reads_back_to_the_same_values(tree: Node) -> None:
    values = {symbol.name: np.linspace(-2, 3, 4) for symbol in ARM.symbols}
    expression = read(to_text(tree), ARM)
    latex = expression.latex()
    again = read(latex, ARM)
    np.testing.assert_allclose(
        np.broadcast_to(again.evaluate(values), 4),
        np.broadcast_to(expression.evaluate(values), 4),
        rtol=1e-6,
        atol=1e-300,
    )


def _oracle(node: Node, values: dict[str, float]) -> sympy.Expr:
    match node:
        case Number(value):
            return sympy.Float(value, 40)
        case Pi():
            return sympy.pi
        case SymbolNode(symbol):
            return sympy.Float(values[symbol.name], 40)
        case Negation(operand):
            return -_oracle(operand, values)
        case Unit(operand, unit):
            return _oracle(operand, values) * (sympy.pi / 180 if unit == "deg" else 1)
        case Binary(operator, left, right):
            apply = {"+": add, "-": sub, "*": mul}[operator]
            return apply(_oracle(left, values), _oracle(right, values))
        case Call("abs", (argument,)):
            return sympy.Abs(_oracle(argument, values))
        case Call(function, arguments):
            return getattr(sympy, function)(*(_oracle(item, values) for item in arguments))


def _mild(trees: st.SearchStrategy[Node]) -> st.SearchStrategy[Node]:
    one = st.sampled_from(["sin", "cos", "atan", "abs"])
    return st.one_of(
        st.builds(Negation, trees),
        st.builds(Binary, st.sampled_from("+-*"), trees, trees),
        st.builds(Call, one, st.tuples(trees)),
    )


small = st.integers(0, 9).map(lambda n: Number(float(n), str(n)))
mild: st.SearchStrategy[Node] = st.recursive(
    small | st.sampled_from(ARM.symbols).map(SymbolNode) | st.builds(Unit, small, st.just("deg")),
    _mild,
    max_leaves=6,
)


@given(mild, st.lists(st.floats(-3, 3), min_size=6, max_size=6))
def test_values_are_those_of_sympy(tree: Node, numbers: list[float]) -> None:
    values = {symbol.name: number for symbol, number in zip(ARM.symbols, numbers, strict=True)}
    ours = read(to_text(tree), ARM).evaluate({name: np.array(x) for name, x in values.items()})
    theirs = complex(_oracle(tree, values).evalf(30))
    assert float(ours) == pytest.approx(theirs.real, rel=1e-6, abs=1e-6)


@given(trees, st.floats(-10, 10))
def test_evaluation_never_raises_or_warns(tree: Node, number: float) -> None:
    values = {symbol.name: np.full(3, number) for symbol in ARM.symbols}
    result = read(to_text(tree), ARM).evaluate(values)
    assert isinstance(result, float) or result.shape == (3,)


def _check(error: ExpressionError, source: str | float) -> None:
    start, end = error.span
    if isinstance(source, str):
        assert 0 <= start <= end <= len(source)
    assert error.message
    assert error.message.isprintable()


FORMULA_PIECES = [
    *("q1", "θ", "₁", "²", "sin", "c12", "(", ")", "*", "^", "-", " ", "½", "°", "deg", ",", "_{"),
    *("}", "\\", "theta", "1", ".", "e", "√", "=", "\u200b", "а", "k"),
]


@pytest.mark.long
@given(
    st.text(max_size=40)
    | st.lists(st.sampled_from(FORMULA_PIECES), max_size=20).map("".join)
    | st.integers()
    | st.floats()
)
@example("²")
@example("₁")
@example("sin²")
@example("\udcff")
@example("1٣")
def test_nothing_but_an_expression_error_escapes(source: str | float) -> None:
    for unit in ("radians", "degrees"):
        try:
            expression = read(source, ARM, quantity="angle", angle_unit=unit)
        except ExpressionError as error:
            _check(error, source)
            continue
        for note in expression.notes:
            start, end = note.span
            assert 0 <= start < end <= len(str(source))
        again = read(expression.text(), ARM, quantity="angle", angle_unit=unit)
        assert again.tree == expression.tree
        ET.fromstring(expression.mathml())


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_number_keeps_its_value(number: float) -> None:
    assert read(number, ARM).evaluate({}) == number
    assert read(repr(number), ARM).evaluate({}) == number


# --- Any text is read quickly, and always with the same result

HOSTILE = hostile()

formulas: st.SearchStrategy[str] = st.recursive(
    st.sampled_from(["q1", "θ₁", r"\theta_2", "l1", "2", "0.5", "π", "c12", "90°", "½", "d3*"]),
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from([*"+-*/^·", " ", r"\cdot ", ".*", "**"]), inner).map(
            "".join
        ),
        st.tuples(st.sampled_from(["sin", "cos ", r"\tan", "√", "sin^2", "-"]), inner).map("".join),
        st.tuples(
            st.sampled_from(["(", r"\left(", "[", "{", "sin("]), inner, st.sampled_from(")]}")
        ).map("".join),
        st.tuples(inner, inner).map(lambda parts: rf"\frac{{{parts[0]}}}{{{parts[1]}}}"),
    ),
    max_leaves=15,
)


def _check_text(text: str) -> None:
    for degrees in (False, True):
        first, second = outcome(text, degrees=degrees), outcome(text, degrees=degrees)
        assert first.fingerprint == second.fingerprint
        # A garbage collection may slow one of the two.
        assert min(first.seconds, second.seconds) < STALL


@given(formulas)
def test_random_formulas_give_one_result(text: str) -> None:
    _check_text(text)


@pytest.mark.long
@given(st.lists(st.sampled_from(PIECES), max_size=25).map("".join) | st.text(max_size=60))
def test_random_texts_give_one_result(text: str) -> None:
    _check_text(text)


@given(st.sampled_from(seeds()), st.integers(0, 60), st.binary(max_size=6))
def test_mutated_cases_give_one_result(text: str, at: int, put: bytes) -> None:
    data = text.encode()
    _check_text((data[:at] + put + data[at + 1 :]).decode("utf-8", "replace"))


def test_a_sample_of_the_fuzz_campaign_gives_one_result() -> None:
    for text in texts(300, seed=1):
        _check_text(text)


@pytest.mark.long
@together("text", HOSTILE)
def test_hostile_texts_give_one_result(text: str) -> None:
    _check_text(text)


@pytest.mark.parametrize("text", [text for text in HOSTILE if "__" in text or "import" in text])
def test_program_code_is_refused(text: str) -> None:
    with pytest.raises(ExpressionError):
        read(text, ROBOT)


def test_a_text_that_is_too_long_is_refused_at_once() -> None:
    with pytest.raises(ExpressionError) as caught:
        read("(" * 10_000_000, ROBOT)
    assert (caught.value.code, caught.value.span[0]) == ("too_long", LIMITS.characters)
