"""Test the exercises about real robots."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.kinematics import Convention
from numpy.typing import NDArray

from tests.exercises.real.campaign import ACCEPTED, REFUSED, policy_of, run
from tests.exercises.real.makers import ARMS, MAKERS, ROUNDED_MM, differences
from tests.exercises.real.urdf_comparison import Difference, difference
from tests.frame_choice.robots import GIVEN, POLICIES
from tests.shipped import REAL_ROBOTS, shipped_exercises
from tests.together import together

# --- Compare the tables of the real robots with tables from other publications

# Sources choose different frames, signs and home configurations. But they must agree in |a|, in α
# modulo 180°, and in |d|, because these are distances and angles between neighbouring joint axes.
# Each table below was typed from its source, not from the exercise.

Numbers = NDArray[np.float64]


class Published(NamedTuple):
    """A published table in the standard convention (metres and degrees)."""

    source: str
    a: Sequence[float]
    alpha: Sequence[float]
    d: Sequence[float]


def universal_robots(d1: float, a2: float, a3: float, d4: float, d5: float, d6: float) -> Published:
    """Return the table of an arm of Universal Robots."""
    return Published(
        "UniversalRobots/Universal_Robots_ROS2_Description",
        (0, a2, a3, 0, 0, 0), (90, 0, 0, 90, -90, 0), (d1, 0, 0, d4, d5, d6),
    )  # fmt: skip


PUMA = Published(
    "Paul 1981, with the lengths of Corke 1994",
    (0, 0.4318, 0.0203, 0, 0, 0), (-90, 0, 90, -90, 90, 0), (0, 0, 0.15005, 0.4318, 0, 0),
)  # fmt: skip
PUBLISHED: Mapping[str, Published] = {
    "ur3e": universal_robots(0.15185, 0.24355, 0.2132, 0.13105, 0.08535, 0.0921),
    "ur5e": universal_robots(0.1625, 0.425, 0.3922, 0.1333, 0.0997, 0.0996),
    "ur10e": universal_robots(0.1807, 0.6127, 0.57155, 0.17415, 0.11985, 0.11655),
    "ur16e": universal_robots(0.1807, 0.4784, 0.36, 0.17415, 0.11985, 0.11655),
    "ur20": universal_robots(0.2363, 0.862, 0.7287, 0.201, 0.1593, 0.1543),
    "puma-560": PUMA,
    "franka-research-3": Published(
        "Robotics Toolbox, models/DH/Panda.py",
        (0, 0, 0.0825, 0.0825, 0, 0.088, 0), (90, 90, 90, 90, 90, 90, 0),
        (0.333, 0, 0.316, 0, 0.384, 0, 0.107),
    ),
    "kuka-lbr-iiwa-7": Published(
        "LBR iiwa 14 R820 of ARTE, with the lengths of the R800",
        (0,) * 7, (-90, 90, -90, 90, -90, 90, 0), (0.34, 0, 0.4, 0, 0.4, 0, 0.126),
    ),
    "kinova-gen3": Published(
        "Kinova Gen3 user guide",
        (0,) * 7, (90,) * 6 + (180,), (0.2848, 0.0118, 0.4208, 0.0128, 0.3143, 0, 0.1674),
    ),
    "xarm6": Published(
        "UFACTORY manual, a2 from the sides of its triangle",
        (0, (0.2845**2 + 0.0535**2) ** 0.5, 0.0775, 0, 0.076, 0),
        (-90, 0, -90, 90, -90, 0), (0.267, 0, 0, 0.3425, 0, 0.097),
    ),
    "abb-irb-120": Published(
        "pybotics, predefined_models.py",
        (0, 0.27, 0.07, 0, 0, 0), (90, 0, 90, 90, 90, 0), (0.29, 0, 0, 0.302, 0, 0.072),
    ),
    "abb-irb-140": Published(
        "Robotics Toolbox, models/DH/IRB140.py",
        (0.07, 0.36, 0, 0, 0, 0), (-90, 0, -90, 90, -90, 0), (0.352, 0, 0, 0.38, 0, 0.065),
    ),
    "kuka-kr-5-arc": Published(
        "Robotics Toolbox, models/DH/KR5.py",
        (0.18, 0.6, 0.12, 0, 0, 0), (-90, 0, 90, -90, 90, 180), (0.4, 0, 0, -0.62, 0, -0.115),
    ),
    "sawyer": Published(
        "Robotics Toolbox, models/DH/Sawyer.py, but the last length as in sawyer_base.urdf.xacro",
        (0.081, 0, 0, 0, 0, 0, 0), (-90,) * 6 + (0,),
        (0.317, 0.1925, 0.4, 0.1685, 0.4, 0.1363, 0.1345),
    ),
    "adept-cobra-600": Published(
        "Robotics Toolbox, models/DH/Cobra600.py",
        (0.325, 0.275, 0, 0), (0, 180, 0, 0), (0.387, 0, 0, 0),
    ),
}  # fmt: skip


def mechanism(a: Numbers, alpha: Numbers, d: Numbers) -> Numbers:
    # Return |a|, α as an angle of 0 to 90°, and |d| of each row, `(rows, 3)`.
    angle = np.abs((np.rad2deg(alpha) + 90) % 180 - 90)
    return np.stack([np.abs(a), angle, np.abs(d)], axis=1)


def written(exercise: Exercise) -> Numbers:
    values = {v.name: np.zeros(1) for v in exercise.variables}
    robot = exercise.robot
    rows = robot.tables[robot.convention].values(values, 1)[..., 0]
    a, alpha, d = rows[:, 0], rows[:, 1], rows[:, 2]
    if robot.convention.value == "modified":
        # Row i has a and α of the link before it; an additional row has the tool's.
        a, alpha = np.append(a[1:], 0.0), np.append(alpha[1:], 0.0)
        if len(rows) > len(robot.joints):
            a, alpha, d = a[:-1], alpha[:-1], np.append(d[:-2], d[-2] + d[-1])
    return mechanism(a, alpha, d)


@pytest.mark.parametrize("name", PUBLISHED)
def test_a_robot_has_the_axes_that_another_source_gives_it(name: str) -> None:
    other = PUBLISHED[name]
    expected = mechanism(np.array(other.a), np.deg2rad(other.alpha), np.array(other.d))
    np.testing.assert_allclose(written(shipped_exercises()[name]), expected, rtol=0, atol=1e-5)


def test_only_real_robots_are_compared() -> None:
    assert set(PUBLISHED) <= set(REAL_ROBOTS)


# --- Compare tables of real robots with the URDF files in the repository

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


# --- Grade a few random tables of the real robots


@pytest.mark.long
@together("name", REAL_ROBOTS)
def test_valid_tables_are_accepted_and_wrong_ones_refused(name: str) -> None:
    found = run(name, tables=1, seed=29)
    assert found.misses == []
    assert found.counts[ACCEPTED] == found.counts[REFUSED] == 1


@pytest.mark.campaign
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("name", REAL_ROBOTS)
def test_a_thousand_tables_of_each_kind_are_judged_rightly(name: str) -> None:
    found = run(name, tables=1000, seed=1)
    assert found.misses == []
    assert found.counts[ACCEPTED] == found.counts[REFUSED] == 1000


def test_base_tool_and_directions_are_each_free_somewhere() -> None:
    policies = {name: policy_of(shipped_exercises()[name]) for name in REAL_ROBOTS}
    free = {name: policy for name, policy in policies.items() if policy != GIVEN}
    assert {policy.name for policy in free.values()} == {
        "free base", "free tool", "free directions", "all free",
    }  # fmt: skip
    assert len(free) == 4
    assert set(policies.values()) <= set(POLICIES)
