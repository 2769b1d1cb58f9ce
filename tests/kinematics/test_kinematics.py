"""Test rotations, transforms, rows of a table, and chains."""

import doctest
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest
import sympy as sp
from dh_grader import kinematics as dh_row
from dh_grader import kinematics as rotations
from dh_grader.kinematics import (
    PROPER,
    SEQUENCES,
    Convention,
    Matrices,
    Row,
    about,
    composed,
    compound,
    dh1_residual,
    dh2_residual,
    from_angles,
    identity,
    inverse,
    is_rigid,
    is_singular,
    last_angle,
    link_transforms,
    links,
    modified_link,
    modified_rows,
    other_triple,
    pose,
    rot_x,
    rot_y,
    rot_z,
    row,
    standard_link,
    standard_rows,
    to_angles,
)
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tests.kinematics.constructions import trans
from tests.together import together

# --- Compare angles and rotations with SciPy

RNG = np.random.default_rng(4)
ANGLES = RNG.uniform(-np.pi, np.pi, (40, 3))


def scipy_rotation(sequence: str, angles: object, fixed: bool) -> Matrices:
    # Return SciPy's rotation; SciPy uses upper case for moving and lower case for fixed axes.
    name = sequence.lower() if fixed else sequence
    return np.asarray(Rotation.from_euler(name, np.asarray(angles)).as_matrix())


def scipy_angles(sequence: str, rotation: Matrices, fixed: bool) -> Matrices:
    name: Any = sequence.lower() if fixed else sequence
    return np.asarray(Rotation.from_matrix(rotation).as_euler(name))


def test_the_examples_in_docstrings_are_right() -> None:
    assert doctest.testmod(rotations).attempted >= 5
    assert doctest.testmod(rotations).failed == 0


def test_there_are_twelve_sequences() -> None:
    assert len(set(SEQUENCES)) == 12
    assert all(a != b != c for a, b, c in SEQUENCES)


@together("fixed", [False, True])
@together("sequence", SEQUENCES)
def test_the_rotation_of_a_triple_is_scipys(sequence: str, fixed: bool) -> None:
    np.testing.assert_allclose(
        from_angles(sequence, ANGLES, fixed=fixed),
        scipy_rotation(sequence, ANGLES, fixed),
        atol=1e-14,
    )


@together("fixed", [False, True])
@together("sequence", SEQUENCES)
def test_both_triples_describe_the_rotation(sequence: str, fixed: bool) -> None:
    rotation = scipy_rotation(sequence, ANGLES, fixed)
    one = to_angles(sequence, rotation, fixed=fixed)
    other = other_triple(sequence, one)
    for triple in (one, other):
        np.testing.assert_allclose(scipy_rotation(sequence, triple, fixed), rotation, atol=1e-12)
    assert (np.abs(np.exp(1j * one) - np.exp(1j * other)).max(axis=-1) > 1e-3).all()
    np.testing.assert_allclose(one, scipy_angles(sequence, rotation, fixed), atol=1e-9)


@together("fixed", [False, True])
@together("sequence", SEQUENCES)
def test_one_outer_angle_is_zero_if_the_outer_axes_coincide(sequence: str, fixed: bool) -> None:
    singular = [0.0, np.pi] if sequence in PROPER else [np.pi / 2, -np.pi / 2]
    for middle in singular:
        rotation = scipy_rotation(sequence, [[0.7, middle, -1.1]], fixed)
        found = to_angles(sequence, rotation, fixed=fixed)
        np.testing.assert_allclose(scipy_rotation(sequence, found, fixed), rotation, atol=1e-12)
        assert found[0, 0 if fixed else 2] == 0.0
        assert is_singular(sequence, rotation, fixed=fixed).all()
    assert not is_singular(sequence, scipy_rotation(sequence, ANGLES, fixed), fixed=fixed).any()


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_the_first_angle_is_free_if_the_outer_axes_coincide(sequence: str) -> None:
    middle = 0.0 if sequence in PROPER else np.pi / 2
    rotation = scipy_rotation(sequence, [[0.7, middle, -1.1]], fixed=False)
    chosen = np.array([[2.5, middle]])
    triple = [[2.5, middle, last_angle(sequence, chosen, rotation)[0]]]
    np.testing.assert_allclose(scipy_rotation(sequence, triple, False), rotation, atol=1e-12)


def test_turns_about_fixed_axes_multiply_from_the_left() -> None:
    # Source: Direct Kinematics (Part 2), §1.5, compared with SciPy's two kinds of sequence.
    turns = [about(axis, ANGLES[:, i]) for i, axis in enumerate("XZY")]
    for fixed in (True, False):
        np.testing.assert_allclose(
            composed([(turn, fixed) for turn in turns]),
            scipy_rotation("XZY", ANGLES, fixed),
            atol=1e-14,
        )


def test_steps_about_fixed_and_moving_axes_can_be_mixed() -> None:
    # A turn about fixed z by φ, moving x by θ and fixed y by ψ is R_y(ψ) R_z(φ) R_x(θ).
    found = composed([(about("Z", 0.3), True), (about("X", 0.5), False), (about("Y", 0.7), True)])
    expected = Rotation.from_euler("YZX", [0.7, 0.3, 0.5]).as_matrix()
    np.testing.assert_allclose(found, expected, atol=1e-15)


@given(
    st.sampled_from(SEQUENCES),
    st.tuples(*[st.floats(-10, 10)] * 3),
    st.booleans(),
)
def test_a_triple_leads_to_its_rotation_and_back(
    sequence: str, angles: tuple[float, float, float], fixed: bool
) -> None:
    rotation = from_angles(sequence, np.array(angles), fixed=fixed)
    back = from_angles(sequence, to_angles(sequence, rotation, fixed=fixed), fixed=fixed)
    np.testing.assert_allclose(back, rotation, atol=3e-7)


# --- Compare rotations with SciPy; test translations and inverses

Array = NDArray[np.float64]
ANGLE = st.floats(-20, 20)
LENGTH = st.floats(-100, 100)
ROTATIONS = {"x": rot_x, "y": rot_y, "z": rot_z}
AXES = {"x": [1.0, 0.0, 0.0], "y": [0.0, 1.0, 0.0], "z": [0.0, 0.0, 1.0]}


def turns(axis: str, angles: list[float]) -> Array:
    matrices: Array = Rotation.from_rotvec(np.outer(angles, AXES[axis])).as_matrix()
    return matrices


def assert_close(actual: Array, expected: Array) -> None:
    np.testing.assert_allclose(actual, expected, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("axis", ROTATIONS)
@given(angles=st.lists(ANGLE, min_size=1, max_size=6))
def test_a_rotation_is_scipys(axis: str, angles: list[float]) -> None:
    matrices = ROTATIONS[axis](angles)
    assert matrices.shape == (len(angles), 4, 4)
    assert_close(matrices[:, :3, :3], turns(axis, angles))
    assert (matrices[:, 3] == [0, 0, 0, 1]).all()
    assert (matrices[:, :3, 3] == 0).all()


@pytest.mark.parametrize(
    ("rotation", "turned", "onto"),
    [(rot_x, [0, 1, 0], [0, 0, 1]), (rot_y, [0, 0, 1], [1, 0, 0]), (rot_z, [1, 0, 0], [0, 1, 0])],
)
def test_a_quarter_turn_is_right_handed(
    rotation: Callable[[float], Array], turned: list[int], onto: list[int]
) -> None:
    assert_close(rotation(np.pi / 2)[:3, :3] @ turned, np.array(onto, dtype=float))


@given(LENGTH, LENGTH, LENGTH)
def test_a_translation_moves_points_and_not_directions(x: float, y: float, z: float) -> None:
    moved = trans(x, y, z)
    assert (moved @ [1, 2, 3, 1] == [x + 1, y + 2, z + 3, 1]).all()
    assert (moved @ [1, 2, 3, 0] == [1, 2, 3, 0]).all()


@given(st.tuples(ANGLE, ANGLE, ANGLE), st.tuples(LENGTH, LENGTH, LENGTH))
def test_the_inverse_undoes_the_transform(
    angles: tuple[float, float, float], lengths: tuple[float, float, float]
) -> None:
    transform = trans(*lengths)
    transform[:3, :3] = Rotation.from_euler("XYZ", angles).as_matrix()
    inverted = inverse(transform)
    np.testing.assert_allclose(inverted @ transform, np.eye(4), atol=1e-10)
    np.testing.assert_allclose(transform @ inverted, np.eye(4), atol=1e-10)
    np.testing.assert_allclose(inverted, np.linalg.inv(transform), atol=1e-10)


def test_batches_broadcast() -> None:
    batch = trans(np.zeros((2, 1)), np.arange(3.0), 5.0)
    assert batch.shape == (2, 3, 4, 4)
    assert (batch[1, 2, :3, 3] == [0, 2, 5]).all()
    assert rot_z(np.zeros((2, 3))).shape == (2, 3, 4, 4)
    assert (inverse(batch)[..., :3, 3] == -batch[..., :3, 3]).all()
    assert (identity((2, 3)) == np.eye(4)).all()
    assert identity().shape == (4, 4)
    assert rot_x(0.0).dtype == rot_x(0).dtype == np.float64


def test_the_inverse_does_not_change_its_argument() -> None:
    transform = trans(1.0, 2.0, 3.0)
    before = transform.copy()
    inverse(transform)
    assert (transform == before).all()


def test_only_rotations_with_translations_are_rigid() -> None:
    right = Rotation.from_rotvec([0.3, -0.4, 0.5]).as_matrix()
    transforms = np.tile(np.eye(4), (5, 1, 1))
    transforms[:, :3, :3] = right
    transforms[:, :3, 3] = [7.0, -8.0, 9.0]
    transforms[1, :3, 0] *= -1  # left-handed
    transforms[2, :3, 1] *= 1.1  # stretched
    transforms[3, 3, 0] = 0.1  # another last row
    transforms[4, 3, 3] = 2.0
    assert is_rigid(transforms, 1e-3).tolist() == [True, False, False, False, False]


# --- Compare link transforms with products of four elementary matrices

DH_LENGTH = st.floats(-10, 10)


def turn(axis: str, angle: float) -> Array:
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_euler(axis, angle).as_matrix()
    return matrix


def shift(axis: int, length: float) -> Array:
    matrix = np.eye(4)
    matrix[axis, 3] = length
    return matrix


@given(DH_LENGTH, ANGLE, DH_LENGTH, ANGLE)
def test_a_standard_link_is_the_product_of_elementary_transforms(
    a: float, alpha: float, d: float, theta: float
) -> None:
    # Source: MEAM 520, More Denavit-Hartenberg (DH).
    expected = turn("z", theta) @ shift(2, d) @ shift(0, a) @ turn("x", alpha)
    np.testing.assert_allclose(standard_link(a, alpha, d, theta), expected, atol=1e-12)


@given(DH_LENGTH, ANGLE, DH_LENGTH, ANGLE)
def test_a_modified_link_is_the_product_of_elementary_transforms(
    a: float, alpha: float, d: float, theta: float
) -> None:
    # Source: Robotic Fundamentals, Forward Kinematics.
    expected = turn("x", alpha) @ shift(0, a) @ turn("z", theta) @ shift(2, d)
    np.testing.assert_allclose(modified_link(a, alpha, d, theta), expected, atol=1e-12)


@given(ANGLE, ANGLE)
def test_the_two_dh_conditions_hold(alpha: float, theta: float) -> None:
    # x_1 is perpendicular to z_0 and meets it: Direct Kinematics (Part 2), §2.3.
    link = standard_link(1.3, alpha, 0.7, theta)
    x1, origin = link[:3, 0], link[:3, 3]
    assert abs(x1[2]) < 1e-12
    meets = origin - 1.3 * x1
    np.testing.assert_allclose(meets[:2], 0, atol=1e-12)


def test_links_of_the_stanford_arm_are_as_printed() -> None:
    # Source: A_1 and A_2 of MEAM 520, More Denavit-Hartenberg (DH), at one joint value.
    c, s = np.cos(0.4), np.sin(0.4)
    first = [[c, 0, -s, 0], [s, 0, c, 0], [0, -1, 0, 0], [0, 0, 0, 1]]
    second = [[c, 0, s, 0], [s, 0, -c, 0], [0, 1, 0, 0.3], [0, 0, 0, 1]]
    np.testing.assert_allclose(standard_link(0, -np.pi / 2, 0, 0.4), first, atol=1e-15)
    np.testing.assert_allclose(standard_link(0, np.pi / 2, 0.3, 0.4), second, atol=1e-15)


def test_the_convention_chooses_the_link() -> None:
    cells = (0.3, 0.5, 0.7, 1.1)
    standard = link_transforms(Convention.STANDARD, *cells)
    modified = link_transforms(Convention.MODIFIED, *cells)
    assert (standard == standard_link(*cells)).all()
    assert (modified == modified_link(*cells)).all()
    assert not np.allclose(standard, modified)


def test_batches_of_rows_broadcast() -> None:
    links = standard_link(np.zeros((5, 1)), 0.0, np.arange(3.0), 0.2)
    assert links.shape == (5, 3, 4, 4)
    assert (links[4, :, 2, 3] == [0, 1, 2]).all()
    assert modified_link(0, 0, 0, np.zeros((2, 7))).shape == (2, 7, 4, 4)


# --- Test the two DH conditions, and the row if both hold

DH_ROW_RNG = np.random.default_rng(6)
BOTH = list(Convention)


def test_the_example_in_the_docstring_is_right() -> None:
    results = doctest.testmod(dh_row)
    assert (results.attempted >= 1, results.failed) == (True, 0)


@pytest.mark.parametrize("convention", BOTH)
def test_a_link_transform_has_its_own_row(convention: Convention) -> None:
    cells = DH_ROW_RNG.uniform(-np.pi, np.pi, (4, 30))
    link = link_transforms(convention, *cells)
    np.testing.assert_allclose(dh1_residual(link, convention), 0.0, atol=1e-14)
    np.testing.assert_allclose(dh2_residual(link, convention), 0.0, atol=1e-14)
    np.testing.assert_allclose(row(link, convention), cells, atol=1e-12)


def test_dh1_fails_if_x1_is_not_perpendicular_to_z0() -> None:
    # A turn by 0.3 about y gives x_1 the component −sin 0.3 along z_0; x_1 still meets z_0.
    transform = trans(0.5, 0.0, 0.2) @ rot_y(0.3)
    assert dh1_residual(transform, Convention.STANDARD) == pytest.approx(-np.sin(0.3))
    assert dh2_residual(transform, Convention.STANDARD) == pytest.approx(0.0)


def test_dh2_fails_if_x1_does_not_meet_z0() -> None:
    # With a shift by 0.4 along y_0 and no turn about z, x_1 passes z_0 at the distance 0.4.
    transform = trans(0.5, 0.4, 0.2) @ rot_x(0.3)
    assert dh1_residual(transform, Convention.STANDARD) == pytest.approx(0.0)
    assert dh2_residual(transform, Convention.STANDARD) == pytest.approx(0.4)


def test_both_residuals_are_right_if_x1_is_parallel_to_z0() -> None:
    transform = trans(0.3, 0.4, 0.2) @ rot_y(-np.pi / 2)
    assert dh1_residual(transform, Convention.STANDARD) == pytest.approx(1.0)
    assert dh2_residual(transform, Convention.STANDARD) == pytest.approx(0.5)


def test_a_transform_may_be_a_link_of_one_convention_only() -> None:
    transform = rot_z(0.7) @ trans(0.5, 0.0, 0.1) @ rot_x(0.4)
    assert dh2_residual(transform, Convention.STANDARD) == pytest.approx(0.0)
    assert abs(dh1_residual(transform, Convention.MODIFIED)) > 0.1


# --- Compare the poses of whole robots with closed formulas

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
    expected = np.asarray(pose_function(name)(*values), dtype=np.float64)
    np.testing.assert_allclose(pose(table, robot.convention), expected, atol=1e-12)


@cache
def pose_function(name: str) -> Callable[..., Any]:
    function: Callable[..., Any] = function_of_letters(CLOSED_FORMS[name].pose)
    return function


@given(values=VALUES)
def test_the_tip_of_the_cartesian_arm_is_at_its_displacements(values: list[float]) -> None:
    # Source: Spong, Hutchinson, Vidyasagar, problem 3-7.
    d1, d2, d3 = values[:3]
    table = numeric([(0, -QUARTER, d1, 0), (0, -QUARTER, d2, -QUARTER), (0, 0, d3, 0)])
    np.testing.assert_allclose(pose(table, STANDARD)[:3, 3], [d3, d2, d1], atol=1e-12)
