"""The parts of a submission as the tests that platforms know: one for each part that was set."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import chain, count
from typing import Final

from service.formats.shared.graded import AnsweredPart, GradedFile, GradedSubmission
from service.formats.shared.messages import Message, messages
from service.formats.shared.plain_text import first_lines, points, shortened, visible
from service.grading import PartReport, RowReport, Verdict
from service.grading.report import rounded_points

# Platforms bound what a result may hold: a message of an annotation 64 KB, a whole result 1 MB.
MESSAGES_TOLD: Final = 30
LONGEST: Final = 600


@dataclass(frozen=True, slots=True)
class PartResult:
    """A part that was set, with its report, or with the problem because of which there is none.

    ``name`` is one line, and that of no other part of the submission. Points are those that count
    in the submission.
    """

    name: str
    file: GradedFile
    part: AnsweredPart
    report: PartReport | None

    @property
    def points(self) -> float:
        """The points earned."""
        return rounded_points(self.report.points * self.file.weight) if self.report else 0.0

    @property
    def max_points(self) -> float:
        """The most points that there are."""
        return rounded_points(self.part.points * self.file.weight)

    @property
    def passed(self) -> bool:
        """Whether all points were earned."""
        return self.points >= self.max_points

    @property
    def verdict(self) -> Verdict:
        """The verdict on the part; unreadable where the file has no report."""
        return self.report.verdict if self.report else Verdict.UNREADABLE

    def row_points(self, row: RowReport) -> str:
        """The points of one of its rows in words."""
        weight = self.file.weight
        return points(row.points * weight, row.max_points * weight)

    def messages(self) -> Iterator[Message]:
        """The messages on the part."""
        return messages(self.report) if self.report else iter(())

    def lines(self) -> list[str]:
        """What is to be said of the part, a line for each message, bounded in length and number."""
        if self.report is None:
            return [shortened(visible(self.file.problem), LONGEST)]
        lines = (shortened(f"{each.label} {each.line}", LONGEST) for each in self.messages())
        return list(first_lines(lines, MESSAGES_TOLD))


def part_results(submission: GradedSubmission) -> list[PartResult]:
    """The parts of all exercises of the submission, in order."""
    distinct = distinct_names()
    has_several = len(submission.files) > 1
    return [
        PartResult(distinct(_title(part, file) if has_several else part.title), file, part, report)
        for file in submission.files
        for part, report in _reports(file)
    ]


def _title(part: AnsweredPart, file: GradedFile) -> str:
    return f"{file.exercise.title}: {part.title}"


def _reports(file: GradedFile) -> Iterator[tuple[AnsweredPart, PartReport | None]]:
    """The parts that were set with their reports."""
    reports = {report.part: report for report in (file.report.parts if file.report else ())}
    return ((part, reports.get(part.id)) for part in file.exercise.parts)


def distinct_names() -> Callable[[str], str]:
    """Makes names visible and no two alike: the second of two that are gets a number."""
    used: set[str] = set()

    def distinct(name: str) -> str:
        shown = visible(name)
        numbered = (f"{shown} ({i})" for i in count(2))
        free = next(each for each in chain([shown], numbered) if each not in used)
        used.add(free)
        return free

    return distinct
