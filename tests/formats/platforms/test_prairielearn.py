import pytest

from tests.formats.submissions import HOSTILE, cases, checked_json, document, graded


@pytest.mark.parametrize("case", cases())
def test_the_result_follows_the_rules_of_prairielearn(case: str) -> None:
    result = checked_json("prairielearn", cases()[case])
    for test in result.get("tests", []):
        assert test["points"] <= test["max_points"]


def test_a_score_is_a_share_of_1() -> None:
    assert checked_json("prairielearn", cases()["right"])["score"] == 1.0
    result = checked_json("prairielearn", cases()["wrong"])
    assert result["score"] == pytest.approx((4 + 7) / 16, abs=1e-6)
    table, pose = result["tests"]
    assert table["name"] == "Denavit-Hartenberg table"
    assert table["message"].startswith("✗ row 2 alpha: ")
    assert (pose["points"], pose["max_points"]) == (7.0, 8.0)


@pytest.mark.parametrize("case", ["unreadable", "hostile", "empty", "unusable"])
def test_an_unreadable_submission_is_not_gradable(case: str) -> None:
    result = checked_json("prairielearn", cases()[case])
    assert result["gradable"] is False
    assert result["score"] == 0
    assert "tests" not in result


def test_each_reason_is_given_once() -> None:
    empty = checked_json("prairielearn", cases()["empty"])
    assert empty["format_errors"] == [
        "Denavit-Hartenberg table: – Nothing was handed in.",
        "Pose of the end effector: – Nothing was handed in.",
    ]
    [reason] = checked_json("prairielearn", cases()["unusable"])["format_errors"]
    assert reason.startswith("is no JSON: =cmd")


def test_a_result_stays_below_the_limit_of_1_mb() -> None:
    rows = [
        dict.fromkeys(("a", "alpha", "d", "theta"), f"l1+{HOSTILE[:200]}{i}") for i in range(99)
    ]
    large = graded({"table": {"rows": rows}, "pose": [[HOSTILE] * 4] * 4})
    assert len(document("prairielearn", large).encode()) < 1_000_000
