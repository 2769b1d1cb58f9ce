import numpy as np
import pytest

from service.authoring import examine
from service.authoring.remarks import Level
from service.catalogue import Exercise, load_exercise
from service.grading.grade import Submission, grade
from service.importing.axes import home_axes
from service.importing.exercise_text import Draft, exercise_text, letters_for
from service.importing.frames import placed
from service.importing.home_statement import HomeRobot
from service.importing.pasted_robot import UnusableTableError, robot_of_table
from service.importing.urdf import read_urdf
from service.kinematics.dh import Convention
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
@pytest.mark.parametrize("lettered", [False, True])
def test_the_file_is_a_valid_exercise(
    tmp_path: object, convention: Convention, lettered: bool
) -> None:
    arm, _ = read_urdf(urdf(ARM), "l5")
    made = placed(*home_axes(arm))
    letters = letters_for(made.table) if lettered else {}
    robot = HomeRobot(made.table, arm.structure, letters, real=True)
    draft = Draft('An "arm"\x07 \\ of ours', "us", convention, ["a remark\nin two lines"])
    exercise = written(exercise_text(robot, draft), tmp_path)
    assert exercise.title == 'An "arm" \\ of ours'
    assert exercise.structure == "RRPR"
    assert not [remark for remark in examine(exercise) if remark.level is Level.FAILED]


PASTED = """
i | a | alpha | d | theta
1 | 0 | -90°  | d1 | q1
2 | -a2 | 0   | 0  | q2 + 90°
3 | 0 | 90°   | q3 | 0
e | 0 | 0     | 0.1 | 180°
"""


def test_a_pasted_table_becomes_an_exercise_that_accepts_it(tmp_path: object) -> None:
    robot = robot_of_table(PASTED, Convention.STANDARD)
    assert robot.structure == "RRP"
    assert np.count_nonzero(robot.table) == 7
    exercise = written(exercise_text(robot, Draft("Pasted", "us")), tmp_path)
    report = grade(exercise, Submission({"table": PASTED}))
    assert report.parts[0].points == report.parts[0].max_points


REFUSED = {
    "0 | 0 | 0 | 0": "no joint variable",
    "a | alpha | d | theta\n0 | 0 | d1*d2 | q1": "row 1, column d: write a number, or one letter",
    "a | alpha | d | theta\n0 | 0 | d1+ | q1": "row 1, column d",
    "a | alpha | d | theta\na1 | 0 | 0 | q1\na1 | 0 | 0 | q2": "a letter is in two cells",
    "good morning": "table",
}


@pytest.mark.parametrize("text", REFUSED)
def test_a_table_without_a_robot_is_refused_with_its_reason(text: str) -> None:
    with pytest.raises(UnusableTableError, match=REFUSED[text]):
        robot_of_table(text, Convention.STANDARD)
