"""The pair of cases that each misconception has: one that it explains, one that it leaves alone."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import pytest

from service.grading.feedback import Finding
from service.grading.misconception import explanation


class Pair(NamedTuple):
    """A misconception or a check with two cases, and the code of the finding on the first.

    ``source`` gives the argument of the function, where that is not the case itself.
    """

    function: Callable[[Any], Any]
    explained: Any
    left_alone: Any
    code: str = ""
    source: Callable[[Any], Any] = lambda case: case


def each_pair(pairs: Sequence[Pair]) -> pytest.MarkDecorator:
    """Runs a test with each pair."""
    return pytest.mark.parametrize("pair", pairs, ids=lambda pair: pair.function.__name__)


def _finding(pair: Pair, case: Any) -> Finding | None:
    source = pair.source(case)
    found = pair.function(source)
    if found is None or isinstance(found, Finding):
        return found
    explains = explanation(case, (pair.function,), source)
    return explains.findings[-1] if explains else None


def assert_explains_one_case_alone(pair: Pair) -> Finding:
    """That the misconception explains the first case and not the second; its finding."""
    finding = _finding(pair, pair.explained)
    assert finding is not None
    assert finding.code == (pair.code or pair.function.__name__)
    assert finding.hint
    assert _finding(pair, pair.left_alone) is None
    return finding
