"""Test model answers: DH rows, screw axes, and long poses."""

from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.solutions import solve

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
