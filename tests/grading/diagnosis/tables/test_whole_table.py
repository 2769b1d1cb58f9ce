"""Test the misconceptions about a whole table."""

# The tables are those of the Stanford arm of Spong, Hutchinson and Vidyasagar, with d1 and a2 added
# so that no column is 0. A table is correct if it gives the correct pose.

from dataclasses import replace

import numpy as np
from dh_grader.catalogue import Joint
from dh_grader.grading import frames as written_table
from dh_grader.grading.diagnosis import whole_tables as whole_table
from dh_grader.grading.diagnosis.whole_tables import WrongTable, explaining
from dh_grader.grading.frames import WrittenTable
from dh_grader.grading.misconception import hypotheses_of, records_of
from dh_grader.grading.numbers import HALF, SAMPLES, Samples
from dh_grader.kinematics import ALPHA, THETA, A, Convention, D, Table
from numpy.typing import NDArray

from tests.frame_choice.kinematics import screw_x, screw_z
from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair

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
