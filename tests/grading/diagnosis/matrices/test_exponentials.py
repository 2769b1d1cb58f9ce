"""Test the misconceptions about a product of exponentials."""

from functools import reduce

import numpy as np
from dh_grader.grading.diagnosis import products as exponentials
from dh_grader.grading.diagnosis.motions import MatrixCase
from dh_grader.grading.diagnosis.products import Exponentials
from dh_grader.kinematics import Numbers
from scipy.linalg import expm

from tests.grading.diagnosis.example_chain import COUNT, wrong_matrix
from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair

RNG = np.random.default_rng(13)
AMOUNTS = RNG.uniform(0.3, 1.2, (3, COUNT))
HOME = np.broadcast_to(np.eye(4), (COUNT, 4, 4)).copy()
HOME[:, :3, 3] = RNG.uniform(0.3, 0.9, (COUNT, 3))
# Two turning joints through points away from the origin, and a sliding one between them.
AXES = [[0, 0, 1, 0, -0.5, 0], [0, 0, 0, 1, 0, 0], [1, 0, 0, 0, 0, 0.7]]
SPACE = np.repeat(np.array(AXES, dtype=float)[:, None], COUNT, axis=1)


def twist(axis: Numbers) -> Numbers:
    """Return the 4×4 matrix of a screw axis (ω; v)."""
    x, y, z, *velocity = axis
    matrix = np.zeros((4, 4))
    matrix[:3, :3] = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
    matrix[:3, 3] = velocity
    return matrix


def exponential(axes: Numbers, amounts: Numbers) -> Numbers:
    pairs = zip(axes, amounts, strict=True)
    return np.array([expm(twist(axis) * amount) for axis, amount in pairs])


E1, E2, E3 = (exponential(axes, amounts) for axes, amounts in zip(SPACE, AMOUNTS, strict=True))
TURNED_MOMENT = [exponential(SPACE[i] * [1, 1, 1, -1, -1, -1], AMOUNTS[i]) for i in (0, 2)]


def body() -> Numbers:
    # Return the screw axes, seen from the tool frame in the home position.
    back = np.linalg.inv(HOME)
    matrices = np.array([[twist(axis) for axis in axes] for axes in SPACE])
    seen = back @ matrices @ HOME
    omega = seen[..., [2, 0, 1], [1, 2, 0]]
    return np.concatenate([omega, seen[..., :3, 3]], axis=-1)


def product(_case: MatrixCase) -> Exponentials:
    return Exponentials(SPACE, body(), AMOUNTS, HOME)


def wrong(*factors: Numbers) -> MatrixCase:
    return wrong_matrix(reduce(np.matmul, factors), E1 @ E2 @ E3 @ HOME)


PAIRS = [
    Pair(
        exponentials.home_on_the_wrong_side,
        wrong(HOME, E1, E2, E3),
        wrong(E1, HOME, E2, E3),
        "home_on_wrong_side",
        product,
    ),
    Pair(exponentials.missing_home, wrong(E1, E2, E3), wrong(E1, E2), source=product),
    Pair(
        exponentials.reversed_product,
        wrong(E3, E2, E1, HOME),
        wrong(E2, E1, E3, HOME),
        source=product,
    ),
    Pair(
        exponentials.moment_sign,
        wrong(TURNED_MOMENT[0], E2, TURNED_MOMENT[1], HOME),
        wrong(TURNED_MOMENT[0], E2, E3, HOME),
        source=product,
    ),
]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)
