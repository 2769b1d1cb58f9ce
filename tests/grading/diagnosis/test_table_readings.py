"""Test how a wrong table is read in other ways."""

import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import FrameType
from typing import Any

import dh_grader
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import FeedbackLevel, PartReport, Submission, Verdict, grade
from dh_grader.grading.report import messages_of

from tests.grading.support.submitting import graded_table, handed_in, part, table
from tests.solutions.solved import solved

# --- Compare the explanation of a whole table with the explanations of its cells

SKEW_RPR = """
title = "Skew RPR"
source = "made for a test"
statement = "The table of the arm."

[robot]
structure = "RPR"
convention = "standard"
joints = ["q1", "q2", "q3"]
table = [["l1", "pi/3", "h", "q1"], ["l2", "-pi/4", "q2", "pi/6"], ["l3", "pi/2", "h/2", "q3"]]

[symbols]
l1 = { kind = "length", description = "length", range = [0.5, 2.5] }
l2 = { kind = "length", description = "length", range = [0.5, 2.5] }
l3 = { kind = "length", description = "length", range = [0.5, 2.5] }
h = { kind = "length", description = "length", range = [0.5, 2.5] }

[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
convention = "either"
frames = "free"
"""


def test_an_explanation_may_have_more_rows_than_the_judgement(
    make_exercise: Callable[[str], Exercise],
) -> None:
    # In reverse order and with an extra row: judged by the reference's three rows.
    rows = [
        ("l3", "pi/2", "0", "0"),
        ("l1", "pi/3", "q2", "pi/6"),
        ("l2", "-pi/4", "h/2", "q3"),
        ("0", "0", "h", "q1"),
    ]
    report = part(handed_in(make_exercise(SKEW_RPR), {"table": table(rows)}, "degrees"), "table")
    assert report.verdict is Verdict.PARTIAL


PLANAR = [("a1", "0", "0", "theta1"), ("a2", "0", "0", "theta2")]


def errors(report: PartReport) -> list[str]:
    return [message.code for message, _, _ in messages_of(report) if message.severity == "error"]


@pytest.mark.parametrize(
    ("first", "second"),
    [
        # The link of joint 2 is missing at the end.
        (("0", "0"), ("a1", "0")),
        # The link of joint 2 is at the other end.
        (("a2", "0"), ("a1", "0")),
    ],
)
def test_links_one_row_too_late_are_named(
    catalogue: Mapping[str, Exercise], first: tuple[str, str], second: tuple[str, str]
) -> None:
    rows = [(*first, *PLANAR[0][2:]), (*second, *PLANAR[1][2:])]
    report = graded_table(catalogue["planar-rr"], rows)
    assert "value" not in errors(report)
    # A slip of the whole table costs a quarter.
    assert report.points == 3


def test_the_other_convention_is_named_for_two_joints(catalogue: Mapping[str, Exercise]) -> None:
    # Both wrong cells could be separate slips, but the table is in the modified convention.
    modified = [("0", "0", "0", "theta1"), ("a1", "0", "0", "theta2"), ("a2", "0", "0", "0")]
    report = graded_table(catalogue["planar-rr"], modified)
    assert errors(report) == ["other_convention"]
    assert report.points == report.max_points / 2
    report = graded_table(catalogue["planar-rr"], modified[:2])
    assert errors(report) == ["link_columns_shifted"]
    [message] = [m for m in report.feedback if m.code == "link_columns_shifted"]
    assert message.message.endswith("In the modified convention they stand there.")


@pytest.mark.parametrize(
    ("name", "rows"),
    [
        ("planar-rr", [("7", "33deg", "0", "theta1"), ("a1", "0", "0", "theta2")]),
        ("planar-rr", [("7", "0", "0", "theta1"), ("a1", "0", "0", "theta2")]),
        ("planar-rr", [("a2", "0", "0", "theta1"), ("a1", "-90deg", "0", "theta2")]),
        (
            "scara",
            [
                ("0", "77deg", "0", "theta1"),
                ("a1", "0", "0", "theta2"),
                ("a2", "180deg", "d3", "0"),
                ("0", "0", "d4", "theta4"),
            ],
        ),
    ],
)
def test_a_shift_does_not_explain_an_invented_link(
    catalogue: Mapping[str, Exercise], name: str, rows: Sequence[Sequence[str]]
) -> None:
    report = graded_table(catalogue[name], rows)
    assert "link_columns_shifted" not in errors(report)
    assert report.points < report.max_points / 2


def test_freedom_lost_by_a_wrong_theta_gets_no_message_of_its_own(
    catalogue: Mapping[str, Exercise],
) -> None:
    # Only θ of row 2 is wrong: it should be -90deg.
    rows = [("0", "-90deg", "d1", "0"), ("0", "-90deg", "d2", "0"), ("0", "0", "d3", "0")]
    assert errors(graded_table(catalogue["three-link-cartesian"], rows)) == ["quarter_turn"]


# --- A correct table is graded without a search for misconceptions

# An arm with six rows whose only part is its table.
ARM = "fanuc-lr-mate-200id"
# The most files that take part. The numbers may only go down.
RIGHT, WRONG_SIGN = 17, 30


def files_of(exercise: Exercise, answer: Any, verdict: Verdict) -> set[str]:
    submission = Submission({"table": answer}, feedback=FeedbackLevel.HINTS)
    assert grade(exercise, submission).parts[0].verdict is verdict
    root, found = Path(dh_grader.__file__).parent, set[str]()

    def note(frame: FrameType, event: str, _: object) -> None:
        if event == "call" and frame.f_code.co_filename.startswith(f"{root}/"):
            found.add(frame.f_code.co_filename.removeprefix(f"{root}/"))

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        grade(exercise, submission)
    finally:
        sys.setprofile(before)
    return found


def right_rows(exercise: Exercise) -> list[dict[str, str]]:
    answer: Any = solved(exercise).answers["table"]
    assert len(answer["rows"]) == 6
    return [dict(row) for row in answer["rows"]]


def test_a_right_table_is_not_diagnosed(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue[ARM]
    found = files_of(exercise, {"rows": right_rows(exercise)}, Verdict.CORRECT)
    assert "grading/kinds/tables.py" in found
    assert [file for file in found if "diagnosis" in file or "table_readings" in file] == []
    assert len(found) <= RIGHT, sorted(found)


def test_a_wrong_sign_takes_few_files(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue[ARM]
    rows = right_rows(exercise)
    rows[0]["alpha"] = rows[0]["alpha"].removeprefix("-")
    found = files_of(exercise, {"rows": rows}, Verdict.PARTIAL)
    assert "grading/diagnosis/table_cells.py" in found
    assert len(found) <= WRONG_SIGN, sorted(found)
