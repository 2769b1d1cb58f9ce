"""Corrections use the student's notation."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Correction, PartReport
from dh_grader.grading.report import messages_of

from tests.grading.support.robots import EXACT, PLANAR_RRR, STANFORD, AngleUnit
from tests.grading.support.submitting import full_marks, graded_pose, graded_table


def corrected(report: PartReport, row: str, column: str) -> Correction | None:
    """Return the correction of a cell."""
    [found] = [
        place.correction or message.correction
        for message, places, _ in messages_of(report)
        for place in places
        if (place.row, place.cell) == (row, column)
    ]
    return found


@pytest.mark.parametrize(
    ("wrong", "others", "unit", "text", "latex"),
    [
        ("pi/2", "pi/2", "radians", "-pi/2", r"-\frac{\pi}{2}"),
        ("π/2", "π/2", "radians", "-π/2", r"-\frac{\pi}{2}"),
        ("90°", "90°", "radians", "-90°", r"-90^{\circ}"),
        ("90deg", "90deg", "radians", "-90deg", r"-90^{\circ}"),
        ("90", "90", "degrees", "-90", r"-90^{\circ}"),
        ("90deg", "pi/2", "radians", "-90deg", r"-90^{\circ}"),
        ("90", "pi/2", "radians", "-90deg", r"-90^{\circ}"),
        ("0", "90°", "radians", "-90°", r"-90^{\circ}"),
        ("0", "pi/2", "radians", "-pi/2", r"-\frac{\pi}{2}"),
        ("1.5708", "1.5708", "radians", "-pi/2", r"-\frac{\pi}{2}"),
    ],
)
def test_a_corrected_angle_has_the_students_spelling(
    wrong: str, others: str, unit: AngleUnit, text: str, latex: str,
    given_frames: Mapping[str, Exercise],
) -> None:  # fmt: skip
    rows = [
        [cell.replace("pi/2", others).replace("90deg", others) for cell in row]
        for row in EXACT.rows(STANFORD)
    ]
    rows[0][1] = wrong
    report = graded_table(given_frames[STANFORD.exercise], rows, unit)
    assert corrected(report, "1", "alpha") == Correction(text, latex)
    rows[0][1] = text
    assert full_marks(graded_table(given_frames[STANFORD.exercise], rows, unit)) or "1.5" in others


@pytest.mark.parametrize(
    ("typed", "text", "latex"),
    [
        ("theta{}", "theta1", r"\theta_{1}"),
        ("q{}", "q1", "q_{1}"),
        ("θ{}", "θ1", r"\theta_{1}"),
        ("θ_{}", "θ_1", r"\theta_{1}"),
        (r"\theta_{}", "theta1", r"\theta_{1}"),
        ("q{}*", "q1", "q_{1}"),
    ],
)
def test_a_corrected_joint_variable_has_the_students_spelling(
    typed: str, text: str, latex: str, given_frames: Mapping[str, Exercise]
) -> None:
    rows = [list(row) for row in EXACT.rows(STANFORD)]
    for i in (0, 1, 3, 4, 5):
        rows[i][3] = typed.format(i + 1)
    rows[0][3] = "0"
    report = graded_table(given_frames[STANFORD.exercise], rows)
    assert corrected(report, "1", "theta") == Correction(text, latex)


def test_a_corrected_formula_has_the_students_spelling(catalogue: Mapping[str, Exercise]) -> None:
    for cosine, text in (("c12", "c12"), ("cos(q1 + q2)", "cos(q1 + q2)")):
        pose = [["0"] * 4 for _ in range(4)]
        pose[0][3] = f"l1*{cosine.replace('12', '1').replace(' + q2', '')} - l2*{cosine}"
        pose[0][3] += f" + l3*{cosine.replace('12', '123').replace('q2', 'q2 + q3')}"
        report = graded_pose(catalogue[PLANAR_RRR.exercise], pose)
        found = corrected(report, "1", "4")
        assert found is not None
        assert f"+ l2*{text} +" in found.text


def test_a_hint_uses_the_students_name_of_a_joint_variable(
    given_frames: Mapping[str, Exercise],
) -> None:
    rows = [list(row) for row in EXACT.rows(STANFORD)]
    rows[1][3] = "θ_1"
    report = graded_table(given_frames[STANFORD.exercise], rows)
    [message] = report.rows[1].cells[3].feedback
    assert "the cell contains θ_1, the variable of joint 1" in message.message
