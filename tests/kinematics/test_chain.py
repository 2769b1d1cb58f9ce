"""Compare the poses of whole robots with closed formulas."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
import sympy as sp
from dh_grader.kinematics import (
    Convention,
    Row,
    compound,
    links,
    modified_rows,
    pose,
    standard_rows,
)
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

Array = NDArray[np.float64]
STANDARD, MODIFIED = Convention.STANDARD, Convention.MODIFIED
QUARTER, HALF = np.pi / 2, np.pi


def numeric(rows: list[Row[float]]) -> Array:
    return np.array(rows, dtype=np.float64)


CELL = st.floats(-7, 7)
ROWS = st.lists(st.tuples(CELL, CELL, CELL, CELL), min_size=1, max_size=8)


@given(ROWS)
def test_regrouping_there_and_back_is_the_identity(rows: list[Row[float]]) -> None:
    there = modified_rows(rows, 0.0)
    assert len(there) == len(rows) + 1
    back = standard_rows(there, 0.0)
    assert back == [*rows, (0.0, 0.0, 0.0, 0.0)]


@given(ROWS)
def test_regrouping_keeps_the_pose(rows: list[Row[float]]) -> None:
    modified = modified_rows(rows, 0.0)
    expected = pose(numeric(rows), STANDARD)
    np.testing.assert_allclose(pose(numeric(modified), MODIFIED), expected, atol=1e-9)


@given(ROWS)
def test_a_modified_table_that_begins_on_the_first_axis_keeps_its_pose(
    rows: list[Row[float]],
) -> None:
    rows = [(0.0, 0.0, *rows[0][2:]), *rows[1:]]
    standard = standard_rows(rows, 0.0)
    assert len(standard) == len(rows)
    expected = pose(numeric(rows), MODIFIED)
    np.testing.assert_allclose(pose(numeric(standard), STANDARD), expected, atol=1e-9)


def test_regrouping_moves_cells_of_any_kind() -> None:
    rows = [("a1", "A1", "d1", "t1"), ("a2", "A2", "d2", "t2")]
    assert modified_rows(rows, "0") == [
        ("0", "0", "d1", "t1"),
        ("a1", "A1", "d2", "t2"),
        ("a2", "A2", "0", "0"),
    ]


@given(ROWS, st.sampled_from(Convention))
def test_a_pose_is_the_product_of_its_links(rows: list[Row[float]], convention: Convention) -> None:
    transforms = links(numeric(rows), convention)
    assert transforms.shape == (len(rows), 4, 4)
    expected = np.eye(4)
    for transform in transforms:
        expected = expected @ transform
    np.testing.assert_allclose(compound(transforms), expected, atol=1e-12)
    np.testing.assert_allclose(pose(numeric(rows), convention), expected, atol=1e-12)


def test_each_sample_of_a_batch_is_computed_independently() -> None:
    rng = np.random.default_rng(7)
    table = rng.uniform(-2, 2, (5, 4, 6))
    for convention in Convention:
        together = pose(table, convention)
        assert together.shape == (6, 4, 4)
        alone = np.stack([pose(table[..., sample], convention) for sample in range(6)])
        np.testing.assert_allclose(together, alone, atol=1e-14)


# Closed forms from the lectures and from Spong, Hutchinson, Vidyasagar.
q1, q2, q3, q4, l1, l2, l3, l4 = LETTERS = sp.symbols("q1 q2 q3 q4 l1 l2 l3 l4")
cos, sin = sp.cos, sp.sin


def plane(angle: Any, x: Any, y: Any) -> Any:
    c, s = cos(angle), sin(angle)
    return sp.Matrix([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]])


def tool_down(angle: Any, x: Any, y: Any, z: Any) -> Any:
    c, s = cos(angle), sin(angle)
    return sp.Matrix([[c, s, 0, x], [s, -c, 0, y], [0, 0, -1, z], [0, 0, 0, 1]])


@dataclass(frozen=True)
class ClosedForm:
    convention: Convention
    table: list[Row[Any]]
    pose: Any


CLOSED_FORMS = {
    "planar RR": ClosedForm(
        STANDARD,
        [(l1, 0, 0, q1), (l2, 0, 0, q2)],
        plane(q1 + q2, l1 * cos(q1) + l2 * cos(q1 + q2), l1 * sin(q1) + l2 * sin(q1 + q2)),
    ),
    "planar RRR": ClosedForm(
        MODIFIED,
        [(0, 0, 0, q1), (l1, 0, 0, q2), (l2, 0, 0, q3), (l3, 0, 0, 0)],
        plane(
            q1 + q2 + q3,
            l1 * cos(q1) + l2 * cos(q1 + q2) + l3 * cos(q1 + q2 + q3),
            l1 * sin(q1) + l2 * sin(q1 + q2) + l3 * sin(q1 + q2 + q3),
        ),
    ),
    "RRRP": ClosedForm(
        STANDARD,
        [(l2, 0, l1, q1), (l3, HALF, 0, q2), (0, 0, l4, q3), (0, 0, q4, 0)],
        tool_down(
            q1 + q2 - q3,
            l2 * cos(q1) + l3 * cos(q1 + q2),
            l2 * sin(q1) + l3 * sin(q1 + q2),
            l1 - l4 - q4,
        ),
    ),
    "RRRP, modified": ClosedForm(
        MODIFIED,
        [(0, 0, l1, q1), (l2, 0, 0, q2), (l3, HALF, l4, q3), (0, 0, q4, 0)],
        tool_down(
            q1 + q2 - q3,
            l2 * cos(q1) + l3 * cos(q1 + q2),
            l2 * sin(q1) + l3 * sin(q1 + q2),
            l1 - l4 - q4,
        ),
    ),
    "SCARA": ClosedForm(
        STANDARD,
        [(l1, 0, 0, q1), (l2, HALF, 0, q2), (0, 0, q3, 0), (0, 0, l4, q4)],
        tool_down(
            q1 + q2 - q4,
            l1 * cos(q1) + l2 * cos(q1 + q2),
            l1 * sin(q1) + l2 * sin(q1 + q2),
            -q3 - l4,
        ),
    ),
    "spatial RRR": ClosedForm(
        STANDARD,
        [(l3, QUARTER, 0, q1), (l1, 0, 0, q2), (l2, 0, 0, q3)],
        sp.Matrix(
            [
                [
                    cos(q1) * cos(q2 + q3),
                    -cos(q1) * sin(q2 + q3),
                    sin(q1),
                    cos(q1) * (l2 * cos(q2 + q3) + l1 * cos(q2) + l3),
                ],
                [
                    sin(q1) * cos(q2 + q3),
                    -sin(q1) * sin(q2 + q3),
                    -cos(q1),
                    sin(q1) * (l2 * cos(q2 + q3) + l1 * cos(q2) + l3),
                ],
                [sin(q2 + q3), cos(q2 + q3), 0, l2 * sin(q2 + q3) + l1 * sin(q2)],
                [0, 0, 0, 1],
            ]
        ),
    ),
    "three-link cylindrical": ClosedForm(
        STANDARD,
        [(0, 0, l1, q1), (0, -QUARTER, q2, 0), (0, 0, q3, 0)],
        sp.Matrix(
            [
                [cos(q1), 0, -sin(q1), -q3 * sin(q1)],
                [sin(q1), 0, cos(q1), q3 * cos(q1)],
                [0, -1, 0, l1 + q2],
                [0, 0, 0, 1],
            ]
        ),
    ),
    "spherical wrist": ClosedForm(
        STANDARD,
        [(0, -QUARTER, 0, q1), (0, QUARTER, 0, q2), (0, 0, l1, q3)],
        (sp.rot_ccw_axis3(q1) * sp.rot_ccw_axis2(q2) * sp.rot_ccw_axis3(q3))
        .row_join(l1 * sp.Matrix([cos(q1) * sin(q2), sin(q1) * sin(q2), cos(q2)]))
        .col_join(sp.Matrix([[0, 0, 0, 1]])),
    ),
}
VALUES = st.lists(st.floats(-4, 4), min_size=len(LETTERS), max_size=len(LETTERS))


def function_of_letters(expression: Any) -> Any:
    return sp.lambdify(LETTERS, expression, "numpy")


@pytest.mark.parametrize("name", CLOSED_FORMS)
@given(values=VALUES)
def test_the_pose_is_the_closed_form(name: str, values: list[float]) -> None:
    robot = CLOSED_FORMS[name]
    at = dict(zip(LETTERS, values, strict=True))
    table = np.array([[float(at.get(cell, cell)) for cell in row] for row in robot.table])
    expected = np.asarray(POSES[name](*values), dtype=np.float64)
    np.testing.assert_allclose(pose(table, robot.convention), expected, atol=1e-12)


POSES = {name: function_of_letters(robot.pose) for name, robot in CLOSED_FORMS.items()}


@given(values=VALUES)
def test_the_tip_of_the_cartesian_arm_is_at_its_displacements(values: list[float]) -> None:
    # Source: Spong, Hutchinson, Vidyasagar, problem 3-7.
    d1, d2, d3 = values[:3]
    table = numeric([(0, -QUARTER, d1, 0), (0, -QUARTER, d2, -QUARTER), (0, 0, d3, 0)])
    np.testing.assert_allclose(pose(table, STANDARD)[:3, 3], [d3, d2, d1], atol=1e-12)
