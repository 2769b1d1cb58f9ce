from pathlib import Path

import pytest
from dh_grader.authoring import UnusableIdError, examine, exercise_template
from dh_grader.catalogue import load_exercise


def test_a_new_file_gets_no_remarks(tmp_path: Path) -> None:
    file = tmp_path / "elbow-arm.toml"
    file.write_text(exercise_template("elbow-arm"), encoding="utf-8")
    exercise = load_exercise(file)
    assert (exercise.id, exercise.title) == ("elbow-arm", "Elbow arm")
    assert examine(exercise) == []


def test_the_template_has_comments() -> None:
    lines = exercise_template("arm").splitlines()
    assert sum(line.startswith("#") for line in lines) >= 20
    assert max(map(len, lines)) <= 110


@pytest.mark.parametrize(
    "exercise_id",
    ["", "Arm", "2arm", "my arm", "../arm", "a/b", "arm.toml", "arm-", "é", "a" * 61, "arm\n"],
)
def test_an_invalid_id_is_refused(exercise_id: str) -> None:
    with pytest.raises(UnusableIdError, match="small letters"):
        exercise_template(exercise_id)
