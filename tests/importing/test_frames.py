import numpy as np
import pytest
from dh_grader.importing.urdf import (
    Arm,
    Placed,
    UnclearAxesError,
    greatest_difference,
    home_axes,
    placed,
    read_urdf,
)
from dh_grader.kinematics import Convention, frames

from tests.importing.urdf_texts import Part, random_parts, tip, turned, urdf


def imported(parts: list[Part], decimals: int = 9) -> tuple[Arm, Placed]:
    arm, _ = read_urdf(urdf(parts, decimals), f"l{len(parts)}")
    return arm, placed(*home_axes(arm))


def by_table(arm: Arm, made: Placed, values: np.ndarray) -> np.ndarray:
    table = made.table.copy()
    for i, letter in enumerate(arm.structure):
        table[i, 2 if letter == "P" else 3] += values[i]
    return np.asarray(made.base @ frames(table, Convention.STANDARD)[-1] @ made.tool)


@pytest.mark.parametrize("crooked", [False, True])
@pytest.mark.parametrize("seed", range(40))
def test_the_table_moves_the_tip_as_the_urdf_does(seed: int, crooked: bool) -> None:
    rng = np.random.default_rng([seed, crooked])
    parts = random_parts(rng, crooked=crooked)
    try:
        arm, made = imported(parts)
    except UnclearAxesError:
        pytest.skip("axes nearly parallel")
    values = rng.uniform(-2, 2, len(arm.structure))
    place, turn = tip(parts, list(values))
    reached = by_table(arm, made, values)
    # Lengths are rounded to 0.01 mm.
    assert reached[:3, 3] == pytest.approx(place, abs=2e-4)
    for axis in np.eye(3):
        assert reached[:3, :3] @ axis == pytest.approx(turned(turn, list(axis)), abs=1e-4)


@pytest.mark.parametrize("seed", range(20))
def test_angles_of_right_angled_arms_are_multiples_of_90_degrees_however_rounded(seed: int) -> None:
    rng = np.random.default_rng(seed)
    parts = random_parts(rng, crooked=False)
    for decimals in (4, 6, 15):
        _, made = imported(parts, decimals)
        turns = made.table[:, [1]] / (np.pi / 2)
        assert turns == pytest.approx(np.round(turns), abs=1e-9)
        assert np.abs(made.table[:, [0, 2]]).max() < 10


def test_parallel_axes_that_a_maker_rounded_have_no_far_common_normal() -> None:
    parts = [
        Part("revolute", [0, 0, 0.1], [1.5708, 0, 0]),
        Part("revolute", [0.4, 0, 0], [0, 0, 0]),
        Part("revolute", [0.3, 0, 0.1], [-1.5708, 3.1416, 1.57]),
    ]
    _, made = imported(parts, 4)
    assert made.table[0] == pytest.approx([0.4, 0, 0, 0], abs=1e-9)


def test_axes_that_are_nearly_parallel_are_refused() -> None:
    parts = [Part("revolute", [0, 0, 0], [0, 0, 0]), Part("revolute", [0.4, 0, 0], [0.0012, 0, 0])]
    with pytest.raises(UnclearAxesError, match="joints 1 and 2 are nearly parallel"):
        imported(parts)


def test_the_difference_is_that_of_the_worst_pose() -> None:
    parts = [Part("revolute", [0, 0, 0], [0, 0, 0]), Part("fixed", [0.5, 0, 0], [0, 0, 0])]
    arm, made = imported(parts)
    longer = [parts[0], Part("fixed", [0.502, 0, 0], [0, 0, 0])]
    exact, _ = read_urdf(urdf(longer), "l2")
    length, angle = greatest_difference(made, arm.structure, exact.pose)
    assert length == pytest.approx(0.002)
    assert angle == pytest.approx(0, abs=1e-12)
