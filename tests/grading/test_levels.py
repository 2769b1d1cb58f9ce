"""Test what the levels of feedback tell, and that it is told once."""

import json
from collections.abc import Mapping
from importlib.metadata import version
from typing import Any

import pytest
from dh_grader.catalogue import Exercise, FeedbackLevel, least
from dh_grader.grading import (
    CellReport,
    Correction,
    Feedback,
    PartReport,
    Place,
    ReadEntry,
    Report,
    RowReport,
    Severity,
    Submission,
    Verdict,
    grade,
)
from dh_grader.grading.report import messages_of, with_shared_messages

from tests.grading.support.robots import EXACT, STANFORD
from tests.grading.support.submitting import as_data, cell, handed_in, not_correct, part, row, table

# --- Test the feedback levels of reports: full, hints, verdicts, score


def answers() -> dict[str, Any]:
    rows: list[list[Any]] = [list(row) for row in EXACT.rows(STANFORD)]
    rows[0][1] = "pi/2"  # the sign
    rows[1][2] = "d6"  # another length
    rows[2][0] = "(d2"  # cannot be read
    rows[3][3] = ""  # left out
    rows[4][1] = "1.5708"  # rounded
    pose = [["0.05"] * 4, ["1/0"] * 4, ["sin("] * 4, ["0", "0", "0", "1"]]
    return {"table": table(rows), "pose": pose}


def messages(report: Report) -> list[Feedback]:
    return [message for part in report.parts for message, *_ in messages_of(part)]


@pytest.fixture
def reports(given_frames: Mapping[str, Exercise]) -> dict[FeedbackLevel, Report]:
    exercise = given_frames[STANFORD.exercise]
    return {level: handed_in(exercise, answers(), feedback=level) for level in FeedbackLevel}


def test_points_and_verdicts_are_the_same_at_every_level(
    reports: dict[FeedbackLevel, Report],
) -> None:
    summaries = {
        (report.points, report.score, tuple((p.verdict, p.points) for p in report.parts))
        for report in reports.values()
    }
    assert len(summaries) == 1


def test_full_gives_corrections_and_the_right_number(reports: dict[FeedbackLevel, Report]) -> None:
    full = reports[FeedbackLevel.FULL]
    [twist] = cell(part(full, "table"), "1", "alpha").feedback
    assert twist.correction == Correction("-pi/2", r"-\frac{\pi}{2}")
    [offset] = cell(part(full, "table"), "2", "d").feedback
    assert offset.correction == Correction("d2", "d_{2}")
    assert offset.values is not None
    assert isinstance(offset.values["expected"], float)
    assert offset.values["yours"] == offset.values["d6"]


def test_hints_are_the_same_messages_without_corrections(
    reports: dict[FeedbackLevel, Report],
) -> None:
    hints, full = reports[FeedbackLevel.HINTS], reports[FeedbackLevel.FULL]
    assert [(m.code, m.message) for m in messages(hints)] == [
        (m.code, m.message) for m in messages(full)
    ]
    assert not [m for m in messages(hints) if m.correction]
    assert not [p for m in messages(hints) for p in m.places or () if p.correction]
    [offset] = cell(part(hints, "table"), "2", "d").feedback
    assert offset.values is not None
    assert set(offset.values) == {"d6", "yours"}


READING = {"unbalanced_bracket", "missing"}


def test_verdicts_has_verdicts_and_reading_messages_only(
    reports: dict[FeedbackLevel, Report],
) -> None:
    verdicts, full = reports[FeedbackLevel.VERDICTS], reports[FeedbackLevel.FULL]
    assert {m.code for m in messages(verdicts)} == READING
    for name in ("table", "pose"):
        assert not_correct(part(verdicts, name)) == not_correct(part(full, name))


def test_score_has_reading_messages_only(
    reports: dict[FeedbackLevel, Report],
) -> None:
    score = reports[FeedbackLevel.SCORE]
    assert all(part.rows == () for part in score.parts)
    found = messages(score)
    assert {m.code for m in found} == READING
    assert [m.places for m in part(score, "table").feedback] == [
        (Place("3", "a"),),
        (Place("4", "theta"),),
    ]  # fmt: skip
    assert [m.places for m in part(score, "pose").feedback] == [
        (Place("3", str(column)),) for column in range(1, 5)
    ]
    assert not [m for m in found if m.values]


def test_a_repair_of_the_text_is_offered_at_every_level(
    reports: dict[FeedbackLevel, Report],
) -> None:
    for report in reports.values():
        [message] = [m for m in messages(report) if m.suggestion == "(d2)"]
        assert message.code == "unbalanced_bracket"
        assert "(d2)" not in message.message
        assert message.span == (0, 1)


def test_a_report_names_its_level_and_the_program(reports: dict[FeedbackLevel, Report]) -> None:
    for level, report in reports.items():
        assert report.feedback is level
        assert report.grader == version("dh-grader")


@pytest.mark.parametrize(
    "level", [FeedbackLevel.HINTS, FeedbackLevel.VERDICTS, FeedbackLevel.SCORE]
)
def test_the_reference_is_never_shown_below_full(
    level: FeedbackLevel, given_frames: Mapping[str, Exercise]
) -> None:
    # The message on a wrong length does not contain the correct length.
    rows = [list(cells) for cells in EXACT.rows(STANFORD)]
    rows[1][2] = "0"
    rows[5][2] = "0"
    report = handed_in(given_frames[STANFORD.exercise], {"table": table(rows)}, feedback=level)
    told = json.dumps(as_data(report)["parts"])
    assert "d2" not in told
    assert "d6" not in told


def test_a_missing_row_is_named_by_its_label(given_frames: Mapping[str, Exercise]) -> None:
    answers = {"table": table(EXACT.rows(STANFORD)[:5])}
    exercise = given_frames[STANFORD.exercise]
    hints = handed_in(exercise, answers, feedback=FeedbackLevel.HINTS)
    [message] = part(hints, "table").feedback
    assert (message.code, message.places) == ("missing_row", (Place("6"),))
    verdicts = handed_in(exercise, answers, feedback=FeedbackLevel.VERDICTS)
    assert row(part(verdicts, "table"), "6").verdict is Verdict.MISSING
    assert part(verdicts, "table").feedback == ()


def test_the_lowest_of_several_levels_counts() -> None:
    full, hints, verdicts, score = FeedbackLevel
    assert least(full, hints) is hints
    assert least(score, full, verdicts) is score
    assert least(verdicts) is verdicts


# --- one slip, one message


def test_a_shared_message_is_shown_once_with_its_places(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [["7", "0", "0", "q1"], ["7", "0", "0", "q2"], ["l2", "0", "0", "q3"]]
    tool = ["l3", "0", "0", "0"]
    exercise = catalogue["planar-rrr"]
    report = part(handed_in(exercise, {"table": table([*rows, tool])}), "table")
    assert set(not_correct(report)) == {("1", "a"), ("2", "a")}
    rows[0][0] = "0"
    rows[2][0] = "7"
    report = part(handed_in(exercise, {"table": table([*rows, tool])}), "table")
    [message] = report.feedback
    assert message.places == (
        Place("2", "a", Correction("l1", "l_{1}")),
        Place("3", "a", Correction("l2", "l_{2}")),
    )
    assert message.correction is None
    assert not [m for row in report.rows for cell in row.cells for m in cell.feedback]


def test_a_shared_correction_is_part_of_the_message() -> None:
    same = Correction("0", "0")
    told = Feedback("x", Severity.ERROR, "No.", correction=same)
    report = with_shared_messages(
        one_row(tuple(CellReport(c, Verdict.INCORRECT, (told,)) for c in "ad"))
    )
    [message] = report.feedback
    assert message.correction == same
    assert message.places == (Place("1", "a"), Place("1", "d"))
    assert [cell.feedback for cell in report.rows[0].cells] == [(), ()]


def test_a_message_with_a_span_stays_with_its_cell() -> None:
    unread = Feedback("x", Severity.ERROR, "No.", span=(0, 1))
    report = one_row(tuple(CellReport(label, Verdict.UNREADABLE, (unread,)) for label in "ad"))
    assert with_shared_messages(report) == report


def one_row(cells: tuple[CellReport, ...]) -> PartReport:
    row = RowReport("1", Verdict.INCORRECT, 0, 1, cells)
    return PartReport("it", "matrix", Verdict.INCORRECT, 0, 1, False, (row,))


# --- echo


def test_echo_shows_how_each_cell_was_read(catalogue: Mapping[str, Exercise]) -> None:
    rows: list[list[str]] = [
        ["0", "", "0", "θ1"],
        ["l1", "0", "(", "q2"],
        ["l2", "0", "0", "q3"],
        ["l3"] * 4,
    ]
    submission = Submission({"table": table(rows)}, echo=True)
    report = part(grade(catalogue["planar-rrr"], submission), "table")
    assert cell(report, "1", "theta").read == ReadEntry("q1", "q_{1}")
    assert cell(report, "2", "a").read == ReadEntry("l1", "l_{1}")
    assert cell(report, "1", "alpha").read is None
    assert cell(report, "2", "d").read is None
    silent = part(handed_in(catalogue["planar-rrr"], {"table": table(rows)}), "table")
    assert not [c for row in silent.rows for c in row.cells if c.read]


# --- A slip gets one message, and errors that it causes elsewhere get none

TOLD_ONCE_STANFORD = """\
0, -90deg, 0, theta1
0, 90deg, d2, theta2
0, 0, {d}, {theta}
0, -90deg, 0, theta4
0, 90deg, 0, theta5
0, 0, d6, theta6"""
RIGHT = TOLD_ONCE_STANFORD.format(d="d3", theta="0")


def report(exercise: Exercise, part: str, answer: str, degrees: bool = False) -> PartReport:
    graded = grade(exercise, Submission({part: answer}, "degrees" if degrees else "radians"))
    return next(each for each in graded.parts if each.part == part)


def told(part: PartReport) -> list[str]:
    found = [*part.feedback, *(m for row in part.rows for m in row.feedback)]
    found += [m for row in part.rows for cell in row.cells for m in cell.feedback]
    return [m.code for m in found if m.code != "column_order"]


def test_a_unit_slip_leaves_no_remark_on_frames(catalogue: Mapping[str, Exercise]) -> None:
    in_radians = RIGHT.replace("90deg", "1.5708")
    part = report(catalogue["stanford-arm"], "table", in_radians, degrees=True)
    assert told(part) == ["radians_as_degrees"]


def test_an_extra_row_gets_no_other_message(catalogue: Mapping[str, Exercise]) -> None:
    first, *others = RIGHT.split("\n")
    rows = "\n".join([first, "1, 45deg, 1, 1", *others])
    assert told(report(catalogue["stanford-arm"], "table", rows)) == [
        "rows_matched",
        "row_too_many",
    ]


@pytest.mark.parametrize(
    ("variable", "code"),
    [("theta3", "joint_variable_absent"), ("d3", "joint_variable_column")],
)
def test_a_variable_in_the_wrong_column_is_one_slip(
    variable: str, code: str, catalogue: Mapping[str, Exercise]
) -> None:
    rows = TOLD_ONCE_STANFORD.format(d="0", theta=variable)
    assert told(report(catalogue["stanford-arm"], "table", rows)) == [code]


def test_a_message_on_the_home_pose_does_not_mention_joint_starts(
    catalogue: Mapping[str, Exercise],
) -> None:
    pose = "[1, 0, 0, 1.037165; 0, 1, 0, 0; 0, 0, 1, 0.19135; 0, 0, 0, 1]"
    [message] = report(catalogue["baxter-left-arm"], "home", pose).feedback
    assert "joint 2 starts" not in message.message
    assert "θ, the angle about the axis of joint 2, is not right" in message.message
