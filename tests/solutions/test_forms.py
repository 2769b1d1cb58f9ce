"""The matrices of model solutions have the form that textbooks print."""

import re
from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.solutions import ModelSolution, Shown, solve

from tests.solutions.solved import solved

# Robotic Fundamentals (UMFM4X-15-M), Examples 1 to 3; Spong, Hutchinson, Vidyasagar, Robot Modeling
# and Control, eqs. 3.14 (cylindrical), 3.15 (spherical wrist) and 3.20 to 3.29 (Stanford arm).
POSES = {
    "planar-rrr": [
        ["c123", "-s123", "0", "l1*c1 + l2*c12 + l3*c123"],
        ["s123", "c123", "0", "l1*s1 + l2*s12 + l3*s123"],
        ["0", "0", "1", "0"],
        ["0", "0", "0", "1"],
    ],
    "rrrp": [
        ["cos(q1 + q2 - q3)", "sin(q1 + q2 - q3)", "0", "l2*c1 + l3*c12"],
        ["sin(q1 + q2 - q3)", "-cos(q1 + q2 - q3)", "0", "l2*s1 + l3*s12"],
        ["0", "0", "-1", "l1 - l4 - q4"],
        ["0", "0", "0", "1"],
    ],
    "spatial-rrr": [
        ["c1*c23", "-c1*s23", "s1", "c1*(R + L1*c2 + L2*c23)"],
        ["s1*c23", "-s1*s23", "-c1", "s1*(R + L1*c2 + L2*c23)"],
        ["s23", "c23", "0", "L1*s2 + L2*s23"],
        ["0", "0", "0", "1"],
    ],
    "three-link-cylindrical": [
        ["c1", "0", "-s1", "-d3*s1"],
        ["s1", "0", "c1", "d3*c1"],
        ["0", "-1", "0", "d1 + d2"],
        ["0", "0", "0", "1"],
    ],
    "spherical-wrist": [
        ["c4*c5*c6 - s4*s6", "-c4*c5*s6 - s4*c6", "c4*s5", "d6*c4*s5"],
        ["c4*s6 + s4*c5*c6", "c4*c6 - s4*c5*s6", "s4*s5", "d6*s4*s5"],
        ["-s5*c6", "s5*s6", "c5", "d6*c5"],
        ["0", "0", "0", "1"],
    ],
    "planar-rpr-poe": [
        ["c13", "-s13", "0", "c1*(L1 + theta2) + L2*c13"],
        ["s13", "c13", "0", "s1*(L1 + theta2) + L2*s13"],
        ["0", "0", "1", "0"],
        ["0", "0", "0", "1"],
    ],
}


def entries(pose: Shown) -> list[list[str]]:
    return [re.split(r", +", line.strip(" []")) for line in pose.text.split(";\n")]


@pytest.mark.parametrize("exercise_id", POSES)
def test_a_pose_has_the_form_of_the_textbook(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    pose = solved(catalogue[exercise_id]).pose
    assert pose is not None
    assert entries(pose) == POSES[exercise_id]


@pytest.fixture(scope="module")
def stanford(catalogue: Mapping[str, Exercise]) -> ModelSolution:
    return solved(catalogue["stanford-arm"])


def test_the_pose_of_the_stanford_arm_has_the_textbooks_brackets(stanford: ModelSolution) -> None:
    assert stanford.pose is not None
    first = [row[0] for row in entries(stanford.pose)]
    assert first == [
        "c1*(c2*(c4*c5*c6 - s4*s6) - s2*s5*c6) - s1*(c4*s6 + s4*c5*c6)",
        "c1*(c4*s6 + s4*c5*c6) + s1*(c2*(c4*c5*c6 - s4*s6) - s2*s5*c6)",
        "-c2*s5*c6 - s2*(c4*c5*c6 - s4*s6)",
        "0",
    ]


def test_the_link_transforms_of_the_stanford_arm(stanford: ModelSolution) -> None:
    # The expected A_1 and A_2 are from MEAM 520, More Denavit-Hartenberg.
    assert [link.label for link in stanford.links] == ["1", "2", "3", "4", "5", "6"]
    assert stanford.links[0].text == (
        "[c1, 0,  -s1, 0;\n s1, 0,  c1,  0;\n 0,  -1, 0,   0;\n 0,  0,  0,   1]"
    )
    assert stanford.links[1].latex == (
        "\\begin{bmatrix}\n"
        "c_{2} & 0 & s_{2} & 0 \\\\\n"
        "s_{2} & 0 & -c_{2} & 0 \\\\\n"
        "0 & 1 & 0 & d_{2} \\\\\n"
        "0 & 0 & 0 & 1\n"
        "\\end{bmatrix}"
    )


def test_the_table_is_as_the_author_wrote_it(stanford: ModelSolution) -> None:
    table = stanford.parts[0]
    assert table.text.splitlines()[:4] == [
        "| i | a | alpha  | d  | theta  |",
        "| - | - | ------ | -- | ------ |",
        "| 1 | 0 | -90deg | 0  | theta1 |",
        "| 2 | 0 | 90deg  | d2 | theta2 |",
    ]
    assert r"$2$ & $0$ & $90^{\circ}$ & $d_{2}$ & $\theta_{2}$ \\" in table.latex


def test_the_zyz_angles_of_a_wrist_are_its_joint_angles(catalogue: Mapping[str, Exercise]) -> None:
    answers = solved(catalogue["spherical-wrist"]).answers
    assert answers["zyz"] == ["theta4", "theta5", "theta6"]


def test_the_spatial_arm_has_the_correct_roll_pitch_yaw_angles(
    catalogue: Mapping[str, Exercise],
) -> None:
    # The lecture prints β = θ2 + θ3, which contradicts its own formula.
    answers = solved(catalogue["spatial-rrr"]).answers
    assert answers["rpy"] == ["theta1", "-theta2 - theta3", "pi/2"]


def test_the_same_exercise_has_the_same_solution(catalogue: Mapping[str, Exercise]) -> None:
    assert solve(catalogue["scara"]) == solve(catalogue["scara"])
