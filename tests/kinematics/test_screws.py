"""Test screws, products of exponentials, and Jacobians."""

import doctest
from collections.abc import Sequence

import numpy as np
import pytest
from dh_grader import kinematics
from dh_grader.kinematics import (
    THETA,
    Convention,
    D,
    adjoint,
    axis_frames,
    coincident,
    dependent,
    exponential,
    factors_of,
    inverse,
    modified_rows,
    moved,
    pose,
    product_in_body,
    product_in_space,
    rank,
    read_screws,
    rot_x,
    rot_z,
    screws,
    skew,
    sliding_axis,
    space_jacobian,
    turning_axis,
)
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import expm, logm

from tests.kinematics.constructions import screw_axis, trans
from tests.together import together

# --- Compare screws with SciPy and with the book Modern Robotics

Numbers = NDArray[np.float64]
RNG = np.random.default_rng(5)


def bracket(screw: Numbers) -> Numbers:
    """Return the 4×4 matrix [S] of a screw."""
    w1, w2, w3, v1, v2, v3 = screw
    return np.array([[0, -w3, w2, v1], [w3, 0, -w1, v2], [-w2, w1, 0, v3], [0, 0, 0, 0.0]])


def unit(vector: Numbers) -> Numbers:
    return np.asarray(vector / np.linalg.norm(vector))


SCREWS = {
    "turning": screw_axis(unit(np.array([1.0, -2, 0.5])), [0.3, 0.2, -0.7]),
    "screwing": screw_axis(unit(np.array([0.0, 1, 1])), [1.0, 0, 2], 0.35),
    "sliding": screw_axis(unit(np.array([1.0, 2, 2])), [5.0, 5, 5], np.inf),
    "not of unit length": np.array([0.0, 0, 3, 1, 2, 3]),
    "nothing": np.zeros(6),
}


def test_the_examples_in_docstrings_are_right() -> None:
    results = doctest.testmod(kinematics)
    assert (results.attempted >= 2, results.failed) == (True, 0)


@together("name", SCREWS)
@together("amount", [0.0, 1e-9, 0.7, -2.9, 11.0])
def test_the_exponential_equals_the_matrix_exponential(name: str, amount: float) -> None:
    screw = SCREWS[name]
    np.testing.assert_allclose(
        exponential(screw, amount), expm(bracket(screw) * amount), atol=1e-12
    )


def test_each_member_of_a_batch_is_computed_independently() -> None:
    batch = np.array(list(SCREWS.values()))
    amounts = RNG.uniform(-3, 3, (7, len(batch)))
    motions = exponential(batch, amounts)
    assert motions.shape == (7, len(batch), 4, 4)
    for i, j in np.ndindex(7, len(batch)):
        np.testing.assert_allclose(motions[i, j], exponential(batch[j], amounts[i, j]), atol=1e-14)


def test_a_screw_with_infinite_pitch_does_not_turn() -> None:
    assert screw_axis([0, 1, 0], [3, 4, 5], np.inf).tolist() == [0, 0, 0, 0, 1, 0]
    mixed = screw_axis([0, 1, 0], [3, 4, 5], np.array([np.inf, 0.0]))
    assert (mixed + 0.0).tolist() == [[0, 0, 0, 0, 1, 0], [0, 1, 0, -5, 0, 3]]


def test_the_pitch_is_the_advance_per_radian() -> None:
    motion = exponential(screw_axis([0, 0, 1], [0, 0, 0], 0.25), 2 * np.pi)
    np.testing.assert_allclose(motion, trans(0, 0, np.pi / 2), atol=1e-14)


def test_the_twist_of_a_turning_car_is_that_of_the_book() -> None:
    # Modern Robotics, example 3.23: V_s = (0,0,2,−2,−4,0), V_b = (0,0,−2,2.8,4,0).
    #
    # r_s = (2,−1,0), r_b = (2,−1.4,0), ω = 2, and T_sb = [[−1,0,0,4],[0,1,0,0.4],[0,0,−1,0],…].
    space = 2 * screw_axis([0, 0, 1], [2, -1, 0])
    body = 2 * screw_axis([0, 0, -1], [2, -1.4, 0])
    transform = np.array([[-1.0, 0, 0, 4], [0, 1, 0, 0.4], [0, 0, -1, 0], [0, 0, 0, 1]])
    np.testing.assert_allclose(space, [0, 0, 2, -2, -4, 0], atol=1e-14)
    np.testing.assert_allclose(body, [0, 0, -2, 2.8, 4, 0], atol=1e-14)
    np.testing.assert_allclose(moved(transform, body), space, atol=1e-14)


def test_the_adjoint_commutes_with_the_exponential() -> None:
    # T e^{[S]θ} T⁻¹ = e^{[Ad_T S]θ} (Modern Robotics, eq. 3.91).
    transform = rot_z(0.4) @ trans(0.3, -0.2, 0.9) @ rot_x(1.1)
    for screw in SCREWS.values():
        np.testing.assert_allclose(
            transform @ exponential(screw, 0.8) @ inverse(transform),
            exponential(moved(transform, screw), 0.8),
            atol=1e-12,
        )
    np.testing.assert_allclose(
        adjoint(transform) @ adjoint(inverse(transform)), np.eye(6), atol=1e-14
    )


def test_skew_is_the_matrix_of_the_cross_product() -> None:
    one, other = RNG.normal(size=(2, 5, 3))
    np.testing.assert_allclose(
        (skew(one) @ other[..., None])[..., 0], np.cross(one, other), atol=1e-15
    )


def test_both_products_give_the_pose_of_the_book() -> None:
    # Source: the example of FKinSpace and FKinBody, Modern Robotics, code library, chapter 4.
    home = np.array([[-1.0, 0, 0, 0], [0, 1, 0, 6], [0, 0, -1, 2], [0, 0, 0, 1]])
    space = np.array([[0.0, 0, 1, 4, 0, 0], [0, 0, 0, 0, 1, 0], [0, 0, -1, -6, 0, -0.1]])
    body = np.array([[0.0, 0, -1, 2, 0, 0], [0, 0, 0, 0, 1, 0], [0, 0, 1, 0, 0, 0.1]])
    amounts = np.array([np.pi / 2, 3, np.pi])
    expected = np.array([[0.0, 1, 0, -5], [1, 0, 0, 4], [0, 0, -1, 1.68584073], [0, 0, 0, 1]])
    np.testing.assert_allclose(product_in_space(space, amounts, home), expected, atol=1e-8)
    np.testing.assert_allclose(product_in_body(body, amounts, home), expected, atol=1e-8)
    np.testing.assert_allclose(moved(home, body), space, atol=1e-12)


def test_both_products_give_the_closed_form_of_the_planar_rpr_arm() -> None:
    # The closed form is x = (L1 + θ2) c1 + L2 c13, with the rotation θ1 + θ3 about z.
    l1, l2 = 0.7, 0.4
    one, two, three = amounts = RNG.uniform(-1, 1, (3, 6))
    space = np.array([[0.0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [0, 0, 1, 0, -l1, 0]])
    body = np.array([[0.0, 0, 1, 0, l1 + l2, 0], [0, 0, 0, 1, 0, 0], [0, 0, 1, 0, l2, 0]])
    home = trans(l1 + l2, 0, 0)
    x = (l1 + two) * np.cos(one) + l2 * np.cos(one + three)
    y = (l1 + two) * np.sin(one) + l2 * np.sin(one + three)
    expected = trans(x, y, 0.0) @ rot_z(one + three)
    in_space = product_in_space(space[:, None], amounts, home)
    in_body = product_in_body(body[:, None], amounts, home)
    np.testing.assert_allclose(in_space, expected, atol=1e-14)
    np.testing.assert_allclose(in_body, expected, atol=1e-14)


@pytest.mark.parametrize("angle", [0.4, 1.1, -0.7])
def test_the_axis_of_a_turn_is_found(angle: float) -> None:
    # The turn is SciPy's exponential of an axis without pitch.
    axis = screw_axis(np.array([0.36, -0.48, 0.8]), np.array([0.5, 0.1, -0.4]))
    displacement = expm(bracket(axis) * angle)
    np.testing.assert_allclose(turning_axis(displacement, angle), axis, atol=1e-12)


def test_other_displacements_give_an_axis_of_another_motion() -> None:
    axis = screw_axis(np.array([0.0, 0.0, 1.0]), np.array([0.5, 0.1, 0.0]))
    with_pitch = expm(bracket(axis + np.array([0, 0, 0, 0, 0, 0.3])) * 0.4)
    twice = expm(bracket(axis) * 0.8)
    for displacement in (with_pitch, twice, trans(0.1, 0.2, 0.3)):
        found = turning_axis(displacement, 0.4)
        error = np.abs(exponential(found, 0.4) - displacement).max()
        length = np.linalg.norm(found[:3])
        assert error > 0.05 or abs(length - 1) > 0.05


def test_the_axis_of_a_slide_is_found() -> None:
    displacement = trans(0.0, 0.6, 0.8)
    np.testing.assert_allclose(sliding_axis(displacement, 1.0), [0, 0, 0, 0, 0.6, 0.8])
    np.testing.assert_allclose(exponential(sliding_axis(displacement, 0.5), 0.5), displacement)


# --- Compare the factors of a table with the link transforms of textbooks

BOTH = pytest.mark.parametrize("convention", list(Convention))
FACTORS_RNG = np.random.default_rng(4)
TABLE = FACTORS_RNG.uniform(-2, 2, (5, 4, 3))


@BOTH
def test_the_product_of_the_factors_is_the_pose(convention: Convention) -> None:
    factors = factors_of(TABLE, convention)
    for k in range(len(factors.axes) + 1):
        whole = factors.before[k] @ factors.after[k]
        np.testing.assert_allclose(whole, pose(TABLE, convention), atol=1e-12)


@BOTH
def test_each_cell_has_its_factor_and_kind(convention: Convention) -> None:
    factors = factors_of(TABLE, convention)
    for row in range(len(TABLE)):
        for column in range(4):
            factor, kind = factors.position((row, column))
            assert factors.cell(factor, kind) == (row, column)
            np.testing.assert_array_equal(factors.sizes[factor, kind], TABLE[row, column])


@BOTH
def test_lengths_are_measured_in_the_unit(convention: Convention) -> None:
    in_unit = factors_of(TABLE, convention, unit=0.25).before[-1]
    expected = pose(TABLE, convention)
    expected[:, :3, 3] *= 4
    np.testing.assert_allclose(in_unit, expected, atol=1e-12)


@pytest.mark.parametrize("written", list(Convention))
def test_axis_frames_are_those_of_the_wanted_convention(written: Convention) -> None:
    factors = factors_of(TABLE, written)
    z_first = written is Convention.STANDARD
    for wanted in Convention:
        found = axis_frames(TABLE, written, wanted)
        at = np.arange(len(TABLE)) * 2 + (not z_first) + (wanted is Convention.MODIFIED)
        np.testing.assert_allclose(found[:-1], factors.before[at], atol=1e-12)
        np.testing.assert_allclose(found[-1], pose(TABLE, written), atol=1e-12)


def test_a_screw_is_read_back_and_other_transforms_deviate() -> None:
    axes, sizes = np.array([0, 2]), FACTORS_RNG.uniform(-1, 1, (2, 2, 3))
    made = screws(axes, sizes[:, 0], sizes[:, 1])
    np.testing.assert_allclose(made[0], trans(sizes[0, 0], 0, 0) @ rot_x(sizes[0, 1]), atol=1e-12)
    np.testing.assert_allclose(made[1], trans(0, 0, sizes[1, 0]) @ rot_z(sizes[1, 1]), atol=1e-12)
    read, missed = read_screws(made, axes)
    np.testing.assert_allclose(read, sizes, atol=1e-12)
    assert missed.max() < 1e-12
    aside = made @ trans(0, 1e-3, 0)
    turned = made @ rot_x(1e-3) @ rot_z(1e-3)
    opposite = made @ rot_x(np.pi) @ rot_z(np.pi)
    for other in (aside, turned, opposite):
        assert read_screws(other, axes)[1].min() > 1e-4


# --- Compare joint screws with the numeric derivative of the pose

Rows = Sequence[tuple[float, float, float, float]]

H = np.pi / 2
SCARA: Rows = [(0.5, 0, 0, 0.3), (0.4, np.pi, 0, -0.8), (0, 0, 0.35, 0), (0, 0, 0.2, 1.1)]
STANFORD: Rows = [
    (0, -H, 0, 0.3),
    (0, H, 0.2, -0.9),
    (0, 0, 0.6, 0),
    (0, -H, 0, 0.5),
    (0, H, 0, 1.2),
    (0, 0, 0.25, -0.4),
]
PLANAR: Rows = [(0.5, 0, 0, 0.3), (0.4, 0, 0, -0.8), (0.3, 0, 0, 0.7)]
BAXTER: Rows = [
    (0.069, -H, 0.27035, 0.2),
    (0, H, 0, 0.5 + H),
    (0.069, -H, 0.36435, -0.7),
    (0, H, 0, 1.1),
    (0.01, -H, 0.37429, 0.4),
    (0, H, 0, -0.6),
    (0, 0, 0.229525, 0.9),
]
# As printed in the lecture: joints 5 and 6 have the same axis (robots.md, "Errata").
PRINTED: Rows = [
    (0, H, 0.3, 0.3),
    (0, H, 0.2, -0.9),
    (0, H, 0.6, H),
    (0, H, 0, 0.5),
    (0, 0, 0, 1.2),
    (0, 0, 0.25, -0.4),
]
ARMS = [
    (SCARA, (2,), 4),
    (STANFORD, (2,), 6),
    (PLANAR, (), 3),
    (BAXTER, (), 6),
    (PRINTED, (2,), 5),
]


def table_of(rows: Rows, convention: Convention) -> NDArray[np.float64]:
    standard = [(float(a), float(alpha), float(d), float(theta)) for a, alpha, d, theta in rows]
    if convention is Convention.MODIFIED:
        standard = modified_rows(standard, 0.0)
    return np.array(standard)[..., None]


def numeric(
    table: NDArray[np.float64], convention: Convention, joints: int, prismatic: Sequence[bool]
) -> NDArray[np.float64]:
    """Return the Jacobian by numeric differentiation."""
    step = 1e-4
    columns = []
    for row in range(joints):
        moved = table.copy()
        moved[row, D if prismatic[row] else THETA] += step
        before, after = pose(table, convention)[0], pose(moved, convention)[0]
        twist = np.real(logm(after @ inverse(before))) / step
        columns.append([twist[2, 1], twist[0, 2], twist[1, 0], *twist[:3, 3]])
    return np.array(columns).T


@pytest.mark.parametrize("convention", Convention)
@pytest.mark.parametrize(("rows", "slides", "expected"), ARMS)
def test_screws_are_the_derivative_of_the_pose(
    rows: Rows, slides: tuple[int, ...], expected: int, convention: Convention
) -> None:
    table = table_of(rows, convention)
    prismatic = [i in slides for i in range(len(rows))]
    found = space_jacobian(table, convention, range(len(rows)), prismatic)
    assert found.shape == (1, 6, len(rows))
    np.testing.assert_allclose(
        found[0], numeric(table, convention, len(rows), prismatic), atol=1e-9
    )
    assert rank(found) == expected


# Round, because the matrix logarithm overflows for turns of 1e-140.
angles = st.floats(-3, 3).map(lambda angle: round(angle, 6))
lengths = st.floats(-1, 1).map(lambda length: round(length, 6))


@given(
    st.lists(st.tuples(lengths, angles, lengths, angles), min_size=1, max_size=5),
    st.data(),
    st.sampled_from(Convention),
)
def test_screws_of_random_tables_are_the_derivative_of_the_pose(
    rows: Rows, data: st.DataObject, convention: Convention
) -> None:
    n = len(rows)
    prismatic = data.draw(st.lists(st.booleans(), min_size=n, max_size=n))
    table = table_of(rows, convention)
    found = space_jacobian(table, convention, range(n), prismatic)
    np.testing.assert_allclose(found[0], numeric(table, convention, n, prismatic), atol=1e-7)


def test_each_sample_is_computed_independently() -> None:
    one, other = (table_of(rows, Convention.STANDARD) for rows in (STANFORD, PRINTED))
    prismatic = [i == 2 for i in range(6)]
    both = space_jacobian(
        np.concatenate([one, other], axis=-1), Convention.STANDARD, range(6), prismatic
    )
    for sample, table in enumerate((one, other)):
        alone = space_jacobian(table, Convention.STANDARD, range(6), prismatic)
        np.testing.assert_allclose(both[sample], alone[0])
    assert rank(both) == 6


def test_joints_with_the_same_axis_are_found() -> None:
    prismatic = [i == 2 for i in range(6)]
    printed = space_jacobian(
        table_of(PRINTED, Convention.STANDARD), Convention.STANDARD, range(6), prismatic
    )
    assert [(i, j) for i, j in np.argwhere(coincident(printed)).tolist() if i < j] == [(4, 5)]
    assert np.flatnonzero(dependent(printed)).tolist() == [4, 5]
    stanford = space_jacobian(
        table_of(STANFORD, Convention.STANDARD), Convention.STANDARD, range(6), prismatic
    )
    # Joint 3 slides along the axis about which joint 4 turns: these are two degrees of freedom.
    assert not coincident(stanford).any()
    assert not dependent(stanford).any()


def test_opposite_axes_on_the_same_line_coincide() -> None:
    rows: Rows = [(0, np.pi, 0.1, 0.3), (0.2, 0, 0, 0.4)]
    found = space_jacobian(
        table_of(rows, Convention.STANDARD), Convention.STANDARD, range(2), [False, False]
    )
    assert coincident(found).tolist() == [[False, True], [True, False]]
    assert rank(found) == 1
