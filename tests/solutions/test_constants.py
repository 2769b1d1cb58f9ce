"""Test model solutions of robots that are given in numbers."""

from collections.abc import Callable

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Submission, grade
from dh_grader.solutions import solve

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
