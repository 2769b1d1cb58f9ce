"""Grade tables with missing, extra or exchanged rows."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Place, Severity, Verdict

from tests.grading.support.robots import EXACT, PLANAR_RRR, ROBOTS, STANFORD, Robot, Row
from tests.grading.support.submitting import (
    full_marks,
    graded_table,
    handed_in,
    not_correct,
    part,
    table,
)
from tests.grading.support.worth import UNIT, about, points

NOTHING: Row = ("0", "0", "0", "0")


def codes(report: PartReport) -> list[str]:
    return [each.code for each in report.feedback if each.severity is not Severity.INFO]


def verdicts(report: PartReport) -> list[Verdict]:
    return [row.verdict for row in report.rows]


MISSING_ROWS = [(robot, i) for robot in ROBOTS for i in range(len(robot.rows))]


@pytest.mark.parametrize(
    ("robot", "missing"),
    MISSING_ROWS,
    ids=[f"{robot.exercise} {robot.labels[i]}" for robot, i in MISSING_ROWS],
)
def test_a_missing_row_costs_only_that_row(
    robot: Robot, missing: int, given_frames: Mapping[str, Exercise]
) -> None:
    rows = EXACT.rows(robot)
    del rows[missing]
    report = graded_table(given_frames[robot.exercise], rows)
    expected = [Verdict.CORRECT] * len(robot.rows)
    expected[missing] = Verdict.MISSING
    assert verdicts(report) == expected
    kept = points(robot, [missing] * 4)
    assert [row.points for row in report.rows] == about(kept)
    label = robot.labels[missing]
    assert codes(report) == ["missing_tool_row" if label == "e" else "missing_row"]
    assert report.feedback[0].places == (Place(label),)
    assert report.feedback[0].severity is Severity.ERROR


@pytest.mark.parametrize("place", range(7))
def test_an_extra_row_costs_as_much_as_a_wrong_cell(
    place: int, given_frames: Mapping[str, Exercise]
) -> None:
    rows = EXACT.rows(STANFORD)
    rows.insert(place, ("1", "45deg", "1", "1"))
    report = graded_table(given_frames[STANFORD.exercise], rows)
    assert verdicts(report) == [Verdict.CORRECT] * 6
    assert report.verdict is Verdict.PARTIAL
    assert report.points == 12 - UNIT[STANFORD.exercise]
    assert sum(row.points for row in report.rows) == pytest.approx(report.points, abs=1e-5)
    assert codes(report) == ["extra_row"]
    assert f"Row {place + 1} " in report.feedback[0].message


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.exercise)
def test_rows_of_zeros_at_the_end_move_nothing(
    robot: Robot, given_frames: Mapping[str, Exercise]
) -> None:
    rows = EXACT.rows(robot)
    while len(rows) < 12:
        rows.append(NOTHING)
        report = graded_table(given_frames[robot.exercise], rows)
        assert full_marks(report)
        assert report.feedback == ()


def test_a_row_of_zeros_in_the_middle_is_extra(given_frames: Mapping[str, Exercise]) -> None:
    rows = EXACT.rows(STANFORD)
    rows.insert(3, NOTHING)
    report = graded_table(given_frames[STANFORD.exercise], rows)
    assert verdicts(report) == [Verdict.CORRECT] * 6
    assert codes(report) == ["extra_row"]
    assert "Row 4 " in report.feedback[0].message


def test_twelve_rows_are_read_and_thirteen_are_not(given_frames: Mapping[str, Exercise]) -> None:
    exercise = given_frames[STANFORD.exercise]
    wrong: Row = ("1", "1", "1", "1")
    twelve = graded_table(exercise, [*EXACT.rows(STANFORD), *[wrong] * 6])
    assert verdicts(twelve) == [Verdict.CORRECT] * 6
    assert twelve.points == 12 - 6 * UNIT[STANFORD.exercise]
    assert codes(twelve).count("extra_row") == 6
    thirteen = graded_table(exercise, [*EXACT.rows(STANFORD), *[NOTHING] * 7])
    assert (thirteen.verdict, thirteen.rows) == (Verdict.UNREADABLE, ())
    assert codes(thirteen) == ["too_many_rows"]
    assert "12" in thirteen.feedback[0].message
    assert "13" in thirteen.feedback[0].message


def test_extra_rows_cost_at_most_all_points(given_frames: Mapping[str, Exercise]) -> None:
    report = graded_table(given_frames[PLANAR_RRR.exercise], [("1", "1", "1", "1")] * 12)
    assert report.points == 0
    assert report.verdict in (Verdict.INCORRECT, Verdict.PARTIAL)


@pytest.mark.parametrize("i", range(5))
def test_exchanged_rows_are_wrong_in_the_cells_that_differ(
    i: int, given_frames: Mapping[str, Exercise]
) -> None:
    rows = EXACT.rows(STANFORD)
    rows[i], rows[i + 1] = rows[i + 1], rows[i]
    report = graded_table(given_frames[STANFORD.exercise], rows)
    right = {str(label) for label in range(1, 7)} - {str(i + 1), str(i + 2)}
    assert {row.label for row in report.rows if row.verdict is Verdict.CORRECT} == right
    assert [row.label for row in report.rows] == list(STANFORD.labels)


def test_a_table_without_rows_is_missing(given_frames: Mapping[str, Exercise]) -> None:
    report = handed_in(given_frames[STANFORD.exercise], {"table": table([])})
    found = part(report, "table")
    assert (found.verdict, found.points) == (Verdict.MISSING, 0)
    assert report.gradable is False


def test_a_missing_and_an_extra_row_are_judged_in_place(
    given_frames: Mapping[str, Exercise],
) -> None:
    # There are as many rows as joints, so that each row is judged in its place.
    rows = [*EXACT.rows(STANFORD)[:5], ("1", "1", "1", "1")]
    report = graded_table(given_frames[STANFORD.exercise], rows)
    assert {label for label, _ in not_correct(report)} == {"6"}


@pytest.mark.parametrize("named", ["standard", "Distal ", "classic"])
def test_the_table_may_name_its_convention(
    named: str, given_frames: Mapping[str, Exercise]
) -> None:
    answer = table(EXACT.rows(STANFORD)) | {"convention": named}
    report = handed_in(given_frames[STANFORD.exercise], {"table": answer})
    assert full_marks(part(report, "table"))


@pytest.mark.parametrize("named", ["distel", 5, [], True, "\ud800"])
def test_an_unknown_convention_is_ignored_with_a_message(
    named: object, given_frames: Mapping[str, Exercise]
) -> None:
    answer = table(EXACT.rows(STANFORD)) | {"convention": named}
    found = part(handed_in(given_frames[STANFORD.exercise], {"table": answer}), "table")
    assert full_marks(found)
    assert codes(found) == ["unknown_convention"]
    assert found.feedback[0].severity is Severity.WARNING


def test_a_large_offset_does_not_widen_the_tolerance(
    catalogue: Mapping[str, Exercise],
) -> None:
    # Along parallel axes any offset is valid, but a huge one must not hide a wrong cell.
    for first, second in (("1000.0", "-999.5"), ("5.0", "-4.996"), ("5000.0", "-5000.0 + a1")):
        rows = [["a1", "0", first, "theta1"], ["a2", "0", second, "theta2"]]
        report = graded_table(catalogue["planar-rr"], rows)
        assert report.points < report.max_points
    exact = [["a1", "0", "1000.0", "theta1"], ["a2", "0", "-1000.0", "theta2"]]
    report = graded_table(catalogue["planar-rr"], exact)
    assert report.points == report.max_points
