"""Answers that lectures print get full marks."""

# The LaTeX is copied from the lectures: Robotic Fundamentals (UMFM4X-15-M), *Forward Kinematics*;
# Robotics and Automation, *Direct Kinematics (Part 2)*; MEAM 520, *More Denavit-Hartenberg (DH)*;
# and the Robot kinematics lecture notes. Tables are copied cell by cell with the lecture's own
# headers.

from collections.abc import Mapping
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Verdict

from tests.grading.support.robots import AngleUnit
from tests.grading.support.submitting import full_marks, handed_in, not_correct, part, table


def pasted(head: str, *rows: str) -> str:
    return "\n".join("\t".join(line.split(" ")) for line in (head, *rows))


def matrix(*rows: str) -> str:
    return r"\begin{bmatrix} " + r" \\ ".join(rows) + r" \end{bmatrix}"


LEVEL = "0 & 0 & 1 & 0"
BOTTOM = "0 & 0 & 0 & 1"
DISTAL = "n a_n α_n d_n θ_n"

PLANAR_RRR = {
    "table": pasted(
        "n a_{n-1} α_{n-1} d_n q_n", "1 0 0 0 q_1", "2 l_1 0 0 q_2", "3 l_2 0 0 q_3", "e l_3 0 0 0"
    ),
    "links": [
        matrix("c_{q_1} & -s_{q_1} & 0 & 0", "s_{q_1} & c_{q_1} & 0 & 0", LEVEL, BOTTOM),
        matrix("c_{q_2} & -s_{q_2} & 0 & l_1", "s_{q_2} & c_{q_2} & 0 & 0", LEVEL, BOTTOM),
        matrix("c_{q_3} & -s_{q_3} & 0 & l_2", "s_{q_3} & c_{q_3} & 0 & 0", LEVEL, BOTTOM),
        matrix("1 & 0 & 0 & l_3", "0 & 1 & 0 & 0", LEVEL, BOTTOM),
    ],
}
RRRP = {
    "table": pasted(DISTAL, "1 l_2 0 l_1 q_1", "2 l_3 π 0 q_2", "3 0 0 l_4 q_3", "4 0 0 q_4 0"),
}
SPATIAL_RRR = {
    "table": pasted(DISTAL, "1 R 90° 0 θ_1", "2 L_1 0 0 θ_2", "3 L_2 0 0 θ_3"),
    "links": [
        matrix(
            r"c\theta_1 & 0 & s\theta_1 & Rc\theta_1",
            r"s\theta_1 & 0 & -c\theta_1 & Rs\theta_1",
            "0 & 1 & 0 & 0",
            BOTTOM,
        ),
        matrix(
            r"c\theta_2 & -s\theta_2 & 0 & L_1c\theta_2",
            r"s\theta_2 & c\theta_2 & 0 & L_1s\theta_2",
            LEVEL,
            BOTTOM,
        ),
        matrix(
            r"c\theta_3 & -s\theta_3 & 0 & L_2c\theta_3",
            r"s\theta_3 & c\theta_3 & 0 & L_2s\theta_3",
            LEVEL,
            BOTTOM,
        ),
    ],
    "pose": matrix(
        r"c\theta_1 c\theta_{23} & -c\theta_1 s\theta_{23} & s\theta_1"
        r" & c\theta_1(L_2 c\theta_{23} + L_1 c\theta_2 + R)",
        r"s\theta_1 c\theta_{23} & -s\theta_1 s\theta_{23} & -c\theta_1"
        r" & s\theta_1(L_2 c\theta_{23} + L_1 c\theta_2 + R)",
        r"s\theta_{23} & c\theta_{23} & 0 & L_2 s\theta_{23} + L_1 s\theta_2",
        BOTTOM,
    ),
    "position": [
        r"c\theta_1(L_2 c\theta_{23} + L_1 c\theta_2 + R)",
        r"s\theta_1(L_2 c\theta_{23} + L_1 c\theta_2 + R)",
        r"L_2 s\theta_{23} + L_1 s\theta_2",
    ],
}
PLANAR_RR = {
    "table": pasted("Link a_i α_i d_i θ_i", "1 a_1 0 0 θ_1^*", "2 a_2 0 0 θ_2^*"),
    "links": [
        matrix("c_1 & -s_1 & 0 & a_1 c_1", "s_1 & c_1 & 0 & a_1 s_1", LEVEL, BOTTOM),
        matrix("c_2 & -s_2 & 0 & a_2 c_2", "s_2 & c_2 & 0 & a_2 s_2", LEVEL, BOTTOM),
    ],
    "pose": matrix(
        "c_{12} & -s_{12} & 0 & a_1 c_1 + a_2 c_{12}",
        "s_{12} & c_{12} & 0 & a_1 s_1 + a_2 s_{12}",
        LEVEL,
        BOTTOM,
    ),
    # Robot kinematics lecture notes, The end-effector coordinates.
    "position": ["a_1c_1+a_2c_{12}", "a_1s_1+a_2s_{12}"],
}
STANFORD_TABLE = pasted(
    "Link d_i a_i α_i θ_i",
    "1 0 0 -90 θ_1^*",
    "2 d_2 0 +90 θ_2^*",
    "3 d_3^* 0 0 0",
    "4 0 0 -90 θ_4^*",
    "5 0 0 +90 θ_5^*",
    "6 d_6 0 0 θ_6^*",
)
STANFORD_LINKS = [
    matrix("c_1 & 0 & -s_1 & 0", "s_1 & 0 & c_1 & 0", "0 & -1 & 0 & 0", BOTTOM),
    matrix("c_2 & 0 & s_2 & 0", "s_2 & 0 & -c_2 & 0", "0 & 1 & 0 & d_2", BOTTOM),
    matrix("1 & 0 & 0 & 0", "0 & 1 & 0 & 0", "0 & 0 & 1 & d_3", BOTTOM),
    matrix("c_4 & 0 & -s_4 & 0", "s_4 & 0 & c_4 & 0", "0 & -1 & 0 & 0", BOTTOM),
    # The misprint: −1 in the third row.
    matrix("c_5 & 0 & s_5 & 0", "s_5 & 0 & -c_5 & 0", "0 & -1 & 0 & 0", BOTTOM),
    matrix("c_6 & -s_6 & 0 & 0", "s_6 & c_6 & 0 & 0", "0 & 0 & 1 & d_6", BOTTOM),
]
ABOUT_X = matrix("1 & 0 & 0", r"0 & \cos\phi & -\sin\phi", r"0 & \sin\phi & \cos\phi")

PRINTED: dict[str, tuple[Mapping[str, object], AngleUnit]] = {
    "fundamental-rotations": ({"about-x": ABOUT_X}, "radians"),
    "planar-rr": (PLANAR_RR, "radians"),
    "planar-rrr": ({"table": PLANAR_RRR["table"]}, "radians"),
    "planar-rrr-drawn": (PLANAR_RRR, "radians"),
    "rrrp": (RRRP, "radians"),
    "rrrp-drawn": (RRRP, "radians"),
    # S_ω = (0, 0, 1), S_v = (0, −2, 0)
    "simple-twist": ({"zero-pitch": [[0, 0, 1, 0, -2, 0]]}, "radians"),
    "spatial-rrr": (SPATIAL_RRR, "radians"),
    "stanford-arm": ({"table": STANFORD_TABLE}, "degrees"),
    "stanford-arm-drawn": ({"table": STANFORD_TABLE}, "degrees"),
}
CASES = [(exercise, name) for exercise, (answers, _) in PRINTED.items() for name in answers]


def codes(report: PartReport) -> set[str]:
    told = [*report.feedback]
    for row in report.rows:
        told += [*row.feedback, *(message for cell in row.cells for message in cell.feedback)]
    return {message.code for message in told}


def graded(
    catalogue: Mapping[str, Exercise],
    exercise: str,
    name: str,
    answer: Any,
    unit: AngleUnit = "radians",
) -> PartReport:
    return part(handed_in(catalogue[exercise], {name: answer}, unit), name)


@pytest.mark.parametrize(("exercise", "name"), CASES)
def test_an_answer_of_a_lecture_gets_full_marks(
    exercise: str, name: str, catalogue: Mapping[str, Exercise]
) -> None:
    answers, unit = PRINTED[exercise]
    report = graded(catalogue, exercise, name, answers[name], unit)
    assert full_marks(report), (codes(report), not_correct(report))
    assert not report.follow_through


@pytest.mark.parametrize("link", [1, 2, 3, 4, 6])
def test_each_other_link_transform_of_the_stanford_arm_is_right(
    link: int, catalogue: Mapping[str, Exercise]
) -> None:
    report = graded(catalogue, "stanford-arm", "links", STANFORD_LINKS)
    assert not {row for row, _ in not_correct(report) if row.startswith(f"A{link}.")}


def test_a5_of_the_stanford_arm_is_misprinted_left_handed(
    catalogue: Mapping[str, Exercise],
) -> None:
    report = graded(catalogue, "stanford-arm", "links", STANFORD_LINKS)
    assert not_correct(report) == {("A5.3", "2"): Verdict.INCORRECT}
    assert {"left_handed_rotation", "sign"} <= codes(report)
    assert 11 < report.points < 12
    mended = [*STANFORD_LINKS]
    mended[4] = mended[4].replace("0 & -1 & 0 & 0", "0 & 1 & 0 & 0")
    assert full_marks(graded(catalogue, "stanford-arm", "links", mended))


def test_the_pitch_of_the_spatial_arm_is_printed_with_the_wrong_sign(
    catalogue: Mapping[str, Exercise],
) -> None:
    printed = graded(
        catalogue, "spatial-rrr", "rpy", [r"\theta_1", r"\theta_2 + \theta_3", r"90^\circ"]
    )
    assert not_correct(printed) == {("2", "1"): Verdict.INCORRECT}
    assert codes(printed) == {"sign"}
    assert printed.points == 2
    assert full_marks(graded(catalogue, "spatial-rrr", "rpy", ["θ1", "-(θ2 + θ3)", r"90^\circ"]))


def test_the_pitch_by_the_formula_that_the_lecture_prints_with_it(
    catalogue: Mapping[str, Exercise],
) -> None:
    # For c23 < 0, β = Atan2(−r31, √(r11² + r21²)) leads to other, also correct angles.
    r11, r21, r31, r32, r33 = "c1 c23", "s1 c23", "s23", "c23", "0"
    beta = f"atan2(-({r31}), sqrt(({r11})^2 + ({r21})^2))"
    by_formula = [
        f"atan2({r21}/cos({beta}), {r11}/cos({beta}))",
        beta,
        f"atan2({r32}/cos({beta}), {r33}/cos({beta}))",
    ]
    assert full_marks(graded(catalogue, "spatial-rrr", "rpy", by_formula))


def test_the_final_stanford_table_of_robotic_fundamentals_has_lost_a_degree_of_freedom(
    catalogue: Mapping[str, Exercise],
) -> None:
    printed = pasted(
        "i a_i α_i d_i θ_i",
        "1 0 90° d_1 q_1",
        "2 0 90° d_2 q_2",
        "3 0 90° q_3 90°",
        "4 0 90° 0 q_4",
        "5 0 0° 0 q_5",
        "6 0 0° d_6 q_6",
    )
    report = graded(catalogue, "stanford-arm-d1", "table", printed)
    [lost] = [message for message in report.feedback if message.code == "lost_freedom"]
    assert "Joints 5 and 6 turn about one and the same line" in lost.message
    assert "row 5" in lost.message
    # One cell in each of rows 3, 4 and 5, and the direction of joint 2, differ from the statement.
    assert not_correct(report) == {
        ("1", "alpha"): Verdict.INCORRECT,
        ("3", "alpha"): Verdict.INCORRECT,
        ("4", "theta"): Verdict.INCORRECT,
        ("5", "alpha"): Verdict.INCORRECT,
    }
    assert report.points < 10


def test_the_spherical_wrist_with_the_angle_at_which_it_is_drawn(
    catalogue: Mapping[str, Exercise],
) -> None:
    # The figure is drawn with θ5 = −90°, but the correct table has no offset.
    rows = [("0", "-90", "0", "theta4"), ("0", "90", "0", "theta5"), ("0", "0", "d6", "theta6")]
    assert full_marks(graded(catalogue, "spherical-wrist", "table", table(rows), "degrees"))
    rows[1] = ("0", "90", "0", "theta5 - 90")
    report = graded(catalogue, "spherical-wrist", "table", table(rows), "degrees")
    assert not_correct(report) == {("5", "theta"): Verdict.INCORRECT}
    assert "quarter_turn" in codes(report)


def test_the_parallel_axes_of_the_lecture_notes_read_literally_are_left_handed(
    catalogue: Mapping[str, Exercise],
) -> None:
    # x0 ∥ x1, z0 ∥ y1, y0 ∥ z1: a quarter turn about x0 needs z1 opposite to y0.
    literal = [[1, 0, 0], [0, 0, 1], [0, 1, 0]]
    report = graded(catalogue, "rigid-motion-chain", "parallel-axes", literal)
    assert not_correct(report) == {("2", "3"): Verdict.INCORRECT}
    assert {"left_handed_rotation", "sign"} <= codes(report)
    turned = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]
    assert full_marks(graded(catalogue, "rigid-motion-chain", "parallel-axes", turned))


def test_the_task_space_vector(catalogue: Mapping[str, Exercise]) -> None:
    # The lecture prints cos θ_12. The grader refuses it, because θ_12 could also mean joint 12.
    printed = [
        r"l_1 \cos \theta_1 + l_2 \cos \theta_{12} + l_3 \cos \theta_{123}",
        r"l_1 \sin \theta_1 + l_2 \sin \theta_{12} + l_3 \sin \theta_{123}",
        r"\theta_1 + \theta_2 + \theta_3",
    ]
    report = graded(catalogue, "planar-rrr-standard", "task-space", printed)
    assert not_correct(report) == {
        ("1", "1"): Verdict.UNREADABLE,
        ("2", "1"): Verdict.UNREADABLE,
    }
    assert codes(report) == {"unknown_joint"}
    mended = [row.cells[0].feedback[0].suggestion for row in report.rows[:2]]
    assert full_marks(graded(catalogue, "planar-rrr-standard", "task-space", [*mended, printed[2]]))
    short = [text.replace(r"\cos \theta_", "c_").replace(r"\sin \theta_", "s_") for text in printed]
    assert full_marks(graded(catalogue, "planar-rrr-standard", "task-space", short))
