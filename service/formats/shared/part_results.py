"""The results of a submission, part by part; platforms show each as a test."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import chain, count
from typing import Final

from service.formats.shared.graded import (
    AnsweredPart,
    GradedFile,
    GradedSubmission,
    is_mostly_unread,
)
from service.formats.shared.messages import VERDICT_NAMES, Message, marks, messages
from service.formats.shared.plain_text import (
    first_lines,
    points,
    points_in_words,
    shortened,
    visible,
)
from service.grading import PartReport, RowReport, Verdict
from service.grading.report import rounded_points
from service.translations import ENGLISH, Language, told

# Platforms limit a result: an annotation to 64 KB, a whole result to 1 MB.
MESSAGES_TOLD: Final = 30
LONGEST: Final = 600


@dataclass(frozen=True, slots=True)
class PartResult:
    """The result of one part (question) of an assigned exercise."""

    # One line, unique in the submission.
    name: str
    file: GradedFile
    part: AnsweredPart
    # None if the file could not be graded.
    report: PartReport | None
    language: Language = ENGLISH

    @property
    def points(self) -> float:
        """Return the points earned, on the scale of the submission."""
        return rounded_points(self.report.points * self.file.weight) if self.report else 0.0

    @property
    def max_points(self) -> float:
        """Return the maximum points, on the scale of the submission."""
        return rounded_points(self.part.points * self.file.weight)

    @property
    def passed(self) -> bool:
        """True if all points were earned."""
        return self.points >= self.max_points

    @property
    def verdict(self) -> Verdict:
        """Return the verdict on the part; without a report, the part is unreadable."""
        return self.report.verdict if self.report else Verdict.UNREADABLE

    @property
    def points_in_words(self) -> str:
        """Return the points earned and the maximum points, such as ``1.5 / 2 points``."""
        return points_in_words(self.points, self.max_points, self.language.translation)

    @property
    def is_unread(self) -> bool:
        """True if so much of the part could not be read that its points say too little."""
        return self.report is None or is_mostly_unread(self.report)

    @property
    def verdict_name(self) -> str:
        """Return the name of the verdict."""
        return told(VERDICT_NAMES[self.verdict], self.language.translation)

    def row_points(self, row: RowReport) -> str:
        """Return the points of a row as text."""
        weight = self.file.weight
        return points(row.points * weight, row.max_points * weight)

    def messages(self) -> Iterator[Message]:
        """Return the messages on the part."""
        return messages(self.report, self.language.translation) if self.report else iter(())

    def marks(self) -> list[str]:
        """Return lines with the lost points and their places."""
        translation = self.language.translation
        lines = marks(self.report, self.file.weight, translation) if self.report else []
        return [shortened(line, LONGEST) for line in lines]

    def message_lines(self) -> list[str]:
        """Return a line for each message; their length and number are limited."""
        if self.report is None:
            return [shortened(visible(self.file.problem), LONGEST)]
        lines = (shortened(f"{each.label} {each.line}", LONGEST) for each in self.messages())
        return list(first_lines(lines, MESSAGES_TOLD, self.language.translation))

    def lines(self) -> list[str]:
        """Return all lines: first the messages, then the lost points."""
        return [*self.message_lines(), *self.marks()]


def part_results(submission: GradedSubmission, language: Language) -> list[PartResult]:
    """Return the result of each part of each exercise of the submission, in order."""
    distinct = distinct_names()
    has_several = len(submission.files) > 1
    return [
        PartResult(
            distinct(_title(part, file) if has_several else part.title),
            file,
            part,
            report,
            language,
        )
        for file in submission.files
        for part, report in _reports(file)
    ]


def _title(part: AnsweredPart, file: GradedFile) -> str:
    return f"{file.exercise.title}: {part.title}"


def _reports(file: GradedFile) -> Iterator[tuple[AnsweredPart, PartReport | None]]:
    reports = {report.part: report for report in (file.report.parts if file.report else ())}
    return ((part, reports.get(part.id)) for part in file.exercise.parts)


def distinct_names() -> Callable[[str], str]:
    """Return a function that replaces invisible characters in names, and numbers repeated names."""
    used: set[str] = set()

    def distinct(name: str) -> str:
        shown = visible(name)
        numbered = (f"{shown} ({i})" for i in count(2))
        free = next(each for each in chain([shown], numbered) if each not in used)
        used.add(free)
        return free

    return distinct
