"""A wrong row does not make other rows wrong."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise

from tests.frame_choice.robots import GIVEN, Robot, exercise
from tests.frame_choice.rows.one_row import (
    Found,
    WrongRow,
    all_robots,
    lines,
    praises,
    run,
    total,
)
from tests.frame_choice.rows.student_rows import is_valid_when_rounded, shipped_robots
from tests.frame_choice.trials import grade_rows
from tests.grading.support.submitting import graded_table, not_correct

UNSEEN, EACH = 6, 10

RRRP = [
    ("l2", "0", "l1", "q1"),
    ("l3", "180deg", "0", "q2"),
    ("0", "0", "l4", "q3"),
    ("0", "0", "q4", "0"),
]
STANFORD = [
    ("0", "-90deg", "0", "theta1"),
    ("0", "90deg", "d2", "theta2"),
    ("0", "0", "d3", "0"),
    ("0", "-90deg", "0", "theta4"),
    ("0", "90deg", "0", "theta5"),
    ("0", "0", "d6", "theta6"),
]
Row = tuple[str, str, str, str]
WRONG_ROWS: list[tuple[str, list[Row], int, Row]] = [
    ("rrrp", RRRP, 3, ("l3", "90deg", "0", "q4")),
    ("rrrp", RRRP, 3, ("0.3", "40deg", "q4", "0")),
    ("stanford-arm", STANFORD, 2, ("0.3", "40deg", "d6", "0")),
]


@pytest.fixture(scope="module")
def sample() -> Found:
    numbers = range(len(shipped_robots()) + UNSEEN)
    return run(numbers, EACH, seed=2, unseen=UNSEEN, policies=(GIVEN,))


@pytest.mark.long
def test_right_cells_of_other_rows_stay_right(sample: Found) -> None:
    robots = all_robots(UNSEEN, 2)
    assert total(sample, "") > 0.8 * EACH * len(robots)
    assert total(sample, "accepted") == 0, "\n".join(sample.misses)
    for said in ("reddened", "praised"):
        assert total(sample, said) <= 1, "\n".join(sample.misses)


def test_the_figures_fail_beyond_their_limits() -> None:
    found = Found()
    found.counts.update({"usual frames, 4 wrong": 1000, "usual frames, 4 wrong: reddened": 5})
    assert not [line for line in lines(found) if "FAILS" in line]
    found.counts["usual frames, 4 wrong: reddened"] += 1
    assert [line.split(":")[0] for line in lines(found) if "FAILS" in line] == ["reddened"]


def test_frames_implied_by_a_wrong_row_next_to_a_missing_one_are_not_praised() -> None:
    rows = (
        ("0", "-pi/2", "l1", "q1"),
        ("0", "-pi/2", "0", "q2"),
        ("0", "0", "0", "q3"),
        ("l2", "0", "0", "q4"),
        ("0", "0", "l2", "0"),
    )
    robot = Robot("RRRR", "RRRR", "modified", ("q1", "q2", "q3", "q4"), rows, ("l1", "l2"))
    wrong = [rows[0], ("0.5", "-pi/2", "0.4", "0"), rows[2], ("l2", "0", "l2", "q4")]
    report = grade_rows(exercise(robot, GIVEN), [list(row) for row in wrong], "modified")
    assert not praises(report)


@pytest.mark.parametrize(
    ("exercise_id", "right", "number", "wrong"),
    WRONG_ROWS,
    ids=[f"{case[0]} {' '.join(case[3])}" for case in WRONG_ROWS],
)
def test_a_wholly_wrong_row_does_not_make_other_rows_wrong(
    exercise_id: str,
    right: list[Row],
    number: int,
    wrong: Row,
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [wrong if i == number else row for i, row in enumerate(right, start=1)]
    report = graded_table(catalogue[exercise_id], rows)
    assert {row for row, _ in not_correct(report)} == {str(number)}
    assert "own_frame_choice" not in [message.code for message in report.feedback]
    rows[number - 1] = ("", "", "", "")
    assert report.points >= graded_table(catalogue[exercise_id], rows).points > 0


PLANAR = Robot(
    "RR",
    "RR",
    "modified",
    ("q1", "q2"),
    (("0.267", "0", "0.184", "q1+pi/2"), ("0.4833", "0", "0.4995", "q2"), ("0", "-pi/2", "0", "0")),
    (),
)
LETTERS = (("0", "0", "0", "q1"), ("l1", "0", "0", "q2"))
# The offsets of parallel axes add up to 0.6835. A number of three figures may be rounded (0.1835 is
# 0.184) or cut off (0.1849 is 0.184); one of two figures is exact.
OFFSETS = [
    ("0.184", "0.5", True),
    ("0.184", "0.498", True),
    ("0.184", "0.5001", False),
    ("0.184", "0.49", False),
    ("0.18", "0.5", False),
    ("0.18", "0.50", False),
    ("0.183", "0.500", True),
    ("0.185", "0.500", False),
]


@pytest.mark.parametrize(("first", "second", "is_valid"), OFFSETS)
def test_a_table_is_right_if_true_numbers_make_it_valid(
    first: str, second: str, is_valid: bool
) -> None:
    texts = [["0.267", "0", first, "q1 + pi/2"], ["0.4833", "0", second, "q2"], [*PLANAR.rows[2]]]
    assert is_valid_when_rounded(PLANAR, GIVEN, texts, "modified") == is_valid
    report = grade_rows(exercise(PLANAR, GIVEN), texts, "modified")
    assert (report.points == report.max_points) == is_valid


def test_full_marks_are_a_fault_unless_rounding_explains_them() -> None:
    rows = [list(row) for row in PLANAR.rows]
    by_rounding = [rows[0], ["0.4833", "0", "0.5", "q2"], rows[2]]
    letters = Robot("RR", "RR", "modified", ("q1", "q2"), LETTERS, ("l1",))
    exact = [list(row) for row in letters.rows]
    found = Found()
    found.judge(WrongRow(PLANAR, GIVEN, "modified", rows, by_rounding, 1, 1, usual=True))
    found.judge(WrongRow(letters, GIVEN, "modified", exact, exact, 1, 1, usual=True))
    assert (total(found, "valid when rounded"), total(found, "accepted")) == (1, 1)
