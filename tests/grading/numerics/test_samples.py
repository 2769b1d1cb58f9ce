"""Choose the random values at which answers are compared."""

import tomllib
from collections.abc import Mapping
from datetime import date, time

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading.numbers import HALF, SAMPLES, draw
from hypothesis import given
from hypothesis import strategies as st

ANSWERS = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
)


@given(ANSWERS)
def test_a_draw_stays_in_the_ranges_and_is_repeated(
    catalogue: Mapping[str, Exercise], answers: object
) -> None:
    for exercise in catalogue.values():
        samples, again = draw(exercise, answers), draw(exercise, answers)
        assert set(samples.values) == {variable.name for variable in exercise.variables}
        for variable in exercise.variables:
            values = samples.values[variable.name]
            assert values.shape == (SAMPLES,)
            assert (values >= variable.low).all()
            assert (values <= variable.high).all()
            assert (values == again.values[variable.name]).all()


def test_the_second_half_repeats_the_links_and_moves_the_joints(
    catalogue: Mapping[str, Exercise],
) -> None:
    exercise = catalogue["stanford-arm"]
    samples = draw(exercise, "x")
    for variable in exercise.variables:
        first, second = np.split(samples.values[variable.name], [HALF])
        repeated = first == second
        assert repeated.all() if variable.joint is None else not repeated.any()


def test_each_submission_and_version_has_its_own_draw(
    catalogue: Mapping[str, Exercise],
) -> None:
    exercise = catalogue["scara"]
    draws = [draw(exercise, answers).values["a1"][0] for answers in range(500)]
    assert len(set(draws)) == 500
    assert draw(catalogue["rrrp"], 0).values["q1"][0] != draw(exercise, 0).values["theta1"][0]


def _nested(inside: object) -> object:
    for _ in range(5_000):
        inside = [inside]
    return inside


HUGE = tomllib.loads(f"x = 0x{'f' * 5_000}")["x"]
REFUSED = [
    HUGE, -HUGE, HUGE - 1, date(2024, 2, 29), time(12, 30), _nested("q1"), {1: 2, "1": 3},
    {"q1", "q2"},
]  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("refused", REFUSED, ids=range(len(REFUSED)))
def test_answers_that_json_refuses_change_the_draw(
    refused: object, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue["scara"]

    def drawn(*answers: object) -> float:
        return float(draw(exercise, [*answers, refused]).values["a1"][0])

    assert drawn() == drawn()
    assert drawn({"a": 1, "b": 2}) == drawn({"b": 2, "a": 1})
    beside = [*range(30), "1", None, True, 1.5, [1], [[1]], [], {}, {"1": 1}]
    assert len({drawn(answer) for answer in beside}) == len(beside)


def test_numbers_of_thousands_of_digits_differ(catalogue: Mapping[str, Exercise]) -> None:
    draws = {draw(catalogue["scara"], each).values["a1"][0] for each in (HUGE, -HUGE, HUGE - 1)}
    assert len(draws) == 3


def test_cyclic_answers_have_a_draw(catalogue: Mapping[str, Exercise]) -> None:
    circle: list[object] = ["q1"]
    circle.append(circle)
    assert draw(catalogue["scara"], circle).values["a1"][0] > 0


def test_the_values_fill_their_range(catalogue: Mapping[str, Exercise]) -> None:
    # Mean and variance of 32,000 values are those of the uniform distribution.
    exercise = catalogue["stanford-arm"]
    [joint] = [variable for variable in exercise.variables if variable.name == "theta1"]
    values = np.concatenate([draw(exercise, i).values["theta1"] for i in range(1000)])
    width = joint.high - joint.low
    assert values.mean() == pytest.approx((joint.low + joint.high) / 2, abs=0.02 * width)
    assert values.var() == pytest.approx(width**2 / 12, rel=0.02)


def test_the_order_of_keys_does_not_matter(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["scara"]
    one = draw(exercise, {"a": 1, "b": {"c": 2, "d": 3}})
    other = draw(exercise, {"b": {"d": 3, "c": 2}, "a": 1})
    assert all((one.values[name] == other.values[name]).all() for name in one.values)


def test_a_lone_surrogate_has_a_draw_of_its_own(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["scara"]
    first = {float(draw(exercise, text).values["a1"][0]) for text in ("\ud800", "\udc00", "?")}
    assert len(first) == 3
