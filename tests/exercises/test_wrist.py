"""The rotation of the spherical wrist equals that of ZYZ Euler angles."""

from collections.abc import Mapping

import pytest
import sympy as sp
from dh_grader.catalogue import Exercise

from tests.grading.support.submitting import full_marks, handed_in, part

four, five, six = sp.symbols("theta4 theta5 theta6")


def about_z(angle: sp.Symbol) -> sp.Matrix:
    return sp.Matrix(
        [[sp.cos(angle), -sp.sin(angle), 0], [sp.sin(angle), sp.cos(angle), 0], [0, 0, 1]]
    )


ABOUT_Y = sp.Matrix([[sp.cos(five), 0, sp.sin(five)], [0, 1, 0], [-sp.sin(five), 0, sp.cos(five)]])
ROTATION = about_z(four) * ABOUT_Y * about_z(six)
POSITION = ["d6 c4 s5", "d6 s4 s5", "d6 c5"]


def test_the_answers_of_the_lecture_are_right(catalogue: Mapping[str, Exercise]) -> None:
    rows = [[str(ROTATION[i, j]) for j in range(3)] for i in range(3)]
    answers = {
        "rotation": rows,
        "position": POSITION,
        "pose": [[*row, p] for row, p in zip(rows, POSITION, strict=True)] + [["0", "0", "0", "1"]],
        "zyz": ["theta4", "theta5", "theta6"],
    }
    report = handed_in(catalogue["spherical-wrist"], answers)
    for part_id in answers:
        assert full_marks(part(report, part_id)), part(report, part_id)


@pytest.mark.parametrize(
    "angles",
    [
        ["theta4 + pi", "-theta5", "theta6 + pi"],
        ["atan2(s4 s5, c4 s5)", "atan2(sqrt((c4 s5)^2 + (s4 s5)^2), c5)", "atan2(s5 s6, s5 c6)"],
        ["atan2(-s4 s5, -c4 s5)", "-acos(c5)", "atan2(-s5 s6, -s5 c6)"],
    ],
)
def test_other_angles_of_the_same_rotation_are_right(
    angles: list[str], catalogue: Mapping[str, Exercise]
) -> None:
    report = handed_in(catalogue["spherical-wrist"], {"zyz": angles})
    assert full_marks(part(report, "zyz"))


def test_a_table_with_row_labels_is_right(catalogue: Mapping[str, Exercise]) -> None:
    answer = "i,a,alpha,d,theta\n4,0,-90,0,theta4\n5,0,90,0,theta5\n6,0,0,d6,theta6"
    report = handed_in(catalogue["spherical-wrist"], {"table": answer}, "degrees")
    assert full_marks(part(report, "table"))
    assert [row.label for row in part(report, "table").rows] == ["4", "5", "6"]
