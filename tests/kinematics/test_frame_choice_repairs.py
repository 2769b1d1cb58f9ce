"""Test tables that become valid by one change."""

import numpy as np
import pytest
from dh_grader.kinematics import (
    CellIndex,
    Convention,
    Factors,
    Numbers,
    Table,
    factors_of,
    inverse,
    pose,
)
from dh_grader.kinematics.frame_choice_repairs import (
    one_factor_repairs,
    repaired_values,
    repairs_by_axes,
    reversed_factors,
    two_factor_repairs,
)

from tests.together import together

# --- Find the correct value of a wrong cell from the joint axes

SAMPLES = 3
SEEDS = together("seed", range(30))
CONVENTIONS = pytest.mark.parametrize("convention", list(Convention))
# The second of five joints slides.
SLIDING = np.array([False, True, False, False, False])


def arm(rng: np.random.Generator) -> Table:
    return rng.uniform(0.3, 1.2, (5, 4, SAMPLES))


def joints_of(factors: Factors) -> np.ndarray:
    return np.array([factors.position((row, 2))[0] for row in range(5)])


def found(
    factors: Factors, joints: np.ndarray, axes: np.ndarray, ends: np.ndarray, sliding: np.ndarray
) -> dict[tuple[int, int], list[Numbers]]:
    values: dict[tuple[int, int], list[Numbers]] = {}
    starts = ends @ factors.before[:-1]
    for k, kind, value in repairs_by_axes(factors, starts, joints, axes, sliding):
        values.setdefault((k, kind), []).append(value)
    return values


def is_among(value: Numbers, values: list[Numbers], angle: bool) -> bool:
    errors = np.array(values) - value
    if angle:
        errors -= 2 * np.pi * np.round(errors / (2 * np.pi))
    return bool(np.abs(errors).max(axis=-1).min() < 1e-9)


@CONVENTIONS
@SEEDS
def test_the_right_value_is_found_from_a_given_base(convention: Convention, seed: int) -> None:
    rng = np.random.default_rng(seed)
    table = arm(rng)
    right = factors_of(table, convention)
    joints = joints_of(right)
    axes = right.before[joints]
    for cell in np.ndindex(5, 4):
        wrong = table.copy()
        wrong[cell] += rng.uniform(0.2, 1.0, SAMPLES)
        factors = factors_of(wrong, convention)
        values = found(factors, joints, axes, np.eye(4), SLIDING)
        k, kind = factors.position(cell)
        if k < joints[-1]:
            assert is_among(table[cell], values[k, kind], angle=kind == 1), cell
        else:  # after the last axis
            assert (k, kind) not in values


@CONVENTIONS
@SEEDS
def test_the_right_value_is_found_from_a_given_tool(convention: Convention, seed: int) -> None:
    rng = np.random.default_rng(seed)
    table = arm(rng)
    right = factors_of(table, convention)
    axes = right.before[joints_of(right)]
    tool = pose(table, convention)
    for cell in np.ndindex(5, 4):
        wrong = table.copy()
        wrong[cell] += rng.uniform(0.2, 1.0, SAMPLES)
        factors = factors_of(wrong, convention)
        k, kind = factors.position(cell)
        last = len(factors.axes) - 1
        joints = last - joints_of(factors)[::-1]
        values = found(reversed_factors(factors), joints, axes[::-1], tool, SLIDING[::-1])
        if k > joints_of(factors)[0]:
            assert is_among(-table[cell], values[last - k, kind], angle=kind == 1), cell


def test_reversed_factors_give_the_inverse_product() -> None:
    factors = factors_of(arm(np.random.default_rng(1)), Convention.STANDARD)
    np.testing.assert_allclose(
        reversed_factors(factors).before[-1], inverse(factors.before[-1]), atol=1e-12
    )


# --- Find the correct values of one or two wrong cells

CELL_REPAIRS_SAMPLES = 4
CELL_REPAIRS_CONVENTIONS = pytest.mark.parametrize("convention", list(Convention))
CELL_REPAIRS_SEEDS = together("seed", range(40))


def repaired_arm(rng: np.random.Generator) -> Table:
    table = rng.uniform(0.3, 1.2, (5, 4, CELL_REPAIRS_SAMPLES))
    table[:, 1] = rng.choice([0.0, np.pi / 2, -np.pi / 2, np.pi], 5)[:, None]
    table[:, 0][rng.random(5) < 0.4] = 0.0
    table[:, 2][rng.random(5) < 0.3] = 0.0
    return table


def with_wrong(table: Table, cells: list[CellIndex], rng: np.random.Generator) -> Table:
    wrong = table.copy()
    for cell in cells:
        wrong[cell] += rng.uniform(0.2, 1.0, CELL_REPAIRS_SAMPLES)
    return wrong


def drawn(rng: np.random.Generator) -> CellIndex:
    return int(rng.integers(5)), int(rng.integers(4))


def turned(angle: np.ndarray) -> np.ndarray:
    return angle - 2 * np.pi * np.round(angle / (2 * np.pi))


@CELL_REPAIRS_CONVENTIONS
@CELL_REPAIRS_SEEDS
def test_one_wrong_cell_is_among_the_repairs(convention: Convention, seed: int) -> None:
    rng = np.random.default_rng(seed)
    table, cell = repaired_arm(rng), drawn(rng)
    wrong = with_wrong(table, [cell], rng)
    repairs = one_factor_repairs(factors_of(wrong, convention), pose(table, convention))
    [repair] = [repair for repair in repairs if repair.cells == (cell,)]
    np.testing.assert_allclose(turned(repair.values[0] - table[cell]), 0, atol=1e-9)
    for other in repairs:  # every other repair makes the pose right, too
        assert_repairs(wrong, other.cells, other.values, table, convention)


@CELL_REPAIRS_CONVENTIONS
@CELL_REPAIRS_SEEDS
def test_two_wrong_cells_are_among_the_repairs(convention: Convention, seed: int) -> None:
    rng = np.random.default_rng(1000 + seed)
    table, cells = repaired_arm(rng), sorted({drawn(rng), drawn(rng)})
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


@CELL_REPAIRS_CONVENTIONS
def test_a_repair_can_be_computed_at_other_samples(convention: Convention) -> None:
    rng = np.random.default_rng(7)
    table = repaired_arm(rng)
    for cells in ([(1, 2)], [(3, 0), (3, 1)], [(4, 1), (1, 2)], [(0, 3), (3, 3)]):
        wrong = with_wrong(table, cells, rng)
        factors, target = factors_of(wrong, convention), pose(table, convention)
        values = repaired_values(factors, target, cells)
        assert values is not None
        assert_repairs(wrong, tuple(cells), values, table, convention)
        elsewhere = [(2, 1)]
        assert repaired_values(factors, target, elsewhere) is None


@CELL_REPAIRS_CONVENTIONS
def test_three_wrong_cells_have_no_repair(convention: Convention) -> None:
    rng = np.random.default_rng(8)
    table = repaired_arm(rng)
    wrong = with_wrong(table, [(0, 1), (2, 2), (4, 0)], rng)
    factors, target = factors_of(wrong, convention), pose(table, convention)
    assert one_factor_repairs(factors, target) == []
    assert list(two_factor_repairs(factors, target)) == []
