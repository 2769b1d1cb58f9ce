"""The same submission always gets the same report, byte for byte."""

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict

from tests.grading.support.robots import EXACT, STANFORD
from tests.grading.support.submitting import as_data, handed_in, not_correct, part, table

PROGRAM = """
import json, sys
from dataclasses import asdict
from dh_grader.catalogue import load_catalogue, shipped_folder
from dh_grader.grading import Submission, grade

exercise = load_catalogue(shipped_folder())["stanford-arm"]
print(json.dumps(asdict(grade(exercise, Submission(json.load(sys.stdin))))))
"""


def wrong_answers() -> dict[str, Any]:
    rows: list[list[Any]] = [list(row) for row in EXACT.rows(STANFORD)]
    rows[0][1] = "-1.5708"
    rows[1][3] = "q2 + d2*d6 + q5"
    rows[3][2] = "d2 + d6"
    rows[4][0] = "(q1"
    pose = [["c1 c2 c4 c5 c6", "s12", "0", "sqrt(q4)"], [0.5] * 4, [], ["0", "0", "0", "1"]]
    return {"table": table(rows), "pose": pose}


def as_bytes(exercise: Exercise, answers: Mapping[str, object]) -> bytes:
    return json.dumps(as_data(handed_in(exercise, answers))).encode()


def test_reports_are_equal_in_one_process(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue[STANFORD.exercise]
    reports = {as_bytes(exercise, wrong_answers()) for _ in range(5)}
    assert len(reports) == 1
    assert b"yours" in reports.pop()


@pytest.mark.long
def test_reports_are_equal_for_every_hash_seed(catalogue: Mapping[str, Exercise]) -> None:
    here = as_bytes(catalogue[STANFORD.exercise], wrong_answers())
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", PROGRAM],
            env={**os.environ, "PYTHONHASHSEED": seed},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        for seed in ("1", "4242")
    ]
    question = json.dumps(wrong_answers()).encode()
    for process in processes:
        answer, _ = process.communicate(question)
        assert process.returncode == 0
        assert answer.strip() == here


def test_the_order_of_keys_does_not_matter(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue[STANFORD.exercise]
    answers = wrong_answers()
    turned = {
        "pose": answers["pose"],
        "table": {"rows": [dict(reversed(row.items())) for row in answers["table"]["rows"]]},
    }
    assert list(turned) != list(answers)
    assert as_bytes(exercise, turned) == as_bytes(exercise, answers)


def test_another_submission_in_between_changes_nothing(
    catalogue: Mapping[str, Exercise],
) -> None:
    exercise = catalogue[STANFORD.exercise]
    before = as_bytes(exercise, wrong_answers())
    for other in catalogue.values():
        handed_in(other, {other.parts[0].id: [["q1", "c12"]]}, angle_unit="degrees")
    assert as_bytes(exercise, wrong_answers()) == before


def test_grading_does_not_change_the_answers(catalogue: Mapping[str, Exercise]) -> None:
    answers = wrong_answers()
    handed_in(catalogue[STANFORD.exercise], answers)
    assert answers == wrong_answers()


def test_another_answer_is_graded_at_other_values(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue[STANFORD.exercise]
    seen = set()
    for text in ("d2 + 0.1", "0.1 + d2", "d2+.1"):
        rows = [list(row) for row in EXACT.rows(STANFORD)]
        rows[1][2] = text
        report = part(handed_in(exercise, {"table": table(rows)}), "table")
        assert not_correct(report) == {("2", "d"): Verdict.INCORRECT}
        [feedback] = report.rows[1].cells[2].feedback
        assert feedback.values is not None
        assert feedback.values["yours"] == pytest.approx(
            float(feedback.values["d2"]) + 0.1, abs=2e-4
        )
        seen.add(feedback.values["d2"])
    assert len(seen) == 3
