import pytest
from dh_grader.formats.graded import Visibility

from tests.formats.submissions import cases, checked_json


@pytest.mark.parametrize("case", cases())
def test_the_result_follows_the_rules_of_gradescope(case: str) -> None:
    result = checked_json("gradescope", cases()[case])
    tests = result["tests"]
    assert len({test["name"] for test in tests}) == len(tests) > 0
    assert sum(test["score"] for test in tests) == pytest.approx(result["score"], abs=1e-5)
    for test in tests:
        assert test["score"] <= test["max_score"]
        assert (test["status"] == "passed") == (test["score"] == test["max_score"])


def test_each_part_is_a_test_that_shows_its_rows() -> None:
    result = checked_json("gradescope", cases()["wrong"])
    table, pose = result["tests"]
    assert (table["name"], table["max_score"], table["status"]) == (
        "Denavit-Hartenberg table", 8.0, "failed",
    )  # fmt: skip
    lines = table["output"].splitlines()
    assert lines[0] == "| row | a | alpha | d | theta | points |"
    assert lines[3].startswith("| 2 | ✓ | ✗ | ✓ | ✓ | 0.5 / 2.5 |")
    assert any(line.startswith("- ✗ **row 2 alpha:** ") for line in lines)
    # One wrong sign of four entries in the rotation, which is half of the 8 points.
    assert pose["score"] == 7.0
    assert result["score"] == table["score"] + 7.0


def test_an_unusable_file_earns_nothing_and_has_a_reason() -> None:
    result = checked_json("gradescope", cases()["unusable"])
    assert result["score"] == 0
    assert result["output"].startswith("Nothing could be graded: is no JSON")
    assert [test["max_score"] for test in result["tests"]] == [8.0, 8.0]


def test_exercises_of_an_assignment_are_weighted() -> None:
    result = checked_json("gradescope", cases()["assignment"])
    told = [(test["name"], test["score"], test["max_score"]) for test in result["tests"]]
    arm = "Planar RRR arm"
    assert told == [
        (f"{arm}: Denavit-Hartenberg table", 1.5, 1.5),
        (f"{arm}: Pose of the end effector", 1.5, 1.5),
        ("Other arm: Table", 0.0, 1.0),
    ]
    assert result["score"] == 3.0
    # The first row has 0.5 of the exercise's 16 points, and these count 3.
    assert "| 1 | ✓ | ✓ | ✓ | ✓ | 0.09 / 0.09 |" in result["tests"][0]["output"]


def test_the_visibility_is_written() -> None:
    assert checked_json("gradescope", cases()["right"])["visibility"] == "visible"
    late = checked_json("gradescope", cases()["right"], visibility=Visibility.AFTER_PUBLISHED)
    assert late["visibility"] == "after_published"
    assert late["stdout_visibility"] == "hidden"
