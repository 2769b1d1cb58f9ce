"""The textbooks' tables get full marks, however a student writes them."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise

from tests.grading.support.robots import ROBOTS, SPELLINGS, Robot, Spelling
from tests.grading.support.submitting import full_marks, graded_table


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
