"""Pairs of wrong answers, of which a misconception explains only the first answer."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import pytest
from dh_grader.grading.misconception import Explained, Record, all_records, explained_by_one
from dh_grader.grading.report import Finding


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
