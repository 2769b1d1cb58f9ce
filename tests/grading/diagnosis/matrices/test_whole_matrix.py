"""Test the misconceptions about a whole matrix."""

from dataclasses import replace

import numpy as np
import pytest
from dh_grader.grading.diagnosis import matrices as line_signs
from dh_grader.grading.diagnosis import matrices as whole_matrix
from dh_grader.grading.diagnosis.matrices import WrongAxes, explain
from dh_grader.grading.diagnosis.motions import Chain, MatrixCase
from dh_grader.kinematics import Convention, Numbers, inverse

from tests.grading.diagnosis.example_chain import A1, A2, POSE, product, wrong_matrix, wrong_pose
from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair

R, P = POSE[:, :3, :3], POSE[:, :3, 3]


def with_rotation(rotation: Numbers) -> MatrixCase:
    """Return the correct pose with a wrong rotation ``(COUNT, 3, 3)``."""
    matrix = POSE.copy()
    matrix[:, :3, :3] = rotation
    return wrong_pose(matrix)


def with_position(position: Numbers) -> MatrixCase:
    """Return the correct pose with a wrong position ``(COUNT, 3)``."""
    matrix = POSE.copy()
    matrix[:, :3, 3] = position
    return wrong_pose(matrix)


PAIRS = [
    Pair(
        whole_matrix.length_unit,
        with_position(P / 100),
        with_position(P / 90),
        "other_length_unit",
    ),
    Pair(
        whole_matrix.transposed_matrix,
        wrong_pose(np.swapaxes(POSE, 1, 2)),
        wrong_pose(np.swapaxes(A1, 1, 2)),
    ),
    Pair(whole_matrix.inverse_transform, wrong_pose(inverse(POSE)), wrong_pose(A1)),
    Pair(whole_matrix.other_pose, wrong_pose(product(A1, A2)), wrong_pose(A2), "wrong_frame"),
    Pair(
        whole_matrix.inverse_of_other_pose,
        wrong_pose(inverse(product(A1, A2))),
        wrong_pose(product(A1, A2)),
        "wrong_frame",
    ),
    Pair(
        whole_matrix.transposed_rotation,
        with_rotation(np.swapaxes(R, 1, 2)),
        with_rotation(np.swapaxes(A1[:, :3, :3], 1, 2)),
    ),
    Pair(
        whole_matrix.columns_exchanged,
        with_rotation(R[:, :, [1, 0, 2]]),
        with_rotation(R[:, [1, 0, 2]]),
    ),
    Pair(
        whole_matrix.other_rotation,
        with_rotation(A1[:, :3, :3]),
        with_rotation(A2[:, :3, :3]),
        "wrong_frame",
    ),
    Pair(
        whole_matrix.other_position,
        with_position(A1[:, :3, 3]),
        with_position(0 * P),
        "wrong_frame",
    ),
    Pair(
        line_signs.line_sign,
        with_rotation(R * [1, -1, 1]),
        with_rotation(R * [[1, -1, 1], [1, 1, 1], [1, 1, 1]]),
        "column_sign",
    ),
    Pair(
        whole_matrix.bottom_row,
        wrong_pose(np.array([[1], [1], [1], [2]]) * POSE),
        wrong_pose(np.array([[1], [1], [2], [1]]) * POSE),
    ),
    Pair(whole_matrix.left_handed_rotation, WrongAxes(-R, []), WrongAxes(R, [])),
    Pair(whole_matrix.rotation_not_orthonormal, WrongAxes(2 * R, []), WrongAxes(-R, [])),
]


@each_pair(PAIRS)
def test_a_misconception_or_check_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


@pytest.mark.parametrize(
    "rows",
    [
        [[0.4, 0.3, 0.2, 0.5], [0, 0, 0, 0], [0.1, -0.7, 0.3, 0.9]],
        [[0.4, np.pi, 0.2, 0], [0.1, 0, 0.3, 0]],
        [[0, 0, 0, 0], [0.4, 0.3, 0.2, 0.5]],
        [[0.3, np.pi, 0.2, np.pi]],
    ],
)
def test_an_alternative_that_is_right_explains_nothing(rows: list[list[float]]) -> None:
    # With these tables, a link can be left out, exchanged or transposed without effect.
    lengths = np.linspace(1.0, 2.0, 8)
    table = np.array(rows)[..., None] * np.array([lengths, 0 * lengths + 1] * 2)
    chain = Chain(table, Convention.STANDARD, tuple("0123"[: len(rows) + 1]))
    right = chain.from_base[-1]
    case = replace(
        wrong_matrix(right * (1 + 1e-5), right, chain), wrong=np.ones((4, 4), dtype=np.bool_)
    )
    assert [found.finding.code for found in explain(case)] == ["bottom_row"]
