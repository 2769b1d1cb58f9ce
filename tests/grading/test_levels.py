"""How much a report tells: full, verdicts, score."""

import re
from collections.abc import Mapping
from typing import Any

import pytest

from service.catalogue import Exercise
from service.grading import Feedback, FeedbackLevel, Report, Verdict
from tests.grading.support.robots import EXACT, STANFORD
from tests.grading.support.submitting import handed_in, not_correct, part, row, table


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
    return [
        message
        for part in report.parts
        for message in (
            *part.feedback,
            *(m for row in part.rows for m in row.feedback),
            *(m for row in part.rows for cell in row.cells for m in cell.feedback),
        )
    ]


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


def test_full_gives_corrections_and_counterexamples(reports: dict[FeedbackLevel, Report]) -> None:
    full = messages(reports[FeedbackLevel.FULL])
    assert [m for m in full if re.search(r"It should be (-pi/2|-90deg)\.", m.message)]
    assert [m.message for m in full if "It should be d2." in m.message]
    assert [m.values for m in full if m.code == "value" and m.values and "yours" in m.values]


def test_verdicts_keep_the_correction_back(reports: dict[FeedbackLevel, Report]) -> None:
    verdicts = reports[FeedbackLevel.VERDICTS]
    full = reports[FeedbackLevel.FULL]
    assert [m.code for m in messages(verdicts)] == [m.code for m in messages(full)]
    assert not [m for m in messages(verdicts) if "should be" in m.message]
    assert not [m for m in messages(verdicts) if m.values]
    assert not_correct(part(verdicts, "table")) == not_correct(part(full, "table"))


def test_score_tells_what_could_not_be_read_and_no_more(
    reports: dict[FeedbackLevel, Report],
) -> None:
    score = reports[FeedbackLevel.SCORE]
    assert all(part.rows == () for part in score.parts)
    found = messages(score)
    assert {m.code for m in found} == {"unbalanced_bracket", "missing"}
    assert {(m.row, m.cell) for m in part(score, "table").feedback} == {("3", "a"), ("4", "theta")}
    assert {(m.row, m.cell) for m in part(score, "pose").feedback} == {
        ("3", str(column)) for column in range(1, 5)
    }
    assert not [m for m in found if m.values]


def test_a_repair_of_the_text_is_offered_at_every_level(
    reports: dict[FeedbackLevel, Report],
) -> None:
    for report in reports.values():
        [message] = [m for m in messages(report) if (m.row, m.cell) == ("3", "a")]
        assert "Did you mean (d2)?" in message.message
        assert message.span == (0, 1)


@pytest.mark.parametrize("level", [FeedbackLevel.VERDICTS, FeedbackLevel.SCORE])
def test_the_reference_is_never_told_below_full(
    level: FeedbackLevel, given_frames: Mapping[str, Exercise]
) -> None:
    """Of a length that the student got wrong, the right one is not named."""
    rows = [list(cells) for cells in EXACT.rows(STANFORD)]
    rows[1][2] = "0"
    rows[5][2] = "0"
    report = handed_in(given_frames[STANFORD.exercise], {"table": table(rows)}, feedback=level)
    text = " ".join(m.message for m in messages(report))
    assert "d2" not in text
    assert "d6" not in text


def test_a_missing_row_is_told_by_its_label_at_verdicts(
    given_frames: Mapping[str, Exercise],
) -> None:
    report = handed_in(
        given_frames[STANFORD.exercise],
        {"table": table(EXACT.rows(STANFORD)[:5])},
        feedback=FeedbackLevel.VERDICTS,
    )
    [message] = part(report, "table").feedback
    assert (message.code, message.row) == ("missing_row", "6")
    assert row(part(report, "table"), "6").verdict is Verdict.MISSING
