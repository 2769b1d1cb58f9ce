"""A robot can be built from the words of its statement alone."""

import numpy as np
import pytest
from dh_grader.importing.exercise_text import (
    HomeRobot,
    UnevenLettersError,
    home_statement,
    lettered,
)
from dh_grader.importing.urdf import UnclearAxesError, home_axes, placed, read_urdf
from dh_grader.kinematics import Convention, frames

from tests.importing.statement_reader import pose
from tests.importing.urdf_texts import Part, random_parts, urdf


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
