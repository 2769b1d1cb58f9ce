"""Pairs of answers, and a chain, for tests of misconceptions."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import reduce
from typing import Any, NamedTuple

import numpy as np
import pytest
from dh_grader.grading.diagnosis.motions import Chain, MatrixCase
from dh_grader.grading.misconception import Explained, Record, all_records, explained_by_one
from dh_grader.grading.report import Finding
from dh_grader.kinematics import Convention, Numbers

from tests.frame_choice.kinematics import screw_x, screw_z

# --- Pairs of wrong answers, of which a misconception explains only the first answer


class Pair(NamedTuple):
    """A misconception, an answer that it explains, and one that it does not explain."""

    # `code` is the expected code, by default the name of `function`. `source` computes the argument
    # of `function` from the answer; by default, the argument is the answer itself.
    function: Callable[[Any], Any]
    explained: Any
    unexplained: Any
    code: str = ""
    source: Callable[[Any], Any] = lambda case: case


def each_pair(pairs: Sequence[Pair]) -> pytest.MarkDecorator:
    """Run a test once for each pair."""
    return pytest.mark.parametrize("pair", pairs, ids=lambda pair: pair.function.__name__)


def record_of(function: Callable[[Any], Any]) -> Record:
    [record] = (record for record in all_records() if record.function is function)
    return record


def explained(case: Any, function: Callable[[Any], Any], source: Any = None) -> Explained | None:
    """Return how a misconception explains a wrong answer, or None."""
    # The misconception's condition for being tried, `when`, is ignored.
    record = replace(record_of(function), when=None)
    return explained_by_one(record, case, case if source is None else source)


def _finding(pair: Pair, case: Any) -> Finding | None:
    found = explained(case, pair.function, pair.source(case))
    return found.findings[-1] if found else None


def assert_explains_only_the_first(pair: Pair) -> Finding:
    """Assert that the misconception explains only the first answer."""
    finding = _finding(pair, pair.explained)
    assert finding is not None
    assert finding.code == (pair.code or pair.function.__name__)
    assert finding.hint
    assert _finding(pair, pair.unexplained) is None
    return finding


# --- An arm of four links in numbers, and wrong answers about it

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
