"""Reports that are kept in memory, as many of the newest as fit into some megabytes."""

import sys
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias

from service.attempts.outcome import Outcome
from service.catalogue import FeedbackLevel

# A report on a table takes 6 kB, its answers included, and the long ones of an attacker a hundred
# times as much. So 10,000 different tables are kept in half the memory that the program takes.
MOST_BYTES: Final = 64 * 2**20

# The verdict and the points of each part.
PartResults: TypeAlias = Mapping[str, tuple[str, float]]


@dataclass(frozen=True, slots=True)
class WrittenReport:
    """A report as it is written, and what is asked of it without reading it."""

    text: str
    points: float
    max_points: float
    parts: PartResults
    outcome: Outcome

    @property
    def size(self) -> int:
        """About how many bytes it takes."""
        return sys.getsizeof(self.text) + sys.getsizeof(self.outcome.content) + 1000


class KeptReports:
    """The newest reports by the submission and the level that they are on."""

    def __init__(self, most_bytes: int = MOST_BYTES) -> None:
        self._most_bytes = most_bytes
        self._bytes = 0
        self._kept: OrderedDict[tuple[str, FeedbackLevel], WrittenReport] = OrderedDict()

    def of(
        self, submission: str, level: FeedbackLevel, grade: Callable[[], WrittenReport]
    ) -> WrittenReport:
        """The report on a submission at a level; ``grade`` gives it where it is not kept."""
        key = submission, level
        if (found := self._kept.get(key)) is not None:
            self._kept.move_to_end(key)
            return found
        self._kept[key] = report = grade()
        self._bytes += _size(submission, report)
        while self._bytes > self._most_bytes:
            (oldest, _), dropped = self._kept.popitem(last=False)
            self._bytes -= _size(oldest, dropped)
        return report


def _size(submission: str, report: WrittenReport) -> int:
    return sys.getsizeof(submission) + report.size
