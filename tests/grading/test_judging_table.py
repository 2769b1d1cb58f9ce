"""Test how a table is judged."""

from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Place, Severity, Submission, Verdict, grade

from tests.grading.support.robots import EXACT, PLANAR_RRR, ROBOTS, SCARA, STANFORD, Robot, Row
from tests.grading.support.submitting import (
    UNIT,
    about,
    full_marks,
    graded_table,
    handed_in,
    not_correct,
    part,
    points,
    table,
)

# --- Grade tables with missing, extra or exchanged rows

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


# --- Test the message that says with which joints the rows were compared

ROWS = list(SCARA.rows)
ZERO: Row = ("0", "0", "0", "0")


@pytest.fixture
def scara(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["scara"]


def told(exercise: Exercise, rows: list[Row]) -> str:
    report = graded_table(exercise, rows, "degrees")
    return " ".join(each.message for each in report.feedback if each.code == "rows_matched")


def test_rows_after_a_missing_one_are_named(scara: Exercise) -> None:
    message = told(scara, [ROWS[0], *ROWS[2:]])
    assert "Your rows were compared in this way: row 2 with joint 3, row 3 with joint 4." in message
    assert "row 1" not in message


def test_rows_after_an_extra_one_are_named(scara: Exercise) -> None:
    message = told(scara, [ROWS[0], ("7", "1", "7", "7"), *ROWS[1:]])
    assert "row 3 with joint 2, row 4 with joint 3" in message
    assert "row 5 with joint 4" in message


def test_equal_rows_are_told_apart(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["rrrp-drawn"]
    reference = exercise.robot.tables[exercise.robot.convention]
    rows = [[formula.source for formula in row] for row in reference.rows]
    report = graded_table(exercise, [*rows[:3], rows[2], rows[3]])
    [message] = [each.message for each in report.feedback if each.code == "rows_matched"]
    assert message == "Your rows were compared in this way: row 5 with joint 4."


def test_a_length_put_in_twice_is_an_extra_row(catalogue: Mapping[str, Exercise]) -> None:
    # Without row 5 the table is right, so no cell is wrong, and the row costs a unit of 2 points.
    #
    # The four rows have 3 units, 2 points each, and half a point for each row (docs/marks.md).
    exercise = catalogue["planar-rrr"]
    reference = exercise.robot.tables[exercise.robot.convention]
    rows = [[formula.source for formula in row] for row in reference.rows]
    report = graded_table(exercise, [*rows, rows[-1]])
    assert report.points == 8 - 2
    assert [message.code for message in report.feedback] == ["extra_row"]
    assert {row.verdict for row in report.rows} == {Verdict.CORRECT}
    # A row that cannot be read may be 0.
    unread = graded_table(exercise, [*rows, ["?", "0", "0", "0"]])
    assert "extra_row" not in [message.code for message in unread.feedback]


@pytest.mark.parametrize("rows", [ROWS, [*ROWS, ZERO], ROWS[:3], [ROWS[0], ROWS[2], *ROWS[2:]]])
def test_rows_in_their_places_get_no_message(rows: list[Row], scara: Exercise) -> None:
    assert told(scara, rows) == ""


def test_an_end_row_in_its_place_gets_no_message(
    catalogue: Mapping[str, Exercise],
) -> None:
    # The modified table of the planar arm has a row "e" in its expected place.
    exercise = catalogue["planar-rrr"]
    reference = exercise.robot.tables[exercise.robot.convention]
    assert reference.labels[-1] == "e"
    rows = [[formula.source for formula in row] for row in reference.rows]
    report = graded_table(exercise, rows)
    assert [each.code for each in report.feedback if each.code == "rows_matched"] == []


def test_each_fixed_row_before_the_last_joint_has_a_label_of_its_own(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = "a1, 0, 0, q1\n0, 0, 1, 0\n0, 0, -1, 0\na2, 0, 0, q2"
    report = grade(catalogue["planar-rr"], Submission({"table": rows})).parts[0]
    assert [row.label for row in report.rows] == ["1", "0", "0b", "2"]
    [message] = [each.message for each in report.feedback if each.code == "rows_matched"]
    assert "row 2 with the fixed row 0 before the last joint" in message
    assert "row 3 with the fixed row 0b before the last joint" in message


# --- Choose the convention of a table if the exercise allows both

ANTHROPOMORPHIC = """
title = "Anthropomorphic arm"
source = "Siciliano et al., Robotics, 2.9.3"
statement = "Frames are free."
[robot]
structure = "RRR"
convention = "standard"
joints = ["theta1", "theta2", "theta3"]
table = [
    ["0", "90deg", "0", "theta1"], ["a2", "0", "0", "theta2"], ["a3", "0", "0", "theta3"],
]
[symbols]
a2 = { kind = "length", description = "first link" }
a3 = { kind = "length", description = "second link" }
[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
convention = "either"
frames = "FRAMES"
"""
STANDARD = [
    ("0", "90deg", "0", "theta1"),
    ("a2", "0", "0", "theta2"),
    ("a3", "0", "0", "theta3"),
]
# Converted by hand: the columns a and alpha are one row lower, and the last row is fixed.
MODIFIED = [
    ("0", "0", "0", "theta1"),
    ("0", "90deg", "0", "theta2"),
    ("a2", "0", "0", "theta3"),
    ("a3", "0", "0", "0"),
]


def pasted(rows: list[tuple[str, ...]]) -> str:
    return "\n".join(map(", ".join, [("a", "alpha", "d", "theta"), *rows]))


@pytest.fixture(params=["given", "free"])
def arm(request: pytest.FixtureRequest, make_exercise: Callable[[str], Exercise]) -> Exercise:
    return make_exercise(ANTHROPOMORPHIC.replace("FRAMES", request.param))


def graded(exercise: Exercise, answer: object) -> PartReport:
    return part(handed_in(exercise, {"table": answer}), "table")


def taken(report: PartReport) -> list[str]:
    found = [each for each in report.feedback if each.code == "convention_taken"]
    assert all(each.severity is Severity.INFO for each in found)
    return [name for each in found for name in ("standard", "modified") if name in each.message]


@pytest.mark.parametrize(("rows", "name"), [(STANDARD, "standard"), (MODIFIED, "modified")])
def test_the_convention_that_fits_is_chosen_and_named(
    rows: list[tuple[str, ...]], name: str, arm: Exercise
) -> None:
    for answer in (table(rows), pasted(rows), {"rows": pasted(rows)}):
        report = graded(arm, answer)
        assert full_marks(report)
        assert taken(report) == [name]
        slip = [*rows[:-1], ("2*a3", *rows[-1][1:])]
        wrong = graded(arm, table(slip))
        assert list(not_correct(wrong)) == [("3" if name == "standard" else "e", "a")]
        assert taken(wrong) == [name]


def test_a_tie_is_judged_in_the_convention_of_the_reference(arm: Exercise) -> None:
    assert taken(graded(arm, table([("7", "7", "7", "7")] * 3))) == ["standard"]


def test_a_named_convention_is_used(arm: Exercise) -> None:
    report = graded(arm, {**table(MODIFIED), "convention": "standard"})
    assert report.verdict is not Verdict.CORRECT
    assert taken(report) == []
    assert full_marks(graded(arm, {**table(MODIFIED), "convention": "modified"}))


def test_a_script_names_its_convention(arm: Exercise) -> None:
    links = [f"Link([0 {d} {a} {alpha.replace('90deg', 'pi/2')}])" for a, alpha, d, _ in STANDARD]
    report = graded(arm, f"SerialLink([{' '.join(links)}])")
    assert full_marks(report)
    assert taken(report) == []
    modified = {"rows": f"SerialLink([{' '.join(links)}])", "convention": "modified"}
    assert not full_marks(graded(arm, modified))


def test_a_part_with_a_fixed_convention_chooses_none(catalogue: Mapping[str, Exercise]) -> None:
    rows = [("a1", "0", "0", "theta1"), ("a2", "0", "0", "theta2")]
    assert taken(graded(catalogue["planar-rr"], table(rows))) == []
