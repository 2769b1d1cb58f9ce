"""Compare joint screws with the numeric derivative of the pose."""

from collections.abc import Sequence

import numpy as np
import pytest
from dh_grader.kinematics import (
    THETA,
    Convention,
    D,
    coincident,
    dependent,
    inverse,
    modified_rows,
    pose,
    rank,
    space_jacobian,
)
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import logm

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
