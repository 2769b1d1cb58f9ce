"""Pairs of cases of a misconception in numbers: one that it explains, one that it leaves alone."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import pytest

from service.grading.feedback import Finding
from service.grading.misconception import Explained, Record, all_records, explained_by_one


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


def record_of(function: Callable[[Any], Any]) -> Record:
    """The record of a function."""
    [record] = (record for record in all_records() if record.function is function)
    return record


def explained(case: Any, function: Callable[[Any], Any], source: Any = None) -> Explained | None:
    """The hypothesis of one misconception or check that explains a case, or None.

    It is asked whether its record says that it concerns such a case or not.
    """
    record = replace(record_of(function), when=None)
    return explained_by_one(record, case, case if source is None else source)


def _finding(pair: Pair, case: Any) -> Finding | None:
    found = explained(case, pair.function, pair.source(case))
    return found.findings[-1] if found else None


def assert_explains_one_case_alone(pair: Pair) -> Finding:
    """That the misconception explains the first case and not the second; its finding."""
    finding = _finding(pair, pair.explained)
    assert finding is not None
    assert finding.code == (pair.code or pair.function.__name__)
    assert finding.hint
    assert _finding(pair, pair.left_alone) is None
    return finding
