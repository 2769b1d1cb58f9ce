"""Test what is said about a wrong formula."""

from dataclasses import replace

import numpy as np
import pytest
from dh_grader.expressions import Symbol, Vocabulary, joint_variable, read
from dh_grader.grading.diagnosis.formulas import quantity_of
from dh_grader.grading.misconception import (
    Hypothesis,
    Repaired,
    Written,
    WrongNumbers,
    WrongValue,
    differs,
)
from dh_grader.grading.numbers import SAMPLES, Samples
from dh_grader.grading.report import Finding
from dh_grader.kinematics import Numbers

# --- Recognise whether a formula is a length, an angle or a number

WORDS = Vocabulary([joint_variable(1), joint_variable(2), Symbol("l1", "length")])


@pytest.mark.parametrize(
    ("text", "quantity"),
    [
        ("90deg", "angle"),
        ("-pi/2", "angle"),
        ("q1 + 90", "angle"),
        ("2*q1", "angle"),
        ("atan2(l1, 2)", "angle"),
        ("l1", "length"),
        ("-l1/2", "length"),
        ("l1 c1", "length"),
        ("l1 + 0.3", "length"),
        ("1.6", "number"),
        ("l1/l1", "number"),
        ("sin(q1)", "number"),
        ("2^3", "number"),
        ("l1*l1", None),
        ("l1^2", None),
        ("l1 + q1", None),
        ("sqrt(l1)", None),
        ("+".join(["l1"] * 80), None),
    ],
)
def test_the_quantity_of_a_formula(text: str, quantity: str | None) -> None:
    assert quantity_of(read(text, WORDS).tree) == quantity


# --- Test the explanations of wrong numbers

FINDING = Finding("code", "Hint.")
ONES = np.ones(SAMPLES)


def explains(
    hypothesis: Hypothesis[Numbers], actual: float, expected: float, *, angle: bool = False
) -> bool:
    case = WrongValue(
        expression=read(0, Vocabulary([])),
        actual=actual * ONES,
        expected=expected * ONES,
        samples=Samples({}),
        scale=1.0,
        angle=angle,
    )
    return list(case.explained_by([hypothesis])) == [hypothesis]


def test_written_explains_an_equal_answer() -> None:
    written = Written(2 * ONES, FINDING)
    assert explains(written, actual=2, expected=1)
    assert not explains(written, actual=3, expected=1)
    assert not explains(written, actual=2, expected=2)
    assert explains(written, actual=2 + 2 * np.pi, expected=1, angle=True)


def test_repaired_explains_a_wrong_answer_if_it_is_right() -> None:
    repaired = Repaired(2 * ONES, FINDING)
    assert explains(repaired, actual=1, expected=2)
    assert not explains(repaired, actual=1, expected=3)
    assert not explains(repaired, actual=2, expected=2)


def test_written_may_have_a_tolerance() -> None:
    assert explains(Written(2 * ONES, FINDING, tolerance=0.2), actual=2.1, expected=1)
    assert not explains(Written(2 * ONES, FINDING, tolerance=0.05), actual=2.1, expected=1)


def test_many_numbers_are_explained_together() -> None:
    case = WrongNumbers(
        actual=np.array([ONES, 2 * ONES]), expected=np.array([ONES, 3 * ONES]), scale=1.0
    )
    right, written = (Written(np.array([ONES, n * ONES]), FINDING) for n in (3, 2))
    assert case.explained_by([right, written, right]) == [written]
    assert case.explained_by([]) == []


def test_a_hypothesis_may_explain_some_entries() -> None:
    case = WrongNumbers(
        actual=np.array([[ONES, 2 * ONES]]),
        expected=np.array([[ONES, 3 * ONES]]),
        scale=np.ones((1, 2)),
    )
    second = (slice(0, 1), slice(1, 2))
    written = Written(np.array([[2 * ONES]]), FINDING, second)
    assert case.explained_by([written]) == [written]


def counterexample(text: str, *, degrees: bool = False, corrects: bool = False) -> Finding:
    words = Vocabulary([Symbol("q1", "angle", joint=1), Symbol("l1", "length")])
    rng = np.random.default_rng(3)
    values = {"q1": rng.uniform(-3, 3, SAMPLES), "l1": rng.uniform(0.3, 0.9, SAMPLES)}
    expression = read(text, words)
    case = WrongValue(
        expression=expression,
        actual=ONES * expression.evaluate(values),
        expected=ONES,
        samples=Samples(values, frozenset({"q1"} if degrees else ())),
        scale=1.0,
        angle=False,
        corrects=corrects,
    )
    return differs(case, "Hint.")


def test_a_counterexample_can_be_checked_with_a_pocket_calculator() -> None:
    # Near 180°, an angle of four figures gives a sine of only two figures.
    for degrees in (True, False):
        found = counterexample("1000 l1 sin(q1)", degrees=degrees).values
        assert found is not None
        assert set(found) == {"q1", "l1", "yours"}
        angle, length, yours = (float(found[name]) for name in ("q1", "l1", "yours"))
        sine = np.sin(np.radians(angle) if degrees else angle)
        assert yours == float(f"{1000 * length * sine:.4g}")


def test_a_bare_number_has_no_counterexample() -> None:
    assert counterexample("1.6").values is None
    # If the right number may be shown, it has one.
    assert set(counterexample("1.6", corrects=True).values or ()) == {
        "q1",
        "l1",
        "yours",
        "expected",
    }


def test_a_counterexample_shows_two_numbers_that_differ() -> None:
    # Both are 4.512 with four digits in the first sample.
    rights = np.where(np.arange(SAMPLES) == 0, 4.5121, 9.0)
    case = WrongValue(
        expression=read("l1", Vocabulary([Symbol("l1", "length")])),
        actual=4.5124 * ONES,
        expected=rights,
        samples=Samples({"l1": 4.5124 * ONES}),
        scale=1.0,
        angle=False,
        corrects=True,
    )
    found = differs(case, "Hint.").values
    assert found is not None
    assert (found["yours"], found["expected"]) == (4.512, 9.0)
    alike = replace(case, expected=4.5121 * ONES)
    assert differs(alike, "Hint.").values is None
