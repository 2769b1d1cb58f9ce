"""Find the correct value of a wrong cell from the joint axes."""

import numpy as np
import pytest
from dh_grader.kinematics import Convention, Factors, Numbers, Table, factors_of, inverse, pose
from dh_grader.kinematics.frame_choice_repairs import repairs_by_axes, reversed_factors

from tests.together import together

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
