"""Recognise tables that have lost a degree of freedom."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import pytest
from dh_grader.catalogue import Exercise, Robot
from dh_grader.grading.diagnosis.table_readings import lost_freedom
from dh_grader.grading.numbers import SAMPLES, Samples, draw
from dh_grader.grading.report import Finding
from dh_grader.kinematics import ALPHA, THETA, A, Convention, D, Table

from tests.shipped import shipped_exercises
from tests.together import together

H = np.pi / 2
Cell = str | float


@pytest.fixture
def stanford(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["stanford-arm"]


def samples_of(exercise: Exercise) -> Samples:
    return draw(exercise, "freedom")


def written(rows: Sequence[Sequence[Cell]], samples: Samples) -> Table:
    # Return the table in numbers; each cell is a number or the name of a symbol.
    return np.array(
        [
            [
                samples.values[cell] if isinstance(cell, str) else np.full(SAMPLES, float(cell))
                for cell in row
            ]
            for row in rows
        ]
    )


def found(
    exercise: Exercise,
    table: Table,
    convention: Convention = Convention.STANDARD,
    rows: Sequence[int | None] | None = None,
) -> tuple[Finding, ...]:
    joint_rows = range(len(exercise.robot.joints)) if rows is None else rows
    return lost_freedom(table, joint_rows, convention, exercise, samples_of(exercise))


PRINTED: list[list[Cell]] = [
    [0, H, 0.3, "theta1"],
    [0, H, "d2", "theta2"],
    [0, H, "d3", H],
    [0, H, 0, "theta4"],
    [0, 0, 0, "theta5"],
    [0, 0, "d6", "theta6"],
]


def test_the_printed_stanford_table_has_lost_freedom(stanford: Exercise) -> None:
    # This is the worked example of robots.md, "Errata".
    [finding] = found(stanford, written(PRINTED, samples_of(stanford)))
    assert finding.code == "lost_freedom"
    assert finding.hint == (
        "Joints 5 and 6 turn about one and the same line, so the arm has lost a degree of freedom: "
        "check α of row 5."
    )
    assert finding.correction == "The axes of these joints are at right angles."


REFERENCES = [
    (exercise_id, convention)
    for exercise_id, exercise in shipped_exercises().items()
    if isinstance(exercise.reference, Robot)
    for convention in exercise.robot.tables
]


@together(("exercise_id", "convention"), REFERENCES)
def test_a_reference_has_not_lost_freedom(
    exercise_id: str, convention: Convention, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[exercise_id]
    values = samples_of(exercise).values
    assert (
        found(exercise, exercise.robot.tables[convention].values(values, SAMPLES), convention) == ()
    )


@pytest.mark.parametrize(
    ("convention", "row"), [(Convention.STANDARD, 0), (Convention.MODIFIED, 1)]
)
def test_parallel_axes_that_coincide_are_named(
    convention: Convention, row: int, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue["scara"]
    table = exercise.robot.tables[convention].values(samples_of(exercise).values, SAMPLES)
    table[row, A] = 0.0
    [finding] = found(exercise, table, convention)
    assert finding.hint.startswith("Joints 1 and 2 turn about one and the same line")
    assert finding.hint.endswith(f"check a of row {row + 1}.")
    assert finding.correction == "The axes of these joints are parallel, but apart."


def test_joints_that_share_an_axis_need_not_be_neighbours(stanford: Exercise) -> None:
    table = stanford.robot.tables[Convention.STANDARD].values(samples_of(stanford).values, SAMPLES)
    table[1, ALPHA] = 0.0
    [finding] = found(stanford, table)
    assert finding.hint.startswith("Joints 2 and 4 turn")
    assert finding.hint.endswith("check α of rows 2 and 3.")


def test_four_dependent_joints_are_named(catalogue: Mapping[str, Exercise]) -> None:
    # With α3 = 90°, the last joint slides in the plane in which the other three move the arm.
    exercise = catalogue["rrrp"]
    table = exercise.robot.tables[Convention.STANDARD].values(samples_of(exercise).values, SAMPLES)
    table[2, ALPHA] = H
    [finding] = found(exercise, table)
    assert "joints 1, 2, 3 and 4" in finding.hint
    assert "fewer degrees of freedom than the robot" in finding.hint


CARTESIAN = """
title = "Cartesian arm"
source = "Spong, Hutchinson, Vidyasagar, 3-7"
statement = "Three sliding joints at right angles."

[robot]
structure = "PPP"
convention = "standard"
joints = ["d1", "d2", "d3"]
table = [
    ["0", "-90deg", "d1", "0"],
    ["0", "-90deg", "d2", "-90deg"],
    ["0", "0", "d3", "0"],
]

[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
prompt = "Give the table."
points = 1
convention = "standard"
"""


def test_two_joints_that_slide_along_one_direction_are_named(
    make_exercise: Callable[[str], Exercise],
) -> None:
    exercise = make_exercise(CARTESIAN)
    table = exercise.robot.tables[Convention.STANDARD].values(samples_of(exercise).values, SAMPLES)
    assert found(exercise, table) == ()
    table[0, ALPHA] = np.pi
    table[0, A] = 0.4
    [finding] = found(exercise, table)
    assert finding.hint.startswith("Joints 1 and 2 slide along one and the same direction")
    assert finding.hint.endswith("check α of row 1.")


REDUNDANT = """
title = "Four parallel axes, the last two on one line"
source = "Made for this test."
statement = "A planar arm with a redundant joint."

[robot]
structure = "RRRR"
convention = "standard"
joints = ["q1", "q2", "q3", "q4"]
table = [
    ["l1", "0", "0", "q1"],
    ["l2", "0", "0", "q2"],
    ["0", "0", "h", "q3"],
    ["l1", "0", "0", "q4"],
]

[symbols]
l1 = { kind = "length", description = "l1" }
l2 = { kind = "length", description = "l2" }
h = { kind = "length", description = "h" }

[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
prompt = "Give the table."
points = 1
convention = "standard"
"""


def test_freedom_that_the_robot_lacks_is_not_lost(make_exercise: Callable[[str], Exercise]) -> None:
    exercise = make_exercise(REDUNDANT)
    table = exercise.robot.tables[Convention.STANDARD].values(samples_of(exercise).values, SAMPLES)
    assert found(exercise, table) == ()
    table[0, A] = 0.0
    [finding] = found(exercise, table)
    assert finding.hint.startswith("Joints 1 and 2 turn")


def test_a_joint_without_its_variable_gets_no_finding(stanford: Exercise) -> None:
    # Joints 4 and 6 share an axis only because joint 5 does not turn.
    table = stanford.robot.tables[Convention.STANDARD].values(samples_of(stanford).values, SAMPLES)
    table[4, THETA] = 0.0
    assert not found(stanford, table)


def test_a_joint_without_a_row_is_left_out(stanford: Exercise) -> None:
    table = written(PRINTED, samples_of(stanford))[:5]
    assert found(stanford, table, rows=[0, 1, 2, 3, 4, None]) == ()
    table = written(PRINTED, samples_of(stanford))[3:]
    [finding] = found(stanford, table, rows=[None, None, None, 0, 1, 2])
    assert finding.hint.startswith("Joints 5 and 6 turn")


def test_a_table_with_an_unreadable_cell_gets_no_finding(stanford: Exercise) -> None:
    table = written(PRINTED, samples_of(stanford))
    table[0, A] = np.nan
    assert found(stanford, table) == ()


def test_a_wrong_table_need_not_have_lost_freedom(stanford: Exercise) -> None:
    table = stanford.robot.tables[Convention.STANDARD].values(samples_of(stanford).values, SAMPLES)
    table[1, D] *= -1
    table[4, ALPHA] *= -1
    table[3, A] = 0.3
    assert found(stanford, table) == ()


@together("length", [1e5, 1e7, 1e9])
@together(("exercise_id", "convention"), REFERENCES)
def test_an_extremely_large_length_gets_no_finding(
    exercise_id: str, convention: Convention, length: float, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[exercise_id]
    values = samples_of(exercise).values
    for row in range(len(exercise.robot.joints)):
        table = exercise.robot.tables[convention].values(values, SAMPLES)
        table[row, A] += length
        assert found(exercise, table, convention) == (), row
