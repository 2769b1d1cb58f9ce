import json

import pytest
from dh_grader.formats.documents import rendered
from dh_grader.grading import (
    CellReport,
    Correction,
    Feedback,
    FeedbackLevel,
    PartReport,
    Place,
    Report,
    RowReport,
    Severity,
    Verdict,
)

from tests.formats.submissions import HOSTILE, WRITTEN, cases, document

MESSAGE = Feedback(
    "sign",
    Severity.ERROR,
    "Vorzeichen: −θ₁",
    places=(Place("1"),),
    span=(0, 2),
    correction=Correction("q1", "q_{1}"),
    values={"q1": 0.5, "w": "x"},
)
CELL = CellReport("a", Verdict.INCORRECT, (MESSAGE,))
ROW = RowReport("1", Verdict.INCORRECT, 0.0, 1.0, (CELL,))
PART = PartReport("table", "dh_table", Verdict.INCORRECT, 0.0, 1.0, False, (ROW,))
REPORT = Report("arm", "v1", "1.0", FeedbackLevel.HINTS, True, 0.0, 1.0, 0.0, (PART,))


def test_a_report_matches_the_contract_without_empty_fields() -> None:
    cell = {
        "label": "a",
        "verdict": "incorrect",
        "feedback": [
            {
                "code": "sign",
                "severity": "error",
                "message": "Vorzeichen: −θ₁",
                "places": [{"row": "1"}],
                "span": [0, 2],
                "correction": {"text": "q1", "latex": "q_{1}"},
                "values": {"q1": 0.5, "w": "x"},
            }
        ],
    }
    row = {
        "label": "1", "verdict": "incorrect", "points": 0.0, "max_points": 1.0,
        "cells": [cell], "feedback": [],
    }  # fmt: skip
    part = {
        "part": "table", "kind": "dh_table", "verdict": "incorrect", "points": 0.0,
        "max_points": 1.0, "follow_through": False, "rows": [row], "feedback": [], "lost": [],
    }  # fmt: skip
    expected = {
        "exercise": "arm", "version": "v1", "grader": "1.0", "feedback": "hints",
        "gradable": True, "points": 0.0, "max_points": 1.0, "score": 0.0, "parts": [part],
    }  # fmt: skip
    assert json.loads(rendered(REPORT)) == expected
    assert json.loads(rendered(REPORT, indent=2)) == expected
    assert b"\n" not in rendered(REPORT)


def test_nan_is_written_as_valid_json() -> None:
    undefined = Feedback("u", Severity.ERROR, "m", values={"yours": float("nan")})
    part = PartReport("t", "k", Verdict.INCORRECT, 0, 1, False, (), (undefined,))
    report = Report("arm", "v1", "1.0", FeedbackLevel.HINTS, True, 0, 1, 0, (part,))
    content = rendered(report)
    assert b"NaN" not in content
    json.loads(content, parse_constant=pytest.fail)


def test_the_list_has_an_entry_for_each_file() -> None:
    assert json.loads(document("json")) == []
    [right] = json.loads(document("json", cases()["right"]))
    assert right == {
        "submission": "folder/anna.json", "file": "folder/anna.json", "exercise": "planar-rrr",
        "passed": True, "report": json.loads(rendered(report_on("right"))),
    }  # fmt: skip
    entries = json.loads(document("json", *cases().values()))
    assert {tuple(sorted(entry)) for entry in entries} == {
        ("exercise", "file", "passed", "report", "submission"),
        ("error", "exercise", "file", "passed", "submission"),
        ("error", "exercise", "file", "passed", "report", "submission"),
    }
    assert [entry["file"] for entry in entries[-2:]] == ["anna/one.json", ""]


def test_hostile_texts_come_back_unchanged() -> None:
    [entry] = json.loads(document("json", cases()["hostile words"]))
    [message, *_] = entry["report"]["parts"][0]["feedback"]
    assert message["message"] == message["suggestion"] == WRITTEN
    # In names of files, a byte that is not UTF-8 is replaced.
    assert entry["file"] == HOSTILE.replace("\udc80", "?")


def report_on(case: str) -> Report:
    report = cases()[case].files[0].report
    assert report is not None
    return report
