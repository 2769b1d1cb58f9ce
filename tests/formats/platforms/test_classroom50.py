import pytest
from dh_grader.formats.graded import UnusableSettingError

from tests.formats.submissions import CLASSROOM, cases, checked_json, document


@pytest.mark.parametrize("case", cases())
def test_the_result_matches_the_schema(case: str) -> None:
    result = checked_json("classroom50", cases()[case])
    tests = result["tests"]
    assert len({test["test-name"] for test in tests}) == len(tests) > 0
    # Rules of the runner that are not in the schema.
    assert result["score"] == sum(test["score"] for test in tests) <= result["max-score"]
    assert result["max-score"] == sum(test["max-score"] for test in tests)
    for test in tests:
        assert test["score"] <= test["max-score"]
        assert test["passed"] == (test["score"] == test["max-score"])


def test_scores_are_hundredths_of_a_point() -> None:
    right = checked_json("classroom50", cases()["right"])
    assert (right["score"], right["max-score"]) == (1600, 1600)
    wrong = checked_json("classroom50", cases()["wrong"])
    # 3.789474 of the table's points are not rounded up.
    assert [test["score"] for test in wrong["tests"]] == [400, 700]


def test_the_runners_variables_identify_the_submission() -> None:
    result = checked_json("classroom50", cases()["right"])
    assert (result["classroom"], result["assignment"]) == ("robotics", "planar")
    assert (result["owner"], result["assignment_type"]) == ("anna", "individual")
    assert result["datetime"] == "2026-06-01T14:32:05Z"
    assert result["review"] == result["commit"] == CLASSROOM["COMMIT_URL"]
    told = {**CLASSROOM, "REVIEW_URL": "https://example.org/diff", "ASSIGNMENT_TYPE": "group"}
    del told["OWNER"]
    result = checked_json("classroom50", cases()["right"], environment={**told, "USERNAME": "bo"})
    assert (result["owner"], result["assignment_type"]) == ("bo", "group")
    assert result["review"] == "https://example.org/diff"


def test_missing_variables_are_named() -> None:
    told = {**CLASSROOM, "SUBMISSION_TAG": ""}
    del told["OWNER"]
    with pytest.raises(UnusableSettingError, match=r"not here: OWNER, SUBMISSION_TAG$"):
        document("classroom50", cases()["right"], environment=told)
