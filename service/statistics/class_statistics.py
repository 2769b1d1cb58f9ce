"""All that is counted of the reports of a class."""

from collections.abc import Mapping
from typing import Final

from service.grading import FeedbackLevel, Report
from service.statistics.identical import IdenticalMistakes
from service.statistics.misconceptions import SlipCounts
from service.statistics.scores import ScoreDistribution
from service.statistics.success import PartSuccess

_NO_MESSAGES: Final = (FeedbackLevel.VERDICTS, FeedbackLevel.SCORE)


class ClassStatistics:
    """Reports in, counts out.

    Submissions come one by one, each with a number of its own: its score by ``scores.add``, its
    reports by ``add``. ``untold`` counts the reports whose feedback level keeps the slips back.
    """

    def __init__(self) -> None:
        self.scores = ScoreDistribution()
        self.slips = SlipCounts()
        self.identical = IdenticalMistakes()
        self.untold = 0
        self._parts: dict[tuple[str, str], PartSuccess] = {}

    def add(self, submission: int, report: Report) -> None:
        """Count a report of the submission with this number."""
        self.untold += report.feedback in _NO_MESSAGES
        for part in report.parts:
            self._parts.setdefault((report.exercise, part.part), PartSuccess()).add(part)
            self.slips.add(submission, report.exercise, part)
            self.identical.add(submission, report.exercise, part)

    @property
    def parts(self) -> Mapping[tuple[str, str], PartSuccess]:
        """Success in each part that a report tells of, by the ids of exercise and part."""
        return self._parts
