import pytest
from dh_grader.submissions.bodies import UnknownExerciseError, find_exercise, nearest

from tests.shipped import shipped_exercises


def test_a_known_exercise_is_found() -> None:
    catalogue = shipped_exercises()
    assert find_exercise(catalogue, "scara") is catalogue["scara"]


@pytest.mark.parametrize(
    ("mistyped", "meant"),
    [("Scara", "scara"), ("stanford_arm", "stanford-arm"), ("rrr", "rrrp"), ("xyz", None)],
)
def test_an_unknown_exercise_gets_a_suggestion(mistyped: str, meant: str | None) -> None:
    with pytest.raises(UnknownExerciseError) as caught:
        find_exercise(shipped_exercises(), mistyped)
    assert caught.value.suggestion == meant
    assert (str(meant) in str(caught.value)) == (meant is not None)


def test_a_very_long_name_is_cut_before_comparison() -> None:
    assert nearest("a" * 10**7, ["scara"]) is None
    assert len(str(UnknownExerciseError("a" * 10**6, ("scara",)))) < 200
