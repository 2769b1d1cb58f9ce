"""Test the answers of model solutions."""

import re
from collections.abc import Callable, Mapping

import numpy as np
import pytest
from dh_grader.catalogue import Exercise, shipped_folder
from dh_grader.expressions import LIMITS, read
from dh_grader.grading import Submission, grade
from dh_grader.solutions import ModelSolution, PartAnswer, Shown, solve

from tests.grading.support.robots import AngleUnit
from tests.grading.support.submitting import full_marks, handed_in
from tests.shipped import sampled
from tests.solutions.solved import solved

# --- Test model answers: DH rows, screw axes, and long poses

# The link transform of row (l, −90°, h, φ) in each convention, multiplied by hand.
LINKS = {
    "standard": [
        ["cos(phi)", "0", "-sin(phi)", "l*cos(phi)"],
        ["sin(phi)", "0", "cos(phi)", "l*sin(phi)"],
        ["0", "-1", "0", "h"],
        ["0", "0", "0", "1"],
    ],
    "modified": [
        ["cos(phi)", "-sin(phi)", "0", "l"],
        ["0", "0", "1", "h"],
        ["-sin(phi)", "-cos(phi)", "0", "0"],
        ["0", "0", "0", "1"],
    ],
}


@pytest.mark.parametrize("convention", LINKS)
def test_the_row_of_a_transform_is_found(
    convention: str, make_exercise: Callable[[str], Exercise]
) -> None:
    exercise = make_exercise(f"""
title = "A row"
source = "made for this test"
statement = "x"
[symbols]
phi = {{ kind = "angle", description = "an angle" }}
l = {{ kind = "length", description = "a length" }}
h = {{ kind = "length", description = "a length" }}
[[parts]]
id = "row"
kind = "dh_row"
title = "Row"
convention = "{convention}"
transform = {LINKS[convention]}
""")
    expected = {"a": "l", "alpha": "-pi/2", "d": "h", "theta": "phi"}
    assert solve(exercise).answers == {"row": expected}


def test_screw_axes_of_a_table(make_exercise: Callable[[str], Exercise]) -> None:
    # The expected axes of the arm follow from the definitions in Modern Robotics.
    exercise = make_exercise("""
title = "Two joints"
source = "made for this test"
statement = "x"
[robot]
structure = "RP"
convention = "modified"
joints = ["q1", "q2"]
table = [["a0", "0", "0", "q1"], ["a1", "-90deg", "q2", "0"], ["0", "0", "d3", "0"]]
[symbols]
a0 = { kind = "length", description = "a length" }
a1 = { kind = "length", description = "a length" }
d3 = { kind = "length", description = "a length" }
[[parts]]
id = "space"
kind = "screw_axes"
title = "Space"
frame = "space"
[[parts]]
id = "body"
kind = "screw_axes"
title = "Body"
frame = "body"
""")
    answers = solve(exercise).answers
    assert answers["space"] == [["0", "0", "1", "0", "-a0", "0"], ["0", "0", "0", "0", "1", "0"]]
    # The tool lies at (a0 + a1, d3, 0), its y axis down and its z axis along y.
    assert answers["body"] == [
        ["0", "-1", "0", "-d3", "0", "a1"],
        ["0", "0", "0", "0", "0", "1"],
    ]


@pytest.mark.campaign
def test_a_pose_that_is_too_long_is_printed_as_a_product(
    make_exercise: Callable[[str], Exercise],
) -> None:
    rows = ", ".join(f'["0.1", "31deg", "0.1", "q{i}"]' for i in range(1, 9))
    exercise = make_exercise(f"""
title = "Eight joints"
source = "made for this test"
statement = "x"
[robot]
structure = "RRRRRRRR"
convention = "standard"
joints = {[f"q{i}" for i in range(1, 9)]}
table = [{rows}]
[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
[[parts]]
id = "tip"
kind = "position"
title = "Where frame 2 is"
to = 2
""")
    solution = solve(exercise)
    assert solution.pose is not None
    assert solution.pose.text == "A1 A2 A3 A4 A5 A6 A7 A8"
    pose, tip = solution.parts
    assert pose.answer is None
    assert isinstance(tip.answer, list)


def test_a_transform_without_a_row_has_the_answer_none(catalogue: Mapping[str, Exercise]) -> None:
    assert solve(catalogue["dh-conditions"]).answers["second"] == {"none": True}


# --- Test model solutions of robots that are given in numbers

# a, alpha, d, and theta without the joint variable.
ROWS = [
    (0.0612, 0.31, 0.0892, 0.1),
    (-0.425, 0.2, 0.011, 0.2),
    (-0.39225, 0.7, 0.013, -0.35),
    (0.023, -1.1, 0.09465, 0.0),
]
NUMERIC = f"""
title = "Numbers"
source = "none"
statement = "Four joints, and no length is a letter."
[robot]
structure = "RRRR"
convention = "standard"
joints = [{", ".join(f'"theta{i}"' for i in range(1, 5))}]
table = [
{
    "".join(
        f'    ["{a}", "{alpha}", "{d}", "theta{i} + {theta}"],{chr(10)}'
        for i, (a, alpha, d, theta) in enumerate(ROWS, 1)
    )
}]
[[parts]]
id = "space"
kind = "screw_axes"
title = "Space"
frame = "space"
[[parts]]
id = "body"
kind = "screw_axes"
title = "Body"
frame = "body"
[[parts]]
id = "home"
kind = "transform"
title = "Home"
home = true
"""


def link(a: float, alpha: float, d: float, theta: float) -> np.ndarray:
    """Return the standard link transform (Spong et al., eq. 3.10)."""
    ca, sa, ct, st = np.cos(alpha), np.sin(alpha), np.cos(theta), np.sin(theta)
    return np.array(
        [[ct, -st * ca, st * sa, a * ct], [st, ct * ca, -ct * sa, a * st], [0, sa, ca, d],
         [0, 0, 0, 1]]
    )  # fmt: skip


@pytest.mark.long
def test_the_numbers_equal_those_of_the_chain(make_exercise: Callable[[str], Exercise]) -> None:
    exercise = make_exercise(NUMERIC)
    poses = [np.eye(4)]
    for row in ROWS:
        poses.append(poses[-1] @ link(*row))
    tool = np.linalg.inv(poses[-1])
    space, body = [], []
    for pose in poses[:-1]:
        space.append([*pose[:3, 2], *np.cross(pose[:3, 3], pose[:3, 2])])
        seen = tool @ pose
        body.append([*seen[:3, 2], *np.cross(seen[:3, 3], seen[:3, 2])])
    answers = solve(exercise).answers
    for part, expected in (("space", space), ("body", body), ("home", poses[-1])):
        found = np.array(answers[part], dtype=float)
        assert np.abs(found - np.array(expected)).max() < 1e-14, part
        assert max(map(len, np.ravel(np.array(answers[part])))) <= 23
    assert grade(exercise, Submission(answers)).score == 1


ONE_TWIST = """
title = "One twist"
source = "none"
statement = "A twist of 40 degrees."
[robot]
structure = "RR"
convention = "standard"
joints = ["theta1", "theta2"]
table = [["l1", "40deg", "0", "theta1"], ["l1", "-40deg", "0", "theta2"]]
[symbols]
l1 = { kind = "length", description = "link" }
[[parts]]
id = "space"
kind = "screw_axes"
title = "Space"
frame = "space"
[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
"""


def test_cancelled_terms_are_0_and_lengths_stay_symbols(
    make_exercise: Callable[[str], Exercise],
) -> None:
    exercise = make_exercise(ONE_TWIST)
    answers = solve(exercise).answers
    cos, sin = "0.766044443118978", "0.642787609686539"
    # The axis of joint 2 runs through (l1, 0, 0) along (0, -sin 40°, cos 40°).
    assert answers["space"] == [
        ["0", "0", "1", "0", "0", "0"],
        ["0", f"-{sin}", cos, "0", f"-{cos}*l1", f"-{sin}*l1"],
    ]
    assert grade(exercise, Submission(answers)).score == 1


# --- The matrices of model solutions have the form that textbooks print

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


# --- The model solution of every exercise gets full marks in every part

IDS = sorted(file.stem for file in shipped_folder().glob("*.toml"))


def posted(part: PartAnswer, solution: ModelSolution, form: str) -> object:
    if form == "json":
        return part.answer
    if part.kind == "link_transforms":  # a list of matrices, each of which is pasted
        return [getattr(link, form) for link in solution.links]
    if part.text == "none":  # the answer that there is no row is only accepted as JSON
        return part.answer
    return getattr(part, form)


@pytest.mark.sampled(12)
@pytest.mark.parametrize("unit", ["radians", "degrees"])
@pytest.mark.parametrize("form", ["json", "text", "latex"])
@pytest.mark.parametrize("exercise_id", sampled(IDS))
def test_the_model_solution_gets_full_marks(
    exercise_id: str,
    form: str,
    unit: AngleUnit,
    catalogue: Mapping[str, Exercise],
) -> None:
    exercise = catalogue[exercise_id]
    solution = solved(exercise)
    answers = {part.part: posted(part, solution, form) for part in solution.parts}
    assert set(answers) == {part.id for part in exercise.parts}
    report = handed_in(exercise, answers, unit)
    for part in report.parts:
        assert full_marks(part), part
        assert not part.follow_through


@pytest.mark.parametrize("exercise_id", sampled(IDS))
def test_each_shorthand_reads_back_to_its_meaning(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[exercise_id]
    for name, meaning in solved(exercise).notation.items():
        assert read(name, exercise.vocabulary).text() == meaning


@pytest.mark.long
def test_the_longest_entry_is_within_the_limit(
    catalogue: Mapping[str, Exercise], figure: Callable[[str], None]
) -> None:
    poses = [pose for exercise in catalogue.values() if (pose := solved(exercise).pose)]
    longest = max(len(entry) for pose in poses for entry in re.split(r"[,;]", pose.text))
    figure(f"longest entry of a model solution: {longest} of {LIMITS.characters} characters")
    assert longest <= LIMITS.characters
