"""Compare tables of real robots with the URDF files in the repository."""

from collections.abc import Sequence

import pytest
from dh_grader.kinematics import Convention

from tests.exercises.real.makers import ARMS, MAKERS, ROUNDED_MM, differences
from tests.exercises.real.urdf_comparison import Difference, difference
from tests.shipped import REAL_ROBOTS, shipped_exercises

FILES = {file.stem: file for file in ARMS.glob("*/*.urdf")}
HERE = {name: FILES[maker.file] for name, maker in MAKERS.items() if maker.file in FILES}
FARTHEST_MM, FARTHEST_DEGREES = 0.1, 0.01


@pytest.mark.parametrize("name", HERE)
def test_a_table_moves_as_the_file_of_its_maker(name: str) -> None:
    found = differences(name, HERE[name])
    assert len(found) == len(shipped_exercises()[name].robot.tables)
    for each in found:
        assert each.millimetres <= ROUNDED_MM.get(name, FARTHEST_MM)
        assert each.degrees <= FARTHEST_DEGREES
        assert each.base_apart <= ROUNDED_MM.get(name, FARTHEST_MM)
        assert each.tool_apart <= ROUNDED_MM.get(name, FARTHEST_MM)


def test_nine_of_the_robots_are_compared_here() -> None:
    assert set(MAKERS) <= set(REAL_ROBOTS)
    assert len(HERE) >= 9


def of_ur5e(name: str, signs: Sequence[int]) -> Difference:
    exercise = shipped_exercises()[name]
    return difference(exercise, Convention.STANDARD, FILES["ur5e"], signs, (0,) * 6, "tool0")


def test_another_robot_or_a_joint_that_counts_the_other_way_is_noticed() -> None:
    assert of_ur5e("ur5e", (1,) * 6).millimetres < FARTHEST_MM
    assert of_ur5e("ur3e", (1,) * 6).millimetres > 100
    assert of_ur5e("ur5e", (1, 1, -1, 1, 1, 1)).degrees > 10
