"""A memory cache of reports with a limit in bytes; the least recently used ones are dropped."""

import sys
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias

from service.attempts.outcome import Outcome
from service.catalogue import FeedbackLevel

# A report on a table takes 6 kB with its answers; an attacker's may take a hundred times as much.
# 64 MB hold 10,000 different tables and are half the memory of the program.
MOST_BYTES: Final = 64 * 2**20

# The verdict and the points of each part.
PartResults: TypeAlias = Mapping[str, tuple[str, float]]


@dataclass(frozen=True, slots=True)
class WrittenReport:
    """The JSON of a report, and values of the report that are needed without parsing it."""

    text: str
    points: float
    max_points: float
    parts: PartResults
    outcome: Outcome
    version: str

    @property
    def size(self) -> int:
        """The approximate size in bytes."""
        return sys.getsizeof(self.text) + sys.getsizeof(self.outcome.content) + 1000


class MemoizedReports:
    """The most recently used reports by submission and feedback level."""

    def __init__(self, most_bytes: int = MOST_BYTES) -> None:
        self._most_bytes = most_bytes
        self._bytes = 0
        self._reports: OrderedDict[tuple[str, FeedbackLevel], WrittenReport] = OrderedDict()

    def get(
        self, submission: str, level: FeedbackLevel, grade: Callable[[], WrittenReport]
    ) -> WrittenReport:
        """Return a report from the cache, or call ``grade`` and store its result in the cache."""
        key = submission, level
        if (found := self._reports.get(key)) is not None:
            self._reports.move_to_end(key)
            return found
        self._reports[key] = report = grade()
        self._bytes += _size(submission, report)
        while self._bytes > self._most_bytes:
            (oldest, _), dropped = self._reports.popitem(last=False)
            self._bytes -= _size(oldest, dropped)
        return report


def _size(submission: str, report: WrittenReport) -> int:
    return sys.getsizeof(submission) + report.size
