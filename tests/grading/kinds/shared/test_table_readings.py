"""A correct table is graded without a search for misconceptions."""

import sys
from collections.abc import Mapping
from pathlib import Path
from types import FrameType
from typing import Any

import dh_grader
from dh_grader.catalogue import Exercise
from dh_grader.grading import FeedbackLevel, Submission, Verdict, grade

from tests.solutions.solved import solved

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
