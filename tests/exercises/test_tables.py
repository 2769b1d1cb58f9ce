"""Compare shipped tables and poses with published ones."""

from collections.abc import Mapping
from functools import reduce
from typing import Any

import pytest
import sympy as sp
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict

from tests.grading.support.robots import ROBOTS, SPELLINGS, Robot, Spelling
from tests.grading.support.submitting import (
    full_marks,
    graded_pose,
    graded_table,
    handed_in,
    not_correct,
    part,
)

# --- The textbooks' tables get full marks, however a student writes them


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.exercise)
@pytest.mark.parametrize("spelling", SPELLINGS, ids=lambda spelling: spelling.name)
def test_the_reference_table_gets_full_marks(
    robot: Robot, spelling: Spelling, catalogue: Mapping[str, Exercise]
) -> None:
    report = graded_table(
        catalogue[robot.exercise], spelling.rows(robot), angle_unit=spelling.angle_unit
    )
    assert full_marks(report), report
    assert tuple(row.label for row in report.rows) == robot.labels
    assert {
        message.code for row in report.rows for cell in row.cells for message in cell.feedback
    } <= {"radians_in_degrees"}


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.exercise)
def test_numbers_need_not_be_text(robot: Robot, catalogue: Mapping[str, Exercise]) -> None:
    rows = [
        [float(cell) if cell.lstrip("-").isdigit() else cell for cell in row] for row in robot.rows
    ]
    assert full_marks(graded_table(catalogue[robot.exercise], rows, angle_unit="degrees"))


def test_the_stanford_table_as_the_lecture_prints_it(catalogue: Mapping[str, Exercise]) -> None:
    # Source: MEAM 520, More Denavit-Hartenberg (DH); columns d, a, α, θ; joints as θ_1^*.
    printed = [
        ("0", "0", "-90", r"\theta_1^*"),
        ("d_2", "0", "+90", r"\theta_2^*"),
        ("d_3^*", "0", "0", "0"),
        ("0", "0", "-90", r"\theta_4^*"),
        ("0", "0", "+90", r"\theta_5^*"),
        ("d_6", "0", "0", r"\theta_6^*"),
    ]
    rows = [(a, alpha, d, theta) for d, a, alpha, theta in printed]
    assert full_marks(graded_table(catalogue["stanford-arm"], rows, angle_unit="degrees"))


def test_every_shipped_exercise_is_tested_here(catalogue: Mapping[str, Exercise]) -> None:
    assert {robot.exercise for robot in ROBOTS} <= set(catalogue)


# --- The rotation of the spherical wrist equals that of ZYZ Euler angles

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


# --- Poses that lectures print get full marks

# The matrices are copied from MEAM 520, *More Denavit-Hartenberg (DH)* (planar RR and Stanford arm)
# and from Robotic Fundamentals (UMFM4X-15-M), *Forward Kinematics* (planar RRR, RRRP); SymPy
# multiplies them.

Matrix = list[list[str]]

# For SymPy, c1 is a symbol; the grader reads it as cos(theta1).
c1, c2, c4, c5, c6, s1, s2, s4, s5, s6 = sp.symbols("c1 c2 c4 c5 c6 s1 s2 s4 s5 s6")
d2, d3, d6 = sp.symbols("d2 d3 d6")

STANFORD = [
    sp.Matrix([[c1, 0, -s1, 0], [s1, 0, c1, 0], [0, -1, 0, 0], [0, 0, 0, 1]]),
    sp.Matrix([[c2, 0, s2, 0], [s2, 0, -c2, 0], [0, 1, 0, d2], [0, 0, 0, 1]]),
    sp.Matrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, d3], [0, 0, 0, 1]]),
    sp.Matrix([[c4, 0, -s4, 0], [s4, 0, c4, 0], [0, -1, 0, 0], [0, 0, 0, 1]]),
    # Printed with −1 in the third row, which is left-handed and not what the table's +90° gives.
    sp.Matrix([[c5, 0, s5, 0], [s5, 0, -c5, 0], [0, 1, 0, 0], [0, 0, 0, 1]]),
    sp.Matrix([[c6, -s6, 0, 0], [s6, c6, 0, 0], [0, 0, 1, d6], [0, 0, 0, 1]]),
]


def entries(matrix: Any) -> Matrix:
    return [[str(matrix[i, j]) for j in range(4)] for i in range(4)]


def product(*matrices: Any) -> Any:
    return reduce(lambda left, right: left * right, matrices)


def planar_rrr() -> Any:
    # Return the product 0T1 1T2 2T3 3Te of the printed matrices.
    q1, q2, q3, l1, l2, l3 = sp.symbols("q1 q2 q3 l1 l2 l3")

    def link(q: Any, length: Any) -> Any:
        cos, sin = sp.cos(q), sp.sin(q)
        return sp.Matrix([[cos, -sin, 0, length], [sin, cos, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])

    tip = sp.Matrix([[1, 0, 0, l3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    return product(link(q1, 0), link(q2, l1), link(q3, l2), tip)


def rrrp() -> Any:
    # Return the pose from the lecture's table and its general matrix (standard convention).
    q1, q2, q3, q4, l1, l2, l3, l4 = sp.symbols("q1 q2 q3 q4 l1 l2 l3 l4")

    def link(a: Any, alpha: Any, d: Any, theta: Any) -> Any:
        c, s, ca, sa = sp.cos(theta), sp.sin(theta), sp.cos(alpha), sp.sin(alpha)
        return sp.Matrix(
            [[c, -ca * s, sa * s, a * c], [s, ca * c, -sa * c, a * s], [0, sa, ca, d], [0, 0, 0, 1]]
        )

    return product(
        link(l2, 0, l1, q1), link(l3, sp.pi, 0, q2), link(0, 0, l4, q3), link(0, 0, q4, 0)
    )


PRODUCTS = {
    "planar-rrr": planar_rrr(),
    "rrrp": rrrp(),
    "stanford-arm": product(*STANFORD),
}


@pytest.mark.parametrize("exercise", PRODUCTS)
def test_the_product_of_the_printed_matrices_is_right(
    exercise: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = graded_pose(catalogue[exercise], entries(PRODUCTS[exercise]))
    assert full_marks(report), not_correct(report)


@pytest.mark.parametrize("exercise", ["planar-rrr", "rrrp"])
def test_the_expanded_product_is_right(exercise: str, catalogue: Mapping[str, Exercise]) -> None:
    expanded = PRODUCTS[exercise].applyfunc(sp.expand)
    assert full_marks(graded_pose(catalogue[exercise], entries(expanded)))


def test_the_stanford_matrices_as_printed_are_wrong_where_the_misprint_reaches(
    catalogue: Mapping[str, Exercise],
) -> None:
    misprinted = sp.Matrix(STANFORD[4])
    misprinted[2, 1] = -1
    assert sp.simplify(misprinted[:3, :3].det().subs(s5**2, 1 - c5**2)) == -1
    printed = product(*STANFORD[:4], misprinted, STANFORD[5])
    differs = {
        (str(i + 1), str(j + 1)): Verdict.INCORRECT
        for i in range(4)
        for j in range(4)
        if sp.expand(printed[i, j] - PRODUCTS["stanford-arm"][i, j]) != 0
    }
    assert len(differs) == 6
    assert not_correct(graded_pose(catalogue["stanford-arm"], entries(printed))) == differs


CLOSED_FORMS: dict[str, dict[str, Matrix]] = {
    "planar-rrr": {
        "shorthand": [
            ["c123", "-s123", "0", "l1 c1 + l2 c12 + l3 c123"],
            ["s123", "c123", "0", "l1 s1 + l2 s12 + l3 s123"],
            ["0", "0", "1", "0"],
            ["0", "0", "0", "1"],
        ],
        "LaTeX": [
            ["c_{123}", "-s_{123}", "0", r"l_1\cos q_1 + l_2 c_{12} + l_3 c_{123}"],
            ["s_{123}", "c_{123}", "0", r"l_1\sin q_1 + l_2 s_{12} + l_3 s_{123}"],
            ["0", "0", "1", "0"],
            ["0", "0", "0", "1"],
        ],
    },
    "rrrp": {
        "shorthand": [
            ["cos(q1+q2-q3)", "sin(q1+q2-q3)", "0", "l2 c1 + l3 c12"],
            ["sin(q1+q2-q3)", "-cos(q1+q2-q3)", "0", "l2 s1 + l3 s12"],
            ["0", "0", "-1", "l1 - l4 - q4"],
            ["0", "0", "0", "1"],
        ],
        "products of shorthand": [
            ["c12c3 + s12s3", "s12c3 - c12s3", "0", "l2*c1 + l3*c12"],
            ["s12 c3 - c12 s3", "-(c12 c3 + s12 s3)", "0", "l2*s1 + l3*s12"],
            ["0", "0", "-1", "l1 - (l4 + d4)"],
            ["0", "0", "0", "1"],
        ],
    },
    "scara": {
        "shorthand": [
            ["c12 c4 + s12 s4", "-c12 s4 + s12 c4", "0", "a1 c1 + a2 c12"],
            ["s12 c4 - c12 s4", "-s12 s4 - c12 c4", "0", "a1 s1 + a2 s12"],
            ["0", "0", "-1", "-d3 - d4"],
            ["0", "0", "0", "1"],
        ],
        "sums": [
            ["cos(θ1+θ2-θ4)", "sin(θ1+θ2-θ4)", "0", "a1 cos θ1 + a2 cos(θ1+θ2)"],
            ["sin(θ1+θ2-θ4)", "-cos(θ1+θ2-θ4)", "0", "a1 sin θ1 + a2 sin(θ1+θ2)"],
            ["0", "0", "-1", "-(d3+d4)"],
            ["0", "0", "0", "1"],
        ],
    },
    # Spong, Hutchinson, Vidyasagar, Robot Modeling and Control, p. 92.
    "stanford-arm": {
        "shorthand": [
            [
                "c1(c2(c4c5c6 - s4s6) - s2s5c6) - s1(s4c5c6 + c4s6)",
                "c1(-c2(c4c5s6 + s4c6) + s2s5s6) - s1(-s4c5s6 + c4c6)",
                "c1(c2c4s5 + s2c5) - s1s4s5",
                "c1s2d3 - s1d2 + d6(c1c2c4s5 + c1c5s2 - s1s4s5)",
            ],
            [
                "s1(c2(c4c5c6 - s4s6) - s2s5c6) + c1(s4c5c6 + c4s6)",
                "s1(-c2(c4c5s6 + s4c6) + s2s5s6) + c1(-s4c5s6 + c4c6)",
                "s1(c2c4s5 + s2c5) + c1s4s5",
                "s1s2d3 + c1d2 + d6(c1s4s5 + c2c4s1s5 + c5s1s2)",
            ],
            [
                "-s2(c4c5c6 - s4s6) - c2s5c6",
                "s2(c4c5s6 + s4c6) + c2s5s6",
                "-s2c4s5 + c2c5",
                "c2d3 + d6(c2c5 - c4s2s5)",
            ],
            ["0", "0", "0", "1"],
        ],
    },
}
CASES = [(exercise, name) for exercise, forms in CLOSED_FORMS.items() for name in forms]


@pytest.mark.parametrize(("exercise", "name"), CASES)
def test_the_closed_form_is_right(
    exercise: str, name: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = graded_pose(catalogue[exercise], CLOSED_FORMS[exercise][name])
    assert full_marks(report), not_correct(report)
    assert [row.label for row in report.rows] == ["1", "2", "3", "4"]


@pytest.mark.parametrize("exercise", CLOSED_FORMS)
def test_only_the_entry_with_the_wrong_sign_is_wrong(
    exercise: str, catalogue: Mapping[str, Exercise]
) -> None:
    for i in range(4):
        for j in range(4):
            matrix = [list(line) for line in CLOSED_FORMS[exercise]["shorthand"]]
            if matrix[i][j] == "0":
                continue
            matrix[i][j] = f"-({matrix[i][j]})"
            report = graded_pose(catalogue[exercise], matrix)
            place = (str(i + 1), str(j + 1))
            assert not_correct(report) == {place: Verdict.INCORRECT}
            said = {m.code for m in (*report.rows[i].cells[j].feedback, *report.feedback)}
            assert "bottom_row" in said if i == 3 else "sign" in said
