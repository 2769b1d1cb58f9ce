"""Graded submissions for the tests of report formats."""

import io
import json
from collections.abc import Mapping
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from dh_grader.catalogue import Exercise, FeedbackLevel, load_exercise, shipped_folder
from dh_grader.formats import report_format
from dh_grader.formats.graded import (
    AnsweredExercise,
    AnsweredPart,
    GradedFile,
    GradedSubmission,
    Setting,
    answered,
)
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
from rich.console import Console

ROWS = [
    {"a": 0, "alpha": 0, "d": 0, "theta": "q1"},
    {"a": "l1", "alpha": 0, "d": 0, "theta": "q2"},
    {"a": "l2", "alpha": 0, "d": 0, "theta": "q3"},
    {"a": "l3", "alpha": 0, "d": 0, "theta": 0},
]
POSE = """c123, -s123, 0, l1*c1+l2*c12+l3*c123
s123, c123, 0, l1*s1+l2*s12+l3*s123
0, 0, 1, 0
0, 0, 0, 1"""

# Commands to builds, markup of each kind, a spreadsheet formula, a path out of the folder, control
# characters, characters that XML forbids, a lone surrogate, right-to-left text.
HOSTILE = (
    "=cmd|' /C calc'!A0 ../../etc <script>alert(1)</script> <img src=x onerror=alert(1)> \"&amp; "
    "\x1b[31m\x07\x00\x7f\x9b2J\r\n::set-output name=a::b\n##[error]x ##vso[task] ###x\n"
    "\n# @all #12 GH-1 **bold** _em_ ~~s~~ `code` ![i](http://e.vil) [l](javascript:x) "
    "https://e.vil www.e.vil | a || b | ]]> --> <!-- \udc80\ufffe\uffff\u202e\u200b 100% %0A, $x$ "
    "{{7*7}} [[ATTACHMENT|x]]"
)
# Only names of files can have a lone surrogate; in answers it is replaced.
WRITTEN = HOSTILE.replace("\udc80", "")
NOW = datetime(2026, 6, 1, 14, 32, 5, tzinfo=UTC)
# What the runner of Classroom 50 sets.
CLASSROOM = {
    "CLASSROOM": "robotics",
    "ASSIGNMENT": "planar",
    "OWNER": "anna",
    "SUBMISSION_TAG": "submit/2026-06-01T14-32-01Z-a1b2c3d",
    "COMMIT_URL": "https://example.org/commit/1",
    "RELEASE_URL": "https://example.org/releases/1",
}


@cache
def planar() -> Exercise:
    return load_exercise(shipped_folder() / "planar-rrr.toml")


def submission(
    *files: GradedFile, name: str = "folder/anna.json", learner: str = "anna"
) -> GradedSubmission:
    return GradedSubmission(name, learner, files, pass_mark=0.8)


def graded(
    answers: Mapping[str, object],
    name: str = "folder/anna.json",
    feedback: FeedbackLevel = FeedbackLevel.FULL,
) -> GradedSubmission:
    report = grade(planar(), Submission(answers, feedback=feedback, echo=True))
    return submission(
        GradedFile(name, answered(planar()), report, names=(name,)), name=name, learner=name
    )


def _hostile_words() -> GradedSubmission:
    correction = Correction(WRITTEN, WRITTEN)
    told = [
        Feedback(
            "code",
            severity,
            WRITTEN,
            places=(Place("1", "a", correction),),
            suggestion=WRITTEN,
            correction=correction,
            values={WRITTEN: WRITTEN, "yours": WRITTEN, "expected": float("nan")},
        )
        for severity in Severity
    ]
    cell = CellReport("a", Verdict.INCORRECT, tuple(told), ReadEntry(WRITTEN, WRITTEN))
    row = RowReport("1", Verdict.INCORRECT, 0.0, 1.0, (cell,), tuple(told))
    part = PartReport("p", "dh_table", Verdict.INCORRECT, 0.25, 1, False, (row,), tuple(told))
    report = Report("e", "v", "1", FeedbackLevel.FULL, True, 0.25, 1, 0.25, (part,))
    exercise = AnsweredExercise("e", WRITTEN, WRITTEN, (AnsweredPart("p", WRITTEN, 1.0),), 1.0)
    return submission(
        GradedFile(HOSTILE, exercise, report, names=(HOSTILE,)), name=HOSTILE, learner=HOSTILE
    )


def _assignment() -> GradedSubmission:
    right = graded({"table": {"rows": ROWS}, "pose": POSE}).files[0].report
    exercise = answered(planar(), worth=3.0)
    missing = AnsweredExercise(
        "other", "Other arm", "A book", (AnsweredPart("t", "Table", 5),), 1.0
    )
    return submission(
        GradedFile("anna/one.json", exercise, right, names=("one.json",)),
        GradedFile("", missing, None, "Nothing was handed in."),
        name="anna",
    )


@cache
def cases() -> Mapping[str, GradedSubmission]:
    """Return graded submissions by names such as ``wrong`` and ``empty``."""
    wrong = [ROWS[0], {**ROWS[1], "alpha": "pi/2"}, {**ROWS[2], "theta": "q2"}, ROWS[3]]
    hostile = [dict.fromkeys(row, WRITTEN) for row in ROWS]
    problem = GradedFile("folder/b.json", answered(planar()), None, f"is no JSON: {HOSTILE}")
    return {
        "right": graded({"table": {"rows": ROWS}, "pose": POSE}),
        "wrong": graded({"table": {"rows": wrong}, "pose": POSE.replace("-s123", "s123")}),
        "unreadable": graded({"table": "no table", "pose": [["?"] * 4] * 4}),
        "hostile": graded({"table": {"rows": hostile}, "pose": WRITTEN}, f"../{HOSTILE}.json"),
        "hostile words": _hostile_words(),
        "empty": graded({}),
        "unusable": submission(problem, name="folder/b.json", learner="b"),
        "assignment": _assignment(),
    }


def setting(**changes: Any) -> Setting:
    console = Console(file=io.TextIOWrapper(io.BytesIO(), "utf-8"), width=80, markup=False)
    given = {"exercises": (answered(planar()),), "console": console, "now": NOW}
    return Setting(**{**given, "environment": CLASSROOM, **changes})


def document(name: str, *submissions: GradedSubmission, **changes: Any) -> str:
    """Return the document that a report format writes about submissions."""
    pieces = report_format(name).pieces(submissions, setting(**changes))
    return b"".join(pieces).decode()


def checked_json(name: str, only: GradedSubmission, **changes: Any) -> Any:
    """Return a format's JSON document after checking it against its schema."""
    file = Path(__file__).with_name("schemas") / f"{name}.json"
    schema = json.loads(file.read_text(encoding="utf-8"))
    text = document(name, only, **changes)
    content = json.loads(text, parse_constant=pytest.fail)
    jsonschema.Draft202012Validator(schema).validate(content)
    return content
