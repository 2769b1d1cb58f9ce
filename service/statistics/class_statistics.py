"""All statistics of a class."""

from collections.abc import Mapping
from typing import Final

from service.grading import FeedbackLevel, Report
from service.statistics.identical import IdenticalMistakes
from service.statistics.misconceptions import SlipCounts
from service.statistics.scores import ScoreDistribution
from service.statistics.success import PartSuccess

_NO_MESSAGES: Final = (FeedbackLevel.VERDICTS, FeedbackLevel.SCORE)


class ClassStatistics:
    """Counts the reports of a class, one by one.

    The caller adds the score of each submission to ``scores``.
    """

    def __init__(self) -> None:
        self.scores = ScoreDistribution()
        self.slips = SlipCounts()
        self.identical = IdenticalMistakes()
        self.untold = 0
        self._parts: dict[tuple[str, str], PartSuccess] = {}

    def add(self, submission: int, report: Report) -> None:
        """Count a report; ``submission`` is the number of its submission."""
        # These reports hide mistakes.
        self.untold += report.feedback in _NO_MESSAGES
        for part in report.parts:
            self._parts.setdefault((report.exercise, part.part), PartSuccess()).add(part)
            self.slips.add(submission, report.exercise, part)
            self.identical.add(submission, report.exercise, part)

    @property
    def parts(self) -> Mapping[tuple[str, str], PartSuccess]:
        """The success in each part, by the ids of exercise and part."""
        return self._parts
