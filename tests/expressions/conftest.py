"""The symbols of an arm: joints 1, 2 and 4 turn, joint 3 slides."""

# The test of `dh_grader/expressions/x.py` is `x/test_y.py`. The tests in this folder are for the
# whole reader: written cases (`corpus`, and `repairs` for the reader's repairs), random texts
# (`fuzz`), properties of trees, formulas printed by SymPy, and memoized readings. One test checks
# that no text is run as a program.

import numpy as np
import pytest
from dh_grader.expressions import Symbol, Vocabulary, joint_variable
from numpy.typing import NDArray

Values = dict[str, NDArray[np.float64]]


@pytest.fixture(scope="session")
def arm() -> Vocabulary:
    return Vocabulary(
        [
            joint_variable(1),
            joint_variable(2),
            joint_variable(3, sliding=True),
            joint_variable(4),
            Symbol("l1", "length"),
            Symbol("l2", "length"),
            Symbol("a2", "length"),
            Symbol("k", "number"),
            Symbol("beta", "angle"),
        ]
    )


@pytest.fixture(scope="session")
def six() -> Vocabulary:
    # The vocabulary of six revolute joints, so that sin45 may mean joints 4 and 5.
    return Vocabulary([joint_variable(index) for index in range(1, 7)])


@pytest.fixture
def values() -> Values:
    # One sample: q1 = 0.3, q2 = 0.5, d3 = 0.7, q4 = 0.9, l1 = 1.1, l2 = 1.2, a2 = 1.3.
    numbers = {
        "theta1": 0.3,
        "theta2": 0.5,
        "d3": 0.7,
        "theta4": 0.9,
        "l1": 1.1,
        "l2": 1.2,
        "a2": 1.3,
        "k": 2.0,
        "beta": 0.25,
    }
    return {name: np.array([number]) for name, number in numbers.items()}
