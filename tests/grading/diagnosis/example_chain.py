"""An arm of four links in numbers, and wrong answers about it."""

from functools import reduce

import numpy as np
from dh_grader.grading.diagnosis.motions import Chain, MatrixCase
from dh_grader.kinematics import Convention, Numbers

from tests.frame_choice.kinematics import screw_x, screw_z

# The number of samples at which whole matrices are compared.
COUNT = 8
ROWS, COLUMNS = 4, 4
TABLE = np.random.default_rng(7).uniform(0.3, 1.2, (ROWS, COLUMNS, COUNT))
CHAIN = Chain(TABLE, Convention.STANDARD, ("0", "1", "2", "3", "4"))
# The screw of each row along and about z, and along and about x: ``(COUNT, 4, 4)`` each.
Z = [screw_z(d, theta) for _, _, d, theta in TABLE]
X = [screw_x(a, alpha) for a, alpha, _, _ in TABLE]
A1, A2, A3, A4 = (z @ x for z, x in zip(Z, X, strict=True))


def product(*transforms: Numbers) -> Numbers:
    """Return the product of transforms ``(COUNT, 4, 4)``."""
    return reduce(np.matmul, transforms)


POSE = product(A1, A2, A3, A4)


def wrong_pose(matrix: Numbers, chain: Chain | None = CHAIN) -> MatrixCase:
    return wrong_matrix(matrix, POSE, chain)


def wrong_matrix(matrix: Numbers, right: Numbers, chain: Chain | None = None) -> MatrixCase:
    actual, expected = (np.moveaxis(each, 0, -1) for each in (matrix, right))
    return MatrixCase(
        actual=actual,
        expected=expected,
        scale=np.ones(expected.shape[:2]),
        wrong=np.abs(actual - expected).max(axis=-1) > 1e-6,
        rigid=True,
        chains=(chain,) if chain else (),
    )
