import pytest
from dh_grader.authoring import Level, examine
from dh_grader.catalogue import Exercise, load_exercise
from dh_grader.importing.exercise_text import Draft, HomeRobot, exercise_text, lettered
from dh_grader.importing.urdf import home_axes, placed, read_urdf
from dh_grader.kinematics import Convention

from tests.importing.urdf_texts import Part, urdf

ARM = [
    Part("revolute", [0, 0, 0.4], [0, 0, 0]),
    Part("revolute", [0.1, 0, 0], [-1.5708, 0, 0]),
    Part("prismatic", [0.3, 0, 0], [0, 1.5708, 0]),
    Part("continuous", [0, 0, 0.2], [0, 0, 0], [0, 0, -1]),
    Part("fixed", [0, 0, 0.05], [0, 0, 0]),
]
"""A hand-made arm: RRPR with a shoulder offset and a wrist."""


def written(text: str, tmp_path: object) -> Exercise:
    file = tmp_path / "arm.toml"  # type: ignore[operator]
    file.write_text(text, encoding="utf-8")
    return load_exercise(file)


@pytest.mark.parametrize("convention", Convention)
@pytest.mark.parametrize("has_letters", [False, True])
def test_the_file_is_a_valid_exercise(
    tmp_path: object, convention: Convention, has_letters: bool
) -> None:
    arm, _ = read_urdf(urdf(ARM), "l5")
    made = placed(*home_axes(arm))
    robot = HomeRobot(made.table, arm.structure, real=True)
    robot = lettered(robot) if has_letters else robot
    draft = Draft('An "arm"\x07 \\ of ours', "us", convention, ["a remark\nin two lines"])
    exercise = written(exercise_text(robot, draft), tmp_path)
    assert exercise.title == 'An "arm" \\ of ours'
    assert exercise.structure == "RRPR"
    assert not [remark for remark in examine(exercise) if remark.level is Level.FAILED]
