"""Test misconceptions in whole tables."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import pytest
from dh_grader.catalogue import Exercise, Joint, Robot
from dh_grader.grading import Verdict
from dh_grader.grading import frames as written_table
from dh_grader.grading.diagnosis import whole_tables as whole_table
from dh_grader.grading.diagnosis.table_readings import lost_freedom
from dh_grader.grading.diagnosis.whole_tables import WrongTable, explaining
from dh_grader.grading.frames import WrittenTable
from dh_grader.grading.misconception import hypotheses_of, records_of
from dh_grader.grading.numbers import HALF, SAMPLES, Samples, draw
from dh_grader.grading.report import Finding, messages_of
from dh_grader.kinematics import ALPHA, THETA, A, Convention, D, Table
from numpy.typing import NDArray

from tests.frame_choice.kinematics import screw_x, screw_z
from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair
from tests.grading.support.submitting import graded_table, not_correct
from tests.shipped import shipped_exercises
from tests.together import together

# --- Test the misconceptions about a whole table

# The tables are those of the Stanford arm of Spong, Hutchinson and Vidyasagar, with d1 and a2 added
# so that no column is 0. A table is correct if it gives the correct pose.

RNG = np.random.default_rng(6)
JOINTS = tuple(Joint(i + 1, f"q{i + 1}", i == 2) for i in range(6))
SAMPLE = Samples({joint.variable: RNG.uniform(0.2, 1.4, SAMPLES) for joint in JOINTS})
LENGTHS = {name: np.tile(RNG.uniform(0.2, 0.9, HALF), 2) for name in ("d1", "d2", "a2", "d6")}
QUARTER = np.pi / 2


def right() -> Table:
    table = np.zeros((6, 4, SAMPLES))
    table[:, ALPHA] = np.array([-QUARTER, QUARTER, 0, -QUARTER, QUARTER, 0])[:, None]
    table[0, D], table[1, D], table[5, D] = LENGTHS["d1"], LENGTHS["d2"], LENGTHS["d6"]
    table[1, A] = LENGTHS["a2"]
    for i, joint in enumerate(JOINTS):
        table[i, D if joint.prismatic else THETA] += SAMPLE.values[joint.variable]
    return table


def pose(table: Table, convention: Convention) -> NDArray[np.float64]:
    reached = np.tile(np.eye(4), (table.shape[-1], 1, 1))
    for a, alpha, d, theta in table:
        z, x = screw_z(d, theta), screw_x(a, alpha)
        reached = reached @ (z @ x if convention is Convention.STANDARD else x @ z)
    return reached


def valid(candidates: NDArray[np.float64], convention: Convention) -> NDArray[np.bool_]:
    wanted = pose(right(), Convention.STANDARD)
    return np.array([np.abs(pose(t, convention) - wanted).max() < 1e-6 for t in candidates])


def wrong(table: Table) -> WrongTable:
    written = written_table.written_table(table, Convention.STANDARD, right(), JOINTS, SAMPLE)
    return WrongTable(written, written, valid)


def in_modified_rows(table: Table) -> Table:
    table[:, :2] = np.concatenate([np.zeros((1, 2, SAMPLES)), table[:-1, :2]])
    return table


def twists_too_late(table: Table) -> Table:
    table[:, ALPHA] = np.roll(table[:, ALPHA], 1, axis=0)
    return table


def with_columns(table: Table, one: int, other: int, row: int) -> Table:
    table[row, [one, other]] = table[row, [other, one]]
    return table


def with_rows(table: Table, i: int, j: int) -> Table:
    table[[i, j]] = table[[j, i]]
    return table


def with_angles(table: Table, factor: float) -> Table:
    motion = wrong(right()).written.motion
    constants = table - motion
    constants[:, [ALPHA, THETA]] *= factor
    return constants + motion


def with_sign(table: Table, column: int) -> Table:
    motion = wrong(right()).written.motion
    constants = table - motion
    constants[:, column] *= -1
    return constants + motion


def with_cell(table: Table, row: int, column: int, value: float) -> Table:
    table[row, column] = value
    return table


def with_lengths_exchanged() -> WrongTable:
    table = right()
    table[0, D], table[1, D] = LENGTHS["d2"], LENGTHS["d1"]
    written = replace(wrong(table).written, exchanges=(("d1", "d2", right() - table),))
    return WrongTable(written, written, valid)


PAIRS = [
    Pair(
        function,
        explained if isinstance(explained, WrongTable) else wrong(explained),
        wrong(unexplained),
        source=lambda case: case.written,
    )
    for function, explained, unexplained in (
        (
            written_table.other_convention,
            in_modified_rows(right()),
            with_rows(right(), 0, 1),
        ),
        (
            written_table.degrees_as_radians,
            with_angles(right(), 180 / np.pi),
            with_angles(right(), 2.0),
        ),
        (
            written_table.radians_as_degrees,
            with_angles(right(), np.pi / 180),
            with_angles(right(), 0.5),
        ),
        (
            whole_table.lengths_exchanged,
            with_lengths_exchanged(),
            with_cell(right(), 0, D, 0.3),
        ),
        (
            whole_table.link_columns_shifted,
            twists_too_late(right()),
            with_cell(right(), 0, ALPHA, QUARTER),
        ),
        (
            whole_table.column_sign,
            with_sign(right(), ALPHA),
            with_cell(right(), 0, ALPHA, 0.3),
        ),
        (
            whole_table.columns_swapped,
            with_columns(right(), A, D, 1),
            with_cell(right(), 1, A, 0.0),
        ),
        (
            whole_table.row_order,
            with_rows(right(), 3, 4),
            with_cell(right(), 3, ALPHA, QUARTER),
        ),
    )
]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    for case in (pair.explained, pair.unexplained):
        assert not valid(case.written.values[None], Convention.STANDARD)[0]
    assert_explains_only_the_first(pair)


@each_pair(PAIRS)
def test_the_code_of_a_misconception_is_found(pair: Pair) -> None:
    assert pair.function.__name__ in codes(pair.explained, combine=True)


def test_the_pairs_are_in_the_order_of_ranks() -> None:
    assert [pair.function for pair in PAIRS] == [
        record.function for record in records_of(WrittenTable)
    ]


def test_rows_in_reverse_order_are_found_if_the_last_row_is_in_its_place() -> None:
    # As in a modified table, where the row of the tool stays at the end.
    table = right()
    table[:-1] = table[-2::-1].copy()
    assert codes(wrong(table), combine=False) == ["row_order"]


def test_two_lengths_of_one_row_are_its_exchanged_columns() -> None:
    table = right()
    table[1, A], table[1, D] = LENGTHS["d2"], LENGTHS["a2"]
    written = replace(wrong(table).written, exchanges=(("a2", "d2", right() - table),))
    assert codes(WrongTable(written, written, valid), combine=True) == ["columns_swapped"]


def test_two_misconceptions_are_found_together() -> None:
    both = wrong(in_modified_rows(with_angles(right(), 180 / np.pi)))
    assert codes(both, combine=True) == ["other_convention", "degrees_as_radians"]
    assert codes(both, combine=False) == []
    [found] = explaining(both, combine=True)
    assert valid(found.answer.values[None], found.answer.convention)[0]


def codes(case: WrongTable, *, combine: bool) -> list[str]:
    found = explaining(case, combine=combine)
    return [finding.code for repaired in found for finding in repaired.findings]


def test_hypotheses_keep_the_size_of_a_table_of_one_row() -> None:
    one = WrittenTable(right()[:1], 0 * right()[:1], Convention.STANDARD, right()[:1])
    assert all(each.answer.values.shape == (1, 4, SAMPLES) for each in hypotheses_of(one))


# --- Recognise tables that have lost a degree of freedom

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


# --- Explain tables with two slips

STANFORD = [
    ("0", "-90deg", "0", "theta1"),
    ("0", "90deg", "d2", "theta2"),
    ("0", "0", "d3", "0"),
    ("0", "-90deg", "0", "theta4"),
    ("0", "90deg", "0", "theta5"),
    ("0", "0", "d6", "theta6"),
]
RRRP = [
    ("l2", "0", "l1", "q1"),
    ("l3", "180deg", "0", "q2"),
    ("0", "0", "l4", "q3"),
    ("0", "0", "q4", "0"),
]
COLUMNS = ("a", "alpha", "d", "theta")


@pytest.mark.parametrize(
    ("name", "table", "row", "other", "code"),
    [
        # Row 2 of the Stanford arm comes before its sliding joint.
        ("stanford-arm", STANFORD, 2, (1, 1, "90deg"), "sign"),
        ("stanford-arm", STANFORD, 2, (4, 1, "90deg"), "sign"),
        ("stanford-arm", STANFORD, 6, (2, 3, "theta1"), "joint_variable_index"),
        ("rrrp", RRRP, 1, (4, 2, "-q4"), "joint_variable_sign"),
    ],
)
def test_an_exchange_is_named_beside_another_slip(
    catalogue: Mapping[str, Exercise],
    name: str,
    table: list[tuple[str, ...]],
    row: int,
    other: tuple[int, int, str],
    code: str,
) -> None:
    rows = [list(each) for each in table]
    rows[row - 1][0], rows[row - 1][2] = rows[row - 1][2], rows[row - 1][0]
    i, column, text = other
    rows[i - 1][column] = text
    report = graded_table(catalogue[name], rows)
    codes = [message.code for message, _, _ in messages_of(report) if message.severity == "error"]
    assert sorted(codes) == sorted(["columns_swapped", code])
    wrong = {(str(row), "a"), (str(row), "d"), (str(i), COLUMNS[column])}
    assert not_correct(report) == dict.fromkeys(wrong, Verdict.INCORRECT)


def test_a_missing_offset_is_no_exchange(catalogue: Mapping[str, Exercise]) -> None:
    rows = [list(row) for row in STANFORD]
    rows[1][2], rows[0][1] = "0", "90deg"
    report = graded_table(catalogue["stanford-arm"], rows)
    codes = {message.code for message, _, _ in messages_of(report)}
    assert "columns_swapped" not in codes
