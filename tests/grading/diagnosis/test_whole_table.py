"""Each misconception about a whole table: one table that it explains, one that it leaves alone.

What a misconception is tried on is the Stanford arm of Spong, Hutchinson and Vidyasagar, with d1
and a2 added so that every column holds something. A table is right if its pose is, multiplied out
here.
"""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from service.catalogue import Joint
from service.grading.diagnosis import whole_table
from service.grading.diagnosis.whole_table import (
    MISCONCEPTIONS,
    Misconception,
    WrittenTable,
    explanations,
    written_table,
)
from service.grading.samples import HALF, SAMPLES, Samples
from service.kinematics.chain import ALPHA, THETA, A, D, Table
from service.kinematics.dh import Convention
from tests.frame_choice.kinematics import screw_x, screw_z

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


def written(table: Table) -> WrittenTable:
    return written_table(table, Convention.STANDARD, right(), JOINTS, SAMPLE)


def in_modified_rows(table: Table) -> Table:
    """Row i with the link before joint i: the last link has no row, here it is none."""
    table[:, :2] = np.concatenate([np.zeros((1, 2, SAMPLES)), table[:-1, :2]])
    return table


def twists_too_late(table: Table) -> Table:
    """Only the twists: with the lengths it would be the other convention."""
    table[:, ALPHA] = np.roll(table[:, ALPHA], 1, axis=0)
    return table


def with_columns(table: Table, one: int, other: int, row: int) -> Table:
    table[row, [one, other]] = table[row, [other, one]]
    return table


def with_rows(table: Table, i: int, j: int) -> Table:
    table[[i, j]] = table[[j, i]]
    return table


def with_angles(table: Table, factor: float) -> Table:
    motion = written(right()).motion
    constants = table - motion
    constants[:, [ALPHA, THETA]] *= factor
    return constants + motion


def with_sign(table: Table, column: int) -> Table:
    motion = written(right()).motion
    constants = table - motion
    constants[:, column] *= -1
    return constants + motion


def with_cell(table: Table, row: int, column: int, value: float) -> Table:
    table[row, column] = value
    return table


Change = Callable[[Table], Table]
PAIRS: list[tuple[Misconception, Change, Change]] = [
    (whole_table.other_convention, in_modified_rows, lambda t: with_rows(t, 0, 1)),
    (
        whole_table.degrees_as_radians,
        lambda t: with_angles(t, 180 / np.pi),
        lambda t: with_angles(t, 2.0),
    ),
    (
        whole_table.radians_as_degrees,
        lambda t: with_angles(t, np.pi / 180),
        lambda t: with_angles(t, 0.5),
    ),
    (whole_table.link_columns_shifted, twists_too_late, lambda t: with_cell(t, 0, ALPHA, QUARTER)),
    (whole_table.column_sign, lambda t: with_sign(t, ALPHA), lambda t: with_cell(t, 0, ALPHA, 0.3)),
    (
        whole_table.columns_swapped,
        lambda t: with_columns(t, A, D, 1),
        lambda t: with_cell(t, 1, A, 0.0),
    ),
    (
        whole_table.row_order,
        lambda t: with_rows(t, 3, 4),
        lambda t: with_cell(t, 3, ALPHA, QUARTER),
    ),
]
IDS = [misconception.__name__ for misconception, _, _ in PAIRS]


def repairs(misconception: Misconception, table: Table) -> list[str]:
    """The codes of what the misconception offers, where that makes the table right."""
    offered = list(misconception(written(table)))
    return [
        repair.finding().code
        for repair in offered
        if valid(repair.table.values[None], repair.table.convention)[0]
    ]


@pytest.mark.parametrize(("misconception", "explained", "left"), PAIRS, ids=IDS)
def test_a_misconception_about_a_table(
    misconception: Misconception, explained: Change, left: Change
) -> None:
    for change in (explained, left):
        assert not valid(change(right())[None], Convention.STANDARD)[0]
    assert set(repairs(misconception, explained(right()))) == {misconception.__name__}
    assert repairs(misconception, left(right())) == []


@pytest.mark.parametrize(("misconception", "explained", "_"), PAIRS, ids=IDS)
def test_it_is_what_is_told(misconception: Misconception, explained: Change, _: Change) -> None:
    assert misconception.__name__ in told(explained(right()), combine=True)


def test_two_misconceptions_at_once() -> None:
    both = in_modified_rows(with_angles(right(), 180 / np.pi))
    assert told(both, combine=True) == ["other_convention", "degrees_as_radians"]
    assert told(both, combine=False) == []


def test_an_explanation_repairs_the_table_at_other_samples() -> None:
    table = written(in_modified_rows(with_angles(right(), 180 / np.pi)))
    [found] = explanations(table.subset(3), valid_subset, combine=True)
    repaired = found.repaired(table)
    assert valid(repaired.values[None], repaired.convention)[0]


def valid_subset(candidates: NDArray[np.float64], convention: Convention) -> NDArray[np.bool_]:
    wanted = SAMPLE.subset_of(np.moveaxis(pose(right(), Convention.STANDARD), 0, -1), 3)
    reached = [np.moveaxis(pose(table, convention), 0, -1) for table in candidates]
    return np.array([np.abs(each - wanted).max() < 1e-6 for each in reached])


def told(table: Table, *, combine: bool) -> list[str]:
    found = explanations(written(table), valid, combine=combine)
    return [finding.code for explanation in found for finding in explanation.findings]


def test_every_misconception_about_a_table_is_tested_and_tried() -> None:
    assert [pair[0] for pair in PAIRS] == list(MISCONCEPTIONS)
