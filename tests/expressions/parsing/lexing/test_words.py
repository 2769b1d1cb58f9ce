"""Read words of letters and digits: names, functions and abbreviations."""

import numpy as np
from dh_grader.expressions import Symbol, Vocabulary, read


def test_a_declared_symbol_comes_before_the_shorthand() -> None:
    vocabulary = Vocabulary([Symbol("theta1", "angle", ("q1",), joint=1), Symbol("c1", "length")])
    assert read("c1 + s1", vocabulary).symbols == {"c1", "theta1"}
    assert read("c1", vocabulary).evaluate({"c1": np.array([5.0])}) == [5.0]


def test_a_declared_c_is_a_factor() -> None:
    vocabulary = Vocabulary([Symbol("theta1", "angle", ("q1",), joint=1), Symbol("c", "length")])
    assert read("cθ1", vocabulary).tree == read("c*θ1", vocabulary).tree


def test_the_longest_name_that_leaves_a_readable_rest_is_read() -> None:
    vocabulary = Vocabulary([Symbol(name, "number") for name in ("a", "b", "ab", "bc", "d")])
    assert read("abd", vocabulary).tree == read("ab*d", vocabulary).tree
    assert read("abc", vocabulary).tree == read("a*bc", vocabulary).tree
