"""Grade matrices entry by entry."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Place, Verdict
from dh_grader.grading.report import messages_of

from tests.grading.support.robots import PLANAR_RRR
from tests.grading.support.submitting import (
    cell,
    codes_at,
    full_marks,
    graded_pose,
    not_correct,
)
from tests.together import together

POSE = [
    ["c123", "-s123", "0", "l1 c1 + l2 c12 + l3 c123"],
    ["s123", "c123", "0", "l1 s1 + l2 s12 + l3 s123"],
    ["0", "0", "1", "0"],
    ["0", "0", "0", "1"],
]


@pytest.fixture
def arm(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue[PLANAR_RRR.exercise]


def with_entry(i: int, j: int, text: object) -> list[list[object]]:
    matrix: list[list[object]] = [list(line) for line in POSE]
    matrix[i][j] = text
    return matrix


PLACES = [(i, j) for i in range(4) for j in range(4)]


@together(("i", "j"), PLACES)
@together(
    ("text", "verdict", "code"),
    [
        ("0.05", Verdict.INCORRECT, "value"),
        ("q1 + l1", Verdict.INCORRECT, "quantity"),
        ("sqrt(-1)", Verdict.INCORRECT, "undefined"),
        ("c124", Verdict.UNREADABLE, "not_revolute"),
        ("(c1", Verdict.UNREADABLE, "unbalanced_bracket"),
        ("", Verdict.MISSING, "missing"),
        (None, Verdict.MISSING, "missing"),
        (["0"], Verdict.UNREADABLE, "wrong_type"),
        (True, Verdict.UNREADABLE, "wrong_type"),
    ],
)
def test_a_bad_entry_affects_only_itself(
    i: int, j: int, text: object, verdict: Verdict, code: str, arm: Exercise
) -> None:
    report = graded_pose(arm, with_entry(i, j, text))
    place = (str(i + 1), str(j + 1))
    assert not_correct(report) == {place: verdict}
    # Four entries of the rotation and two of the position differ from the identity; each half is
    # worth 4 points. A wrong or empty entry costs a unit. In the bottom row, it costs a fifth: 0.2
    # and 0.4 points, in quarters; so does an unread entry that is no content cell.
    known = POSE[i][j] not in ("0", "1")
    unit, fifth = (2.0, 0.5) if j == 3 else (1.0, 0.25)
    is_cheap = i == 3 or (verdict is Verdict.UNREADABLE and not known)
    cost = fifth if is_cheap else unit
    assert report.points == report.max_points - cost
    assert sum(row.points for row in report.rows) == pytest.approx(report.points, abs=1e-5)
    if i == 3 and verdict is Verdict.INCORRECT and code != "undefined":
        code = "bottom_row"
    elif code == "value" and known:
        code = "independent_of"
    elif code == "quantity" and POSE[i][j] == "0":
        # An expected 0 fits every quantity: the message is on the joint variable.
        code = "joint_variable_extra"
    assert (code, (Place(*place),)) in [(m.code, places) for m, places, _ in messages_of(report)]


SLIPS = [
    (0, 3, "l1 c1 + l2 c2 + l3 c3"),
    (0, 3, "l1 s1 + l2 s12 + l3 s123"),
    (0, 3, "l1 c1 + l2 c12"),
    (0, 3, "l1 c1 + l2 c12 - l3 c123"),
    (1, 3, "-(l1 s1 + l2 s12 + l3 s123)"),
    (0, 0, "c1 c2 c3"),
    (0, 0, "c1 + c2 + c3"),
    (0, 0, "s123"),
    (0, 1, "s123"),
    (2, 2, "-1"),
    (3, 3, "0"),
    (3, 3, "2"),
    (2, 3, "l1"),
]


@pytest.mark.parametrize(("i", "j", "text"), SLIPS)
def test_a_slip_in_an_entry_is_named(i: int, j: int, text: str, arm: Exercise) -> None:
    report = graded_pose(arm, with_entry(i, j, text))
    assert not_correct(report) == {(str(i + 1), str(j + 1)): Verdict.INCORRECT}
    codes_said = {m.code for m in (*report.rows[i].cells[j].feedback, *report.feedback)}
    assert codes_said
    negated = f"-({POSE[i][j]})".replace("-(-s123)", "s123").replace("-(1)", "-1")
    assert ("sign" in codes_said) is (text == negated)


def test_a_whole_matrix_of_unreadable_entries_is_not_gradable(arm: Exercise) -> None:
    report = graded_pose(arm, [["?"] * 4] * 4)
    assert report.verdict is Verdict.UNREADABLE
    assert [row.verdict for row in report.rows] == [Verdict.UNREADABLE] * 4


def test_three_rows_leave_the_fourth_missing(arm: Exercise) -> None:
    # The missing bottom row of a 3×4 matrix is reported; the other rows are graded.
    report = graded_pose(arm, POSE[:3])
    assert [row.verdict for row in report.rows] == [Verdict.CORRECT] * 3 + [Verdict.MISSING]
    # The row has no content cell, so that it costs a fifth of a unit in each half.
    assert report.points == 8 - (0.25 + 0.5)
    assert report.verdict is Verdict.PARTIAL


@pytest.mark.parametrize("entries", [["0", "0", "0"], ["0"] * 5, "0 0 0 1", 1, {"1": "0"}])
def test_a_row_of_the_wrong_length_affects_only_itself(entries: object, arm: Exercise) -> None:
    report = graded_pose(arm, [*POSE[:3], entries])
    assert [row.verdict for row in report.rows] == [Verdict.CORRECT] * 3 + [Verdict.UNREADABLE]
    assert codes_at(report, "4", "1") == ["row_length"]


@pytest.mark.parametrize("matrix", [[*POSE, ["0", "0", "0", "1"]], [[*line, "0"] for line in POSE]])
def test_a_fifth_row_or_column_is_refused(matrix: object, arm: Exercise) -> None:
    report = graded_pose(arm, matrix)
    assert report.verdict is Verdict.UNREADABLE
    assert report.points == 0


def test_numbers_need_not_be_text(arm: Exercise) -> None:
    matrix = [[int(text) if text in ("0", "1") else text for text in line] for line in POSE]
    assert full_marks(graded_pose(arm, matrix))


def test_a_counterexample_shows_the_students_own_number(arm: Exercise) -> None:
    report = graded_pose(arm, with_entry(2, 3, "2 l1"))
    [feedback] = cell(report, "3", "4").feedback
    assert feedback.values is not None
    assert set(feedback.values) == {"l1", "yours", "expected"}
    assert feedback.values["expected"] == 0
    assert feedback.values["yours"] == pytest.approx(2 * float(feedback.values["l1"]), abs=2e-3)


def test_an_undefined_entry_is_shown_with_its_joint_values(arm: Exercise) -> None:
    report = graded_pose(arm, with_entry(0, 0, "sqrt(q1) + l2"))
    [feedback] = cell(report, "1", "1").feedback
    assert feedback.code == "undefined"
    assert feedback.values is not None
    assert set(feedback.values) == {"q1", "l2"}
    assert float(feedback.values["q1"]) < 0
    assert f"q1 = {feedback.values['q1']:g}" in feedback.message
