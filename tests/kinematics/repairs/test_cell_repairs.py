"""Find the correct values of one or two wrong cells."""

import numpy as np
import pytest
from dh_grader.kinematics import CellIndex, Convention, Table, factors_of, pose
from dh_grader.kinematics.frame_choice_repairs import (
    one_factor_repairs,
    repaired_values,
    two_factor_repairs,
)

from tests.together import together

SAMPLES = 4
CONVENTIONS = pytest.mark.parametrize("convention", list(Convention))
SEEDS = together("seed", range(40))


def arm(rng: np.random.Generator) -> Table:
    table = rng.uniform(0.3, 1.2, (5, 4, SAMPLES))
    table[:, 1] = rng.choice([0.0, np.pi / 2, -np.pi / 2, np.pi], 5)[:, None]
    table[:, 0][rng.random(5) < 0.4] = 0.0
    table[:, 2][rng.random(5) < 0.3] = 0.0
    return table


def with_wrong(table: Table, cells: list[CellIndex], rng: np.random.Generator) -> Table:
    wrong = table.copy()
    for cell in cells:
        wrong[cell] += rng.uniform(0.2, 1.0, SAMPLES)
    return wrong


def drawn(rng: np.random.Generator) -> CellIndex:
    return int(rng.integers(5)), int(rng.integers(4))


def turned(angle: np.ndarray) -> np.ndarray:
    return angle - 2 * np.pi * np.round(angle / (2 * np.pi))


@CONVENTIONS
@SEEDS
def test_one_wrong_cell_is_among_the_repairs(convention: Convention, seed: int) -> None:
    rng = np.random.default_rng(seed)
    table, cell = arm(rng), drawn(rng)
    wrong = with_wrong(table, [cell], rng)
    repairs = one_factor_repairs(factors_of(wrong, convention), pose(table, convention))
    [repair] = [repair for repair in repairs if repair.cells == (cell,)]
    np.testing.assert_allclose(turned(repair.values[0] - table[cell]), 0, atol=1e-9)
    for other in repairs:  # every other repair makes the pose right, too
        assert_repairs(wrong, other.cells, other.values, table, convention)


@CONVENTIONS
@SEEDS
def test_two_wrong_cells_are_among_the_repairs(convention: Convention, seed: int) -> None:
    rng = np.random.default_rng(1000 + seed)
    table, cells = arm(rng), sorted({drawn(rng), drawn(rng)})
    if len(cells) < 2:
        pytest.skip("the same cell twice")
    wrong = with_wrong(table, cells, rng)
    factors, target = factors_of(wrong, convention), pose(table, convention)
    offered = [*one_factor_repairs(factors, target), *two_factor_repairs(factors, target)]
    for repair in offered:
        assert_repairs(wrong, repair.cells, repair.values, table, convention)
    assert any(set(repair.cells) <= set(cells) for repair in offered)


def assert_repairs(
    wrong: Table,
    cells: tuple[CellIndex, ...],
    values: np.ndarray,
    table: Table,
    convention: Convention,
) -> None:
    filled = wrong.copy()
    for cell, value in zip(cells, values, strict=True):
        filled[cell] = value
    np.testing.assert_allclose(pose(filled, convention), pose(table, convention), atol=1e-6)


@CONVENTIONS
def test_a_repair_can_be_computed_at_other_samples(convention: Convention) -> None:
    rng = np.random.default_rng(7)
    table = arm(rng)
    for cells in ([(1, 2)], [(3, 0), (3, 1)], [(4, 1), (1, 2)], [(0, 3), (3, 3)]):
        wrong = with_wrong(table, cells, rng)
        factors, target = factors_of(wrong, convention), pose(table, convention)
        values = repaired_values(factors, target, cells)
        assert values is not None
        assert_repairs(wrong, tuple(cells), values, table, convention)
        elsewhere = [(2, 1)]
        assert repaired_values(factors, target, elsewhere) is None


@CONVENTIONS
def test_three_wrong_cells_have_no_repair(convention: Convention) -> None:
    rng = np.random.default_rng(8)
    table = arm(rng)
    wrong = with_wrong(table, [(0, 1), (2, 2), (4, 0)], rng)
    factors, target = factors_of(wrong, convention), pose(table, convention)
    assert one_factor_repairs(factors, target) == []
    assert list(two_factor_repairs(factors, target)) == []
