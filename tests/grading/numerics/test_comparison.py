"""Compare values with expected values."""

from collections.abc import Mapping

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.catalogue import Exercise
from service.expressions import read
from service.grading.numerics.comparison import Match, difference, is_rounded, matches, same
from service.grading.numerics.samples import SAMPLES, draw

ANGLES = st.floats(-50, 50)
TURNS = st.integers(-20, 20)


@given(ANGLES, TURNS)
def test_whole_turns_do_not_count(angle: float, turns: int) -> None:
    turned = np.array([angle + 2 * np.pi * turns])
    assert abs(difference(turned, np.array([angle]), True)[0]) < 1e-12 * (1 + abs(turns)) * 50


@given(ANGLES, ANGLES)
def test_the_difference_of_angles_is_the_shorter_way(one: float, other: float) -> None:
    # The difference has the sine and cosine of `one - other`, and is at most half a turn.
    shorter = difference(np.array([one]), np.array([other]), True)[0]
    assert abs(shorter) <= np.pi + 1e-9
    assert np.cos(shorter) == pytest.approx(np.cos(one - other), abs=1e-9)
    assert np.sin(shorter) == pytest.approx(np.sin(one - other), abs=1e-9)


@pytest.mark.parametrize(
    ("actual", "expected", "match"),
    [
        (1.0, 1.0, Match.EXACT),
        (1.0 + 1e-12, 1.0, Match.EXACT),
        (1e-12, 0.0, Match.EXACT),
        (1.0005, 1.0, Match.DIFFERENT),
        (1.0 + 2e-9, 1.0, Match.DIFFERENT),
        (1e-6, 0.0, Match.DIFFERENT),
        (-1.0, 1.0, Match.DIFFERENT),
        (np.nan, 1.0, Match.UNDEFINED),
        (np.inf, 1.0, Match.UNDEFINED),
        (-np.inf, 0.0, Match.UNDEFINED),
        (1e308, 1.0, Match.DIFFERENT),
    ],
)
def test_a_constant_has_this_match(actual: float, expected: float, match: Match) -> None:
    assert matches(np.full(4, actual), np.full(4, expected), 1.0) == match


def test_values_differ_if_they_differ_at_one_sample() -> None:
    expected = np.linspace(-1, 1, 32)
    actual = expected.copy()
    assert same(actual, expected)
    actual[17] += 0.02
    assert not same(actual, expected)
    actual[17] = np.nan
    assert not same(actual, expected)


def test_a_half_turn_is_the_same_both_ways() -> None:
    assert same(np.array([np.pi]), np.array([-np.pi]), angle=True)
    assert not same(np.array([np.pi]), np.array([-np.pi]))


def test_the_tolerance_follows_the_scale() -> None:
    dust = np.array([5e-8])
    assert same(dust, np.zeros(1), scale=100.0)
    assert not same(dust, np.zeros(1), scale=1.0)


@given(
    st.sampled_from(["1.571", "-1.571", "0.866", "100.25"]), st.floats(-2, 2), st.integers(-1, 1)
)
def test_a_single_decimal_is_rounded_like_a_decimal_in_a_sum(
    catalogue: Mapping[str, Exercise], text: str, units: float, turns: int
) -> None:
    # For one decimal, the closed form and the general fit give the same result.
    exercise = catalogue["stanford-arm"]
    samples = draw(exercise, None)
    alone, in_sum = (read(each, exercise.vocabulary) for each in (text, f"0 + {text}"))
    unit = 0.01 if text == "100.25" else 0.001
    expected = np.full(SAMPLES, float(text) + units * unit + 2 * np.pi * turns)
    for angle in (False, True):
        found = is_rounded(alone, expected, 1.0, samples, angle=angle)
        assert found == is_rounded(in_sum, expected, 1.0, samples, angle=angle)
        if not turns:
            towards_zero = units * np.sign(float(text))
            assert found or not -0.499 < towards_zero < 0.499
            assert not found or -0.501 < towards_zero < 1.001
