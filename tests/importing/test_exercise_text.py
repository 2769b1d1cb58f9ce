"""Test the exercise that is written for an imported robot."""

import ast

import numpy as np
import pytest
from dh_grader.authoring import Level, examine
from dh_grader.catalogue import Exercise, load_exercise
from dh_grader.importing.exercise_text import (
    Draft,
    HomeRobot,
    UnevenLettersError,
    exercise_text,
    home_statement,
    lettered,
    toolbox_text,
    urdf_text,
)
from dh_grader.importing.urdf import UnclearAxesError, home_axes, placed, read_urdf
from dh_grader.kinematics import Convention, frames, standard_link

from tests.importing.statement_reader import pose
from tests.importing.urdf_texts import Part, random_parts, urdf

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


# --- Export


def robot(seed: int) -> HomeRobot:
    """Return a random robot."""
    rng = np.random.default_rng(seed)
    structure = "".join(rng.choice(["R", "R", "P"], size=rng.integers(1, 7)))
    rows = len(structure) + int(rng.random() < 0.5)
    table = rng.uniform(-2, 2, (rows, 4)) * (rng.random((rows, 4)) < 0.7)
    table[:, 1] = rng.choice([-1, 0, 0.5, 1, 2], rows) * np.pi / 2
    return HomeRobot(table, structure, {})


def exported_pose(made: HomeRobot, values: np.ndarray) -> np.ndarray:
    table = made.table.copy()
    for i, letter in enumerate(made.structure):
        table[i, 2 if letter == "P" else 3] += values[i]
    return np.asarray(frames(table, Convention.STANDARD)[-1])


@pytest.mark.parametrize("seed", range(20))
def test_the_urdf_moves_as_the_table_does(seed: int) -> None:
    made = robot(seed)
    _, arm = read_urdf(urdf_text(made, 'a "robot" <&>').encode(), "tool")
    values = np.random.default_rng(seed).uniform(-2, 2, len(made.structure))
    assert arm.structure == made.structure
    assert arm.pose(values) == pytest.approx(exported_pose(made, values), abs=1e-9)


@pytest.mark.parametrize("seed", range(20))
def test_the_script_has_the_same_links(seed: int) -> None:
    made = robot(seed)
    tree = ast.parse(toolbox_text(made, "robot's name"))
    calls = [
        (node.func.id, {each.arg: ast.literal_eval(each.value) for each in node.keywords})
        for node in ast.walk(tree)
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and "DH(" not in ast.dump(node)
    ]
    links = [(kind, numbers) for kind, numbers in calls if kind in ("RevoluteDH", "PrismaticDH")]
    reached = np.eye(4)
    for kind, numbers in links:
        free, fixed = ("theta", "d") if kind == "RevoluteDH" else ("d", "theta")
        row = {free: numbers["offset"], fixed: numbers[fixed]}
        reached = reached @ standard_link(numbers["a"], numbers["alpha"], row["d"], row["theta"])
    assert [kind[0] for kind, _ in links] == list(made.structure)
    expected = frames(made.table, Convention.STANDARD)[len(made.structure)]
    assert reached == pytest.approx(expected, abs=1e-9)


# --- A robot can be built from the words of its statement alone


def straight_parts(rng: np.random.Generator) -> list[Part]:
    return [
        Part(
            "revolute",
            list(rng.permutation([round(rng.uniform(0.1, 0.9), 3), 0, 0])),
            list(rng.integers(-2, 3, 3) * np.pi / 2),
        )
        for _ in range(rng.integers(2, 8))
    ]


@pytest.mark.parametrize("has_letters", [False, True])
@pytest.mark.parametrize("seed", range(30))
def test_the_robot_can_be_built_again_from_its_statement(seed: int, has_letters: bool) -> None:
    rng = np.random.default_rng([seed, 7])
    parts = straight_parts(rng) if has_letters else random_parts(rng, crooked=seed % 3 == 0)
    try:
        arm, _ = read_urdf(urdf(parts), f"l{len(parts)}")
        made = placed(*home_axes(arm))
    except UnclearAxesError:
        pytest.skip("axes nearly parallel")
    robot = HomeRobot(made.table, arm.structure)
    robot = lettered(robot) if has_letters else robot
    statement = home_statement(robot, Convention.STANDARD)
    values = rng.uniform(-2, 2, len(arm.structure))
    table = made.table.copy()
    for i, letter in enumerate(arm.structure):
        table[i, 2 if letter == "P" else 3] += values[i]
    reached = frames(table, Convention.STANDARD)[-1]
    place, x, z = pose(statement, robot.lengths, values)
    assert place == pytest.approx(reached[:3, 3], abs=1e-4)
    assert x == pytest.approx(reached[:3, 0], abs=1e-5)
    assert z == pytest.approx(reached[:3, 2], abs=1e-5)


def test_a_crooked_angle_gives_no_letters() -> None:
    table = np.array([[0.5, 0, 0, 0.4], [0.3, 0, 0, 0]])
    with pytest.raises(UnevenLettersError):
        home_statement(lettered(HomeRobot(table, "RR", real=True)), Convention.STANDARD)
