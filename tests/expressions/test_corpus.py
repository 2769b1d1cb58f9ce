"""Test the formulas and spellings of the corpus."""

from collections.abc import Callable
from random import Random

import numpy as np
import pytest
from dh_grader.expressions import ExpressionError, Symbol, Vocabulary, read

from tests.expressions.corpus_files import (
    ROBOT,
    Case,
    SpellingCase,
    cases,
    names,
    numbers,
    spelling_cases,
)
from tests.expressions.reference import worth
from tests.together import together

# --- Test each case in corpus/*.txt: a text, and its value or its error

VALUES = [(name, case) for name in names() for case in cases(name)]
ERRORS = cases("errors")


@together(("name", "case"), VALUES)
def test_a_written_case_has_its_value(name: str, case: Case) -> None:
    known = numbers(name)
    values = {
        symbol.name: np.array([known[alias]])
        for symbol in ROBOT.symbols
        for alias in (symbol.name, *symbol.aliases)
        if alias in known
    }
    expression = (
        read(case.text, ROBOT, quantity="angle", angle_unit="degrees")
        if name == "degrees"
        else read(case.text, ROBOT)
    )
    expected = worth(case.answers[0], known)
    assert np.ravel(expression.evaluate(values)) == pytest.approx([expected], rel=1e-12, abs=1e-15)


@together("case", ERRORS)
def test_a_written_case_has_its_error(case: Case) -> None:
    code, place, suggestion = case.answers
    with pytest.raises(ExpressionError) as caught:
        read(case.text, ROBOT)
    error = caught.value
    part = case.text[slice(*error.span)]
    assert (error.code, f"{error.span[0]}-{error.span[1]} {part}".rstrip()) == (code, place)
    assert (error.suggestion or "-") == suggestion


def test_the_corpus_has_600_distinct_cases() -> None:
    assert len(VALUES) + len(ERRORS) >= 600
    assert len({(name, case.text) for name, case in VALUES}) == len(VALUES)


# --- Read a thousand formulas as people type them, each with its meaning

# The meaning is plain arithmetic, evaluated by `reference`, which shares no code with the program.
# `corpus/spellings` has one file for each program or habit. `test_corpus` tests the other files of
# `corpus`.

CASES = spelling_cases()
READ = [case for case in CASES if not case.refused]
REFUSED = [case for case in CASES if case.refused]
DRAWS = 3
# The greatest share of useful spellings that may be refused.
MOST_REFUSED = 0.03
LEAST_SPELLINGS = 1000


def _values(seed: int) -> dict[str, float]:
    random = Random(seed)
    return {
        alias: random.uniform(0.2, 0.9)
        for symbol in ROBOT.symbols
        for alias in (symbol.aliases or (symbol.name,))
    } | {"d3": random.uniform(0.2, 0.9)}


def _means(text: str, meaning: str) -> None:
    for seed in range(DRAWS):
        known = _values(seed)
        values = {
            symbol.name: np.array([known.get(symbol.name) or known[symbol.aliases[0]]])
            for symbol in ROBOT.symbols
        }
        found = np.ravel(read(text, ROBOT).evaluate(values))
        assert found == pytest.approx([worth(meaning, known)], rel=1e-9, abs=1e-12), text


@together("case", READ)
def test_a_spelling_has_its_meaning(case: SpellingCase) -> None:
    _means(case.text, case.meaning)


@together("case", REFUSED)
def test_the_repair_of_a_refused_spelling_keeps_its_meaning(
    case: SpellingCase,
) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(case.text, ROBOT)
    assert caught.value.suggestion is not None, caught.value.message
    _means(caught.value.suggestion, case.meaning)


def test_few_useful_spellings_are_refused(figure: Callable[[str], None]) -> None:
    plain = [case.text for name in names() for case in cases(name)]
    total = len({*plain, *(case.text for case in CASES)})
    assert len({case.text for case in CASES}) == len(CASES)
    share = len(REFUSED) / total
    figure(f"{total} useful spellings, {len(REFUSED)} refused with a repair ({share:.1%})")
    assert total >= LEAST_SPELLINGS
    assert share < MOST_REFUSED


# Symbols with one letter: a text may accidentally be a product of them.
LETTERS = Vocabulary(
    [
        *ROBOT.symbols,
        *(Symbol(name, "length") for name in ("a", "b", "l", "h", "c", "s")),
        Symbol("n", "number"),
    ]
)


@together(
    "text",
    [
        *("a_b", "l_h", "l1_h", "a_{b}", "l_{h}", "l_{1h}", "l_{h1}", "l₁ₕ", "h_beta", "l_{c1}"),
        *("a_c1", "a_theta1", "l_{\\theta_1}", "theta1_theta2", "s_c", "c_beta", "a_pi", "a_deg"),
        *("sgn(n)", "sign(n)", "acosh(n)", "cosh(n)", "sinh n", "max(a, b)", "log n", "abs_n_b"),
        *("ArcTan(l1, l2)", "arctan(a, b)", "sin2a", "2^3^2", "sin^-1(n)", "lambda: 0"),
    ],
)
def test_no_text_is_accidentally_a_product(text: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(text, LETTERS)
    if caught.value.suggestion is not None:
        assert text in {"ArcTan(l1, l2)", "arctan(a, b)", "sin2a", "sin^-1(n)"}


@pytest.mark.parametrize(
    ("text", "meaning", "notes"),
    [
        ("ab", "a*b", []),
        ("lh", "l*h", []),
        ("a b", "a*b", []),
        ("l_1h", "l1*h", []),
        ("lc1", "l*cos(theta1)", []),
        ("cbeta", "c*beta", ["shorthand"]),
        ("sβ", "s*beta", ["shorthand"]),
        ("a/bc", "a/b*c", ["division_then_product"]),
        ("A b", "a*b", ["letter_case"]),
    ],
)
def test_an_intended_product_is_read(text: str, meaning: str, notes: list[str]) -> None:
    expression = read(text, LETTERS)
    assert expression.text() == meaning
    assert [note.code for note in expression.notes] == notes
