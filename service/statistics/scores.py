"""The distribution of scores."""

from array import array
from dataclasses import dataclass
from statistics import fmean, median
from typing import Final

BINS: Final = 10
# A score on the edge of two bins belongs to the upper one, although it is rounded to six digits.
_EDGE: Final = 1e-6


@dataclass(frozen=True, slots=True)
class ScoreBin:
    """The submissions with a score from ``low`` to below ``high``; the last bin includes 1."""

    low: float
    high: float
    count: int
    # The number of these submissions that reach the pass mark.
    passed: int


class ScoreDistribution:
    """Counts scores from 0 to 1."""

    def __init__(self) -> None:
        self._scores = array("d")
        self._counts = [0] * BINS
        self._passed = [0] * BINS

    def add(self, score: float, *, passed: bool) -> None:
        """Count a submission with this score."""
        self._scores.append(score)
        place = min(int((score + _EDGE) * BINS), BINS - 1)
        self._counts[place] += 1
        self._passed[place] += passed

    @property
    def count(self) -> int:
        """The number of scores."""
        return len(self._scores)

    @property
    def passed(self) -> int:
        """The number of submissions that reach the pass mark."""
        return sum(self._passed)

    @property
    def mean(self) -> float:
        """The mean score. Raises StatisticsError without scores."""
        return fmean(self._scores)

    @property
    def median(self) -> float:
        """The median score. Raises StatisticsError without scores."""
        return median(self._scores)

    @property
    def bins(self) -> list[ScoreBin]:
        """Return ten bins of equal width, from 0 to 1."""
        counted = enumerate(zip(self._counts, self._passed, strict=True))
        return [ScoreBin(i / BINS, (i + 1) / BINS, *counts) for i, counts in counted]
