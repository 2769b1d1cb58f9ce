"""Test how numbers are drawn and compared."""

import tomllib
import warnings
from collections.abc import Mapping
from datetime import date, time
from functools import partial

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import read
from dh_grader.grading.judging import Grading, StudentChain
from dh_grader.grading.kinds.motions import nearest_triple
from dh_grader.grading.marks import can_carry, stands_still
from dh_grader.grading.misconception import multiples, number_formula
from dh_grader.grading.numbers import (
    HALF,
    SAMPLES,
    Match,
    Samples,
    SharedDecimals,
    difference,
    difference_steps,
    draw,
    entry_matches,
    fitted_shifts,
    fitted_unknowns,
    is_rounded,
    joint_counts,
    matches,
    moves_with,
    nearly_equal,
    rounding_slack,
    same,
)
from dh_grader.grading.reading.entries import Reader
from dh_grader.kinematics import (
    Convention,
    Matrices,
    Numbers,
    from_angles,
    links,
    other_triple,
    products,
)
from hypothesis import given
from hypothesis import strategies as st

from tests.grading.support.submitting import graded_table
from tests.together import together

# --- Choose the random values at which answers are compared

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


# --- Compare values on both sides of a tolerance, in the functions that have it


def grading_of(exercise: Exercise) -> Grading:
    samples = draw(exercise, None)
    return Grading(exercise, samples, Reader.of(exercise, samples, "radians"))


@together(("error", "is_same"), [(0.5e-6, True), (2e-6, False)])
def test_a_motion_is_that_of_a_joint_up_to_a_millionth(
    catalogue: Mapping[str, Exercise], error: float, is_same: bool
) -> None:
    exercise = catalogue["stanford-arm"]
    samples = draw(exercise, None)
    variable = samples.values["theta1"].copy()
    motion = variable[HALF:] - variable[:HALF]
    # One sample is in error, also after a whole turn.
    for turn in (0.0, 2 * np.pi):
        values = variable.copy()
        values[HALF + 3] += error + turn
        is_angle = np.array([True])
        assert moves_with(values[None], motion, True).tolist() == [is_same]
        _, linear = joint_counts(values[None], exercise.joints, samples, is_angle)
        assert linear.tolist() == [is_same]


@together(
    ("motion", "quantity", "is_still"),
    [
        (0.0075, "angle", True), (0.015, "angle", False), (np.nan, "angle", False),
        (0.0075, "length", True), (0.015, "length", False),
    ],
)  # fmt: skip
def test_an_answer_that_moves_by_less_than_a_hundredth_stands_still(
    catalogue: Mapping[str, Exercise], motion: float, quantity: str, is_still: bool
) -> None:
    grading = grading_of(catalogue["scara"])
    scale = grading.exercise.length_scale if quantity == "length" else 1.0
    values = np.full((2, 1, SAMPLES), 0.3)
    values[1, 0, -1] += motion * scale
    assert stands_still(values, (quantity,), grading) is is_still  # type: ignore[arg-type]


@together(
    ("scale", "first_row", "carries"),
    [
        # A frame whose axes are longer by a thousandth, or by five, has products of twice that.
        (1.0, {}, True), (1.001, {}, True), (1.005, {}, False),
        # The first joint turns by 1.5 %, or by 3 %, more than its variable says.
        (1.0, {"gain": 1.015}, True), (1.0, {"gain": 1.03}, False),
        # Two axes with a distance d coincide if d / 2, the ratio of singular values, is too small.
        (1.0, {"length": 6e-3}, True), (1.0, {"length": 6e-4}, False),
    ],
)  # fmt: skip
def test_an_arm_carries_later_answers_if_it_is_rigid_and_moves(
    catalogue: Mapping[str, Exercise], scale: float, first_row: dict[str, float], carries: bool
) -> None:
    exercise = catalogue["planar-rr"]
    grading = grading_of(exercise)

    def frames_at(samples: Samples) -> Matrices:
        table = exercise.robot.tables[Convention.STANDARD]
        values = table.values(samples.values, SAMPLES).copy()
        values[0, 3] *= first_row.get("gain", 1.0)
        if "length" in first_row:
            values[0, 0] = first_row["length"] * exercise.length_scale
        return np.asarray(products(links(values, Convention.STANDARD)))

    frames = frames_at(grading.samples).copy()
    frames[1, :, :3, :3] *= scale
    assert can_carry(StudentChain(frames, frames_at), grading) is carries


@together(("error", "side"), [(0.5e-6, 0), (2e-6, 1)])
def test_angles_within_a_millionth_belong_to_a_triple(error: float, side: int) -> None:
    # Two angles are nearly those of one triple, the third is that of the other triple.
    one = np.tile(np.array([0.3, 0.7, -1.1])[:, None], SAMPLES)
    rotation = from_angles("ZYX", one.T)
    other = other_triple("ZYX", one.T).T
    angles = np.array([one[0] + error, one[1] + error, other[2]])
    nearest = nearest_triple(angles, rotation, "ZYX")
    assert nearest == pytest.approx((one, other)[side])


@together(
    ("angle", "vary", "noise", "found"),
    [
        # A constant is one to a billionth, and no letter of the arm is an angle.
        (True, 0.0, 0.5e-9, ([], 0.4)), (True, 0.0, 2e-9, None),
        # The rest of a sum of letters is constant to a millionth.
        (False, 0.0, 2e-9, ([], 0.4)), (False, 1.0, 0.5e-6, ([(1, "a1")], 0.4)),
        (False, 1.0, 2e-6, None),
    ],
)  # fmt: skip
def test_a_constant_is_a_sum_of_letters_and_a_number(
    catalogue: Mapping[str, Exercise],
    angle: bool,
    vary: float,
    noise: float,
    found: tuple[list[tuple[int, str]], float] | None,
) -> None:
    exercise = catalogue["scara"]
    samples = draw(exercise, None)
    values: Numbers = 0.4 + vary * samples.values["a1"][:HALF]
    values[5] += noise
    told = multiples(values, angle, exercise, samples)
    assert (told is None) == (found is None)
    if told is not None and found is not None:
        assert told[0] == found[0]
        assert told[1] == pytest.approx(found[1], abs=1e-6)


def test_only_a_value_that_does_not_vary_is_printed_as_a_number() -> None:
    for spread, is_number in ((0.5e-12, True), (2e-12, False)):
        values = np.full(SAMPLES, 0.25)
        values[7] += spread
        assert (number_formula(values) is not None) is is_number
    for value, text in ((0.5e-12, "0"), (2e-12, "2e-12")):
        formula = number_formula(np.full(SAMPLES, value))
        assert formula is not None
        assert formula.text == text


@together(("error", "is_right"), [(0.5e-6, True), (2e-6, False)])
def test_a_huge_offset_does_not_enlarge_the_tolerance(
    catalogue: Mapping[str, Exercise], error: float, is_right: bool
) -> None:
    # Offsets along parallel axes cancel; with ten million lengths, seven figures are left.
    exercise = catalogue["planar-rrr"]
    rest = round(error * exercise.length_scale * 1e12)
    rows = [
        ("0", "0", "10^7", "q1"),
        ("l1", "0", f"{rest}/10^12 - 10^7", "q2"),
        ("l2", "0", "0", "q3"),
        ("l3", "0", "0", "0"),
    ]
    report = graded_table(exercise, rows)
    assert (report.points == report.max_points) is is_right


# --- Compare values with expected values

# The most decimals of an entry, and of all entries together, that may be rounded.
MOST_ALONE, MOST_TOGETHER = 16, 32
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


@pytest.fixture
def arm(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["stanford-arm"]


@together(
    ("expected", "scale", "error", "match"),
    [
        # A billionth of the scale, and 1e-12 of the size.
        (0.0, 1.0, 0.9e-9, Match.EXACT),
        (0.0, 1.0, 1e-9, Match.EXACT),
        (0.0, 1.0, 1.1e-9, Match.DIFFERENT),
        (0.0, 1000.0, 0.9e-6, Match.EXACT),
        (0.0, 1000.0, 1.1e-6, Match.DIFFERENT),
        (0.0, 0.001, 1.1e-12, Match.DIFFERENT),
        (1e6, 1.0, 0.95e-6, Match.EXACT),
        (1e6, 1.0, 1.2e-6, Match.DIFFERENT),
        (-1e6, 1.0, -0.95e-6, Match.EXACT),
        (-1e6, 1.0, -1.2e-6, Match.DIFFERENT),
    ],
)
def test_equal_values_differ_by_a_billionth(
    expected: float, scale: float, error: float, match: Match
) -> None:
    assert matches(np.full(4, expected + error), np.full(4, expected), scale) == match
    # At one sample of four.
    actual = np.full(4, expected)
    actual[2] += error
    assert matches(actual, np.full(4, expected), scale) == match


def test_each_entry_has_its_own_match() -> None:
    expected = np.zeros((2, 3, 4))
    actual = expected.copy()
    assert (matches(actual, expected, 1.0) == Match.EXACT).all()
    assert matches(actual, expected, 1.0).shape == (2, 3)
    actual[0, 1, 3], actual[1, 0, 0], actual[1, 2] = 1.0, np.nan, 2 * np.pi
    told = [
        [Match.EXACT, Match.DIFFERENT, Match.EXACT],
        [Match.UNDEFINED, Match.EXACT, Match.DIFFERENT],
    ]
    assert matches(actual, expected, 1.0).tolist() == told
    # A whole turn is no difference of the third column's angles.
    told[1][2] = Match.EXACT
    is_angle = np.array([False, False, True])[:, None]
    assert matches(actual, expected, 1.0, is_angle).tolist() == told


def test_each_entry_has_its_own_tolerance() -> None:
    # The size of one entry, and that it is an angle, mean nothing for the other.
    expected = np.array([[1e6] * 4, [1.0] * 4])
    found = matches(expected + 0.95e-6, expected, 1.0)
    assert found.tolist() == [Match.EXACT, Match.DIFFERENT]
    assert matches(expected[:1] + 1.2e-6, expected[:1], 1.0) == Match.DIFFERENT
    expected = np.array([[1.0] * 4, [1e-3] * 4])
    assert nearly_equal(expected + 0.9e-3, expected).tolist() == [True, False]
    expected = np.full((2, 4), 100.0)
    is_angle = np.array([True, False])[:, None]
    assert nearly_equal(expected + 3e-3, expected, 1.0, is_angle).tolist() == [True, False]


def test_values_without_a_number_cause_no_warning() -> None:
    huge = np.array([[1e308], [np.inf], [np.nan], [-np.inf]])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = matches(huge, -huge, 1.0)
        same_infinity = matches(huge[1], huge[1], 1.0)
    assert found[1:].tolist() == [Match.UNDEFINED] * 3
    assert same_infinity == Match.UNDEFINED


def test_without_a_mask_whole_turns_are_a_difference() -> None:
    turn = np.array([2 * np.pi])
    assert difference(turn, np.zeros(1)) == turn
    assert matches(turn, np.zeros(1), 1.0) == Match.DIFFERENT
    assert not same(turn, np.zeros(1))
    assert not nearly_equal(turn, np.zeros(1))


def test_only_rounded_decimals_count_as_equal(arm: Exercise) -> None:
    texts = ("pi/2", "1.571", "1.5", "1.572", "7.854", None, "1/0")
    wanted = np.full((len(texts), SAMPLES), np.pi / 2)
    samples = draw(arm, None)
    read_ = [None if text is None else read(text, arm.vocabulary) for text in texts]
    actual = np.full_like(wanted, np.nan)
    for i, each in enumerate(read_):
        if each is not None and texts[i] != "1/0":
            actual[i] = each.evaluate(samples.values)
    actual[5] = 1.571
    same_, rounded, no = Match.EXACT, Match.ROUNDED, Match.DIFFERENT
    told = [same_, rounded, no, no, no, no, Match.UNDEFINED]
    assert entry_matches(read_, actual, wanted, 1.0, samples).tolist() == told
    # 7.854 is 5π/2, and so π/2 after a whole turn.
    told[4] = rounded
    assert entry_matches(read_, actual, wanted, 1.0, samples, True).tolist() == told
    is_angle = (np.arange(len(texts)) != 4)[:, None]
    told[4] = no
    assert entry_matches(read_, actual, wanted, 1.0, samples, is_angle).tolist() == told
    assert entry_matches([None], actual[5:6], wanted[5:6], 1.0, samples).tolist() == [no]
    # The shape of the entries is kept.
    found = entry_matches(
        read_[:4], actual[:4].reshape(2, 2, -1), wanted[:4].reshape(2, 2, -1), 1.0, samples
    )
    assert found.tolist() == [told[:2], told[2:4]]


@together(
    ("text", "true", "expected"),
    [
        # Rounded, 1.571 is half a unit away at most; cut off, it is less than a unit nearer to 0.
        ("1.571", 1.5705, True), ("1.571", 1.57049, False),
        ("1.571", 1.57199, True), ("1.571", 1.572, False),
        ("-1.571", -1.5705, True), ("-1.571", -1.57049, False),
        ("-1.571", -1.57199, True), ("-1.571", -1.572, False),
        ("0 + 1.571", 1.5705, True), ("0 + 1.571", 1.57049, False),
        ("0 + 1.571", 1.57199, True), ("0 + 1.571", 1.572, False),
        ("0.999", 1.0, False), ("15.71", 15.705, True), ("15.71", 15.7049, False),
        # The limits are 0.500001 and 0.999 units.
        ("1.571", 1.571 - 0.5000005e-3, True), ("1.571", 1.571 - 0.50001e-3, False),
        ("1.571", 1.571 + 0.9985e-3, True), ("1.571", 1.571 + 0.9995e-3, False),
        # A sum of two decimals may be twice as far away.
        ("1.571 + 1.571", 3.1411, True), ("1.571 + 1.571", 3.1409, False),
        ("1.571 + 1.571", 3.14395, True), ("1.571 + 1.571", 3.1441, False),
        ("1.571 - 1.571", 0.0014, True), ("1.571 - 1.571", 0.0016, False),
        ("1.571*0.500", 0.785398, True), ("1.571*0.500", 0.79, False),
        # A number is not an angle unless it is said to be one: this is 5 pi / 2.
        ("7.854", np.pi / 2, False),
        # Two figures are not rounded.
        ("1.5", 1.5001, False), ("0.05", 0.0501, False),
    ],
)  # fmt: skip
def test_a_decimal_is_rounded_or_cut_off(
    catalogue: Mapping[str, Exercise], text: str, true: float, expected: bool
) -> None:
    exercise = catalogue["stanford-arm"]
    entry = read(text, exercise.vocabulary)
    found = is_rounded(entry, np.full(SAMPLES, true), 1.0, draw(exercise, None))
    assert found is expected


@together(
    ("scale", "units", "expected"),
    # Rounding allows shifts from -0.500001 to 0.999 units, and a thousandth of the tolerance more.
    [(0.9, 0.9998, True), (0.9, 1.0, False), (0.4, -0.5003, True), (0.4, -0.5006, False)],
)
def test_floating_point_errors_may_enlarge_a_tiny_shift(
    catalogue: Mapping[str, Exercise], scale: float, units: float, expected: bool
) -> None:
    # The tolerance is nearly as large as a unit of the last place.
    exercise = catalogue["stanford-arm"]
    samples = draw(exercise, None)
    for text in ("1.000000001", "0 + 1.000000001"):
        entry = read(text, exercise.vocabulary)
        true = np.full(SAMPLES, 1.000000001 + units * 1e-9)
        assert is_rounded(entry, true, scale, samples) is expected


def test_a_rounded_decimal_is_the_same_at_all_samples(arm: Exercise) -> None:
    samples = draw(arm, None)
    for text in ("1.571", "0 + 1.571"):
        expected = np.full(SAMPLES, np.pi / 2)
        assert is_rounded(read(text, arm.vocabulary), expected, 1.0, samples)
        expected[3] -= 1e-4
        assert not is_rounded(read(text, arm.vocabulary), expected, 1.0, samples)


def test_an_entry_with_many_decimals_counts_as_exact(arm: Exercise) -> None:
    samples = draw(arm, None)
    for count, expected in ((MOST_ALONE, True), (MOST_ALONE + 1, False)):
        entry = read(" + ".join(["1.001"] * count), arm.vocabulary)
        true = np.full(SAMPLES, 1.001 * count + 0.0003)
        assert is_rounded(entry, true, 1.0, samples) is expected
        assert bool(rounding_slack(entry, samples)) is expected


@together(
    ("one", "other", "scale", "angle", "slack", "expected"),
    [
        # A thousandth of the size.
        (2.0 + 1.9e-3, 2.0, 2.0, False, 0.0, True), (2.0 + 2.1e-3, 2.0, 2.0, False, 0.0, False),
        (-2.0 + 1.9e-3, -2.0, 2.0, False, 0.0, True), (0.0, 1e-3, 1.0, False, 0.0, False),
        # Nothing but floating-point errors around 0.
        (0.9e-9, 0.0, 1.0, False, 0.0, True), (1.1e-9, 0.0, 1.0, False, 0.0, False),
        (1e-9, 0.0, 1.0, False, 0.0, True),
        (0.9e-7, 0.0, 100.0, False, 0.0, True), (1.1e-7, 0.0, 100.0, False, 0.0, False),
        # Of larger values, a thousandth of the robot's largest: 1.5 typical lengths, 4 radians.
        (100.0 + 1.4e-3, 100.0, 1.0, False, 0.0, True),
        (100.0 + 1.6e-3, 100.0, 1.0, False, 0.0, False),
        (100.0 + 2.9e-3, 100.0, 2.0, False, 0.0, True),
        (100.0 + 3.1e-3, 100.0, 2.0, False, 0.0, False),
        (100.0 + 3.9e-3, 100.0, 1.0, True, 0.0, True),
        (100.0 + 4.1e-3, 100.0, 1.0, True, 0.0, False),
        # A known error, but never more than a hundredth.
        (1.005, 1.0, 1.0, False, 0.006, True), (1.005, 1.0, 1.0, False, 0.004, False),
        (1.009, 1.0, 1.0, False, 0.5, True), (1.011, 1.0, 1.0, False, 0.5, False),
        (2 * np.pi + 0.5, 0.5, 1.0, True, 0.0, True),
        (4 * np.pi + 0.5, 0.5, 1.0, True, 0.0, True),
        # The floating-point error of ten thousand million.
        (1e10 + 0.9e-2, 1e10, 1.0, False, 0.0, True), (1e10 + 1.1e-2, 1e10, 1.0, False, 0.0, False),
        (np.nan, 1.0, 1.0, False, 0.0, False), (1.0, np.nan, 1.0, False, 0.0, False),
        (np.inf, 1.0, 1.0, False, 0.0, False), (1.0, np.inf, 1.0, False, 0.0, False),
    ],
)  # fmt: skip
def test_nearly_equal_values_differ_by_rounding(
    one: float, other: float, scale: float, angle: bool, slack: float, expected: bool
) -> None:
    with np.errstate(invalid="ignore"):
        values = np.full(4, one), np.full(4, other)
        assert same(*values, scale, angle, slack) is expected
        assert nearly_equal(*values, scale, angle, slack) == expected
        # One sample of four is enough to differ.
        single = values[1].copy()
        single[1] = one
        if not expected and np.isfinite(other):
            assert not same(single, values[1], scale, angle, slack)
            assert not nearly_equal(single, values[1], scale, angle, slack)


def test_the_defaults_of_a_comparison_are_a_length_of_scale_1() -> None:
    for scale, expected in ((1.4e-3, True), (1.6e-3, False)):
        one, other = np.array([100.0 + scale]), np.array([100.0])
        assert same(one, other) is expected
        assert nearly_equal(one, other) == expected


@together(
    ("text", "slack"),
    [
        ("1.571", 1e-3), ("-1.571", 1e-3), ("1.571 + 0.86603", 1.01e-3), ("15.71", 1e-2),
        ("3 * 1.571", 3e-3), ("pi/2", 0.0), ("1.5", 0.0), ("1.000 * 2.00", 2e-3 + 1e-2),
    ],
)  # fmt: skip
def test_the_slack_is_a_unit_of_each_decimal(
    catalogue: Mapping[str, Exercise], text: str, slack: float
) -> None:
    exercise = catalogue["stanford-arm"]
    found = rounding_slack(read(text, exercise.vocabulary), draw(exercise, None))
    assert found == pytest.approx(slack, rel=1e-9)


def test_the_slack_is_that_of_the_sample_with_the_largest_error(arm: Exercise) -> None:
    samples = draw(arm, None)
    entry = read("1.571 cos(theta1) - 0.866 theta2", arm.vocabulary)
    cosine, angle = np.cos(samples.values["theta1"]), samples.values["theta2"]
    expected = 1e-3 * (np.abs(cosine) + np.abs(angle)).max()
    assert rounding_slack(entry, samples) == pytest.approx(expected)


@together(
    ("effects", "error", "is_possible"),
    [
        # One unknown: from half a unit away from 0 to a whole unit.
        ([[1.0]], [0.9], True), ([[1.0]], [1.1], False),
        ([[1.0]], [-0.49], True), ([[1.0]], [-0.6], False),
        # Two unknowns with the same effect share it.
        ([[1.0, 1.0]], [1.9], True), ([[1.0, 1.0]], [2.1], False),
        ([[1.0, 1.0]], [-0.98], True), ([[1.0, 1.0]], [-1.1], False),
        # If the shares in proportion to the effects are too large, others take over.
        ([[1.0, 2.0]], [2.9], True),
        ([[1.0, 2.0]], [3.1], False),
        ([[1.0, 2.0]], [-1.4], True),
        ([[1.0, 2.0]], [-1.6], False),
        ([[1.0, -2.0, 4.0]], [5.8], True),
        ([[1.0, -2.0, 4.0]], [6.1], False),
        ([[4.0, 2.0, 1.0], [0.0, 2.0, -1.0]], [6.5, 0.8], True),
        ([[4.0, 2.0, 1.0], [0.0, 2.0, -1.0]], [6.5, 2.6], False),
        # This needs many projections: the shifts 0.95, 0.95 and 0.9 explain it.
        ([[4.0, -2.0, 1.0], [3.0, -2.0, -3.0]], [2.8, -1.75], True),
        # Each of two unknowns has an effect of its own.
        ([[1.0, 0.0], [0.0, 1.0]], [0.9, -0.4], True),
        ([[1.0, 0.0], [0.0, 1.0]], [-0.4, 0.9], True),
        ([[1.0, 0.0], [0.0, 1.0]], [0.9, -0.6], False),
        ([[1.0, 0.0], [0.0, 1.0]], [-0.6, 0.9], False),
        # The sum of both is 1.4, the difference 0.4 or 1.6: (0.9, 0.5), or (1.5, −0.1).
        ([[1.0, 1.0], [1.0, -1.0]], [1.4, 0.4], True),
        ([[1.0, 1.0], [1.0, -1.0]], [1.4, 1.6], False),
        # More errors than unknowns can explain.
        ([[1.0], [1.0]], [0.5, 0.5], True), ([[1.0], [1.0]], [0.5, 0.4], False),
        ([[1.0], [0.0]], [0.5, 1e-5], False),
        # Floating-point errors are left where no unknown has an effect.
        ([[1.0], [0.0]], [0.5, 1e-16], True), ([[1.0], [0.0]], [0.5, 0.9e-9], True),
        # The second unknown has a small effect, and is found in a later step.
        ([[1.0, 0.0], [0.0, 0.02]], [0.0, 0.01], True),
        ([[1.0, 0.0], [0.0, 3e-3]], [0.5, 1.5e-3], True),
        ([[1.0, 0.0], [0.0, 3e-8]], [0.5, 1.5e-8], True),
        ([[1.0, 0.0], [0.0, 3e-3]], [0.5, 3.2e-3], False),
        # An effect as small as floating-point errors explains nothing: the shifts are 0.5 each.
        ([[1.0, 1.0], [0.0, 1e-12]], [1.0, 5e-10], True),
    ],
)  # fmt: skip
def test_shifts_within_rounding_explain_an_error(
    effects: list[list[float]], error: list[float], is_possible: bool
) -> None:
    rates, wanted = np.array(effects), np.array(error)
    for unit in (1.0, 1e-3):
        units = np.full(rates.shape[1], unit)

        def left(shifts: np.ndarray, unit: float = unit) -> np.ndarray:
            return np.asarray(unit * (shifts @ rates.T - wanted))

        found = fitted_shifts(left, units, 1e-9)
        assert (found is not None) is is_possible
        if found is not None:
            assert np.abs(left(found)).max() <= 1e-9
            assert -0.501 < found.min() <= found.max() < 1.0


def test_a_fit_follows_a_bend_and_ends_where_nothing_is_finite() -> None:
    def bent(unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        [x, y] = unknowns
        return np.array([np.sin(x) - 0.3, y + x * x - 0.2]), np.array([[np.cos(x), 0], [2 * x, 1]])

    sizes = np.ones(2)
    for count in (1, 2):
        found = fitted_unknowns(bent, sizes, count, 1e-9)
        x = np.arcsin(0.3)
        assert found == pytest.approx([x, 0.2 - x * x], abs=1e-8)
    # Only the first unknown is bounded.
    far = fitted_unknowns(lambda u: (u - [0.5, 7.0], np.eye(2)), sizes, 1, 1e-9)
    assert far == pytest.approx([0.5, 7.0])
    assert fitted_unknowns(lambda u: (u - [0.5, 7.0], np.eye(2)), sizes, 2, 1e-9) is None
    far = fitted_unknowns(lambda u: (u - [0.5, 70.0], np.eye(2)), sizes, 1, 1e-9)
    assert far == pytest.approx([0.5, 70.0])
    # Three unknowns have the same effect, and two of them are bounded: the third takes the rest.
    rates = np.array([[1.0, 1.0, 1.0]])
    found = fitted_unknowns(lambda u: (rates @ u - 5.0, rates), np.ones(3), 2, 1e-9)
    assert found is not None
    assert found[:2].max() < 1.0
    assert rates @ found == pytest.approx(5.0)
    for value in (np.nan, np.inf):
        hole, bad = np.array([[1.0, 0.0], [0.0, value]]), np.array([0.1, value])
        for error, rates in ((np.full(2, 0.1), hole), (bad, np.eye(2))):
            given = error, rates
            assert fitted_unknowns(partial(_always, given), sizes, 1, 1e-9) is None


def _always(given: tuple[np.ndarray, np.ndarray], _: object) -> tuple[np.ndarray, np.ndarray]:
    return given


def test_the_steps_of_derivatives_are_half_a_unit_or_half_the_digits() -> None:
    found = difference_steps(np.array([1.0, 1e-3, 1e-9]))
    assert found == pytest.approx([0.5, 0.5, 1000.0])


def test_the_decimals_of_several_entries_move_together(arm: Exercise) -> None:
    samples = draw(arm, None)
    texts = ("pi", None, "15.71", "1.5", "0.866 + 0.50")
    entries = [None if text is None else read(text, arm.vocabulary) for text in texts]
    shared = SharedDecimals(entries, samples)
    assert shared.count == 2
    assert shared.units == pytest.approx([1e-2, 1e-3])
    values = np.full((len(texts), SAMPLES), 7.0)
    moved = shared.shifted(np.array([[0.0, 0.0], [1.0, -0.5]]), values)
    assert moved.shape == (2, len(texts), SAMPLES)
    # Entries without a decimal keep the given values.
    told = [[7.0, 7.0, 15.71, 7.0, 1.366], [7.0, 7.0, 15.72, 7.0, 1.3655]]
    assert moved[..., 0] == pytest.approx(np.array(told))
    assert np.ptp(moved, axis=-1).max() == 0.0
    assert (values == 7.0).all()


def test_too_many_decimals_are_not_tested_together(arm: Exercise) -> None:
    samples = Samples({})
    eight, one = (read(" + ".join(["1.001"] * n), arm.vocabulary) for n in (8, 1))
    most = [eight] * (MOST_TOGETHER // 8)
    assert SharedDecimals(most, samples).count == MOST_TOGETHER
    more = SharedDecimals([*most, one], samples)
    assert (more.count, len(more.units)) == (0, 0)
    assert more.shifted(np.zeros((1, 0)), np.ones((5, 3))).tolist() == np.ones((1, 5, 3)).tolist()
    sixteen = read(" + ".join(["1.001"] * MOST_ALONE), arm.vocabulary)
    assert SharedDecimals([sixteen], samples).count == MOST_ALONE
    # An entry with more decimals than are tested alone is left out.
    long = read(" + ".join(["1.001"] * (MOST_ALONE + 1)), arm.vocabulary)
    assert SharedDecimals([long, one], samples).count == 1
