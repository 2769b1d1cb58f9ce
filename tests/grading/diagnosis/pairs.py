"""Pairs of cases in numbers: one that a misconception explains, and one that it does not."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import pytest

from service.grading.feedback import Finding
from service.grading.misconception import Explained, Record, all_records, explained_by_one


class Pair(NamedTuple):
    """A misconception or check, a case that it explains, and a case that it does not explain.

    ``code`` is the expected code, by default the name of ``function``. ``source`` maps a case to
    the argument of ``function``, by default the case itself.
    """

    function: Callable[[Any], Any]
    explained: Any
    unexplained: Any
    code: str = ""
    source: Callable[[Any], Any] = lambda case: case


def each_pair(pairs: Sequence[Pair]) -> pytest.MarkDecorator:
    """Run a test once for each pair."""
    return pytest.mark.parametrize("pair", pairs, ids=lambda pair: pair.function.__name__)


def record_of(function: Callable[[Any], Any]) -> Record:
    """Return the record whose function is ``function``."""
    [record] = (record for record in all_records() if record.function is function)
    return record


def explained(case: Any, function: Callable[[Any], Any], source: Any = None) -> Explained | None:
    """Return the hypothesis of one misconception or check that explains a case, or None.

    The condition ``when`` of the record is ignored.
    """
    record = replace(record_of(function), when=None)
    return explained_by_one(record, case, case if source is None else source)


def _finding(pair: Pair, case: Any) -> Finding | None:
    found = explained(case, pair.function, pair.source(case))
    return found.findings[-1] if found else None


def assert_explains_only_the_first(pair: Pair) -> Finding:
    """Assert that the misconception explains only the first case; return its finding."""
    finding = _finding(pair, pair.explained)
    assert finding is not None
    assert finding.code == (pair.code or pair.function.__name__)
    assert finding.hint
    assert _finding(pair, pair.unexplained) is None
    return finding
