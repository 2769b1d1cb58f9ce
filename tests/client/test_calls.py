import json
from collections.abc import Sequence
from typing import Any

import pytest
from dh_grader.client import ExerciseSubmission, grade, grade_many
from dh_grader.submissions.bodies import MAX_BODY_SIZE, MAX_SUBMISSIONS, read_json


def bodies(answers: Sequence[Any]) -> list[bytes]:
    submissions = (ExerciseSubmission(exercise="x", answers={"t": each}) for each in answers)
    return [call.body or b"" for call in grade_many(submissions)]


@pytest.mark.parametrize(
    ("answer", "of_each"),
    [
        (1, MAX_SUBMISSIONS),
        ("θ" * 6_000, 21),  # 12,000 bytes of the 256 KiB
        ([[]] * 200, 24),  # 204 lists and objects in all, of 5,000
        ([0] * 1_000, 19),  # 1,001 commas in all, of 20,000
    ],
)
def test_a_request_has_as_many_submissions_as_the_service_accepts(
    answer: object, of_each: int
) -> None:
    sent = bodies([answer] * (2 * of_each + 1))
    lists = [json.loads(body)["submissions"] for body in sent]
    assert [len(each) for each in lists] == [of_each, of_each, 1]
    for body in sent:
        assert len(body) <= MAX_BODY_SIZE
        read_json(body)  # raises an error over a limit


def test_a_submission_that_is_too_large_is_sent_alone() -> None:
    assert len(bodies([1, "x" * MAX_BODY_SIZE, 1])) == 3
    assert bodies([]) == []


def test_values_that_json_lacks_arrive_as_text() -> None:
    answers = {"t": [float("nan"), float("-inf"), "\ud800", "θ"]}
    assert read_json(grade("x", answers).body or b"") == {
        "answers": {"t": ["NaN", "-Infinity", "\ufffd", "θ"]}
    }
