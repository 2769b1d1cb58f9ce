"""What an answer kind is: one file in this package with one object that fits this protocol."""

from dataclasses import dataclass
from typing import Any, Protocol

from service.catalogue import Exercise
from service.grading.feedback import FeedbackLevel, Finding, shown
from service.grading.reading.entry import Reader
from service.grading.report import (
    Feedback,
    PartReport,
    RowReport,
    Verdict,
    combined,
    rounded_points,
    total_of,
)
from service.grading.samples import Samples
from service.kinematics.transforms import Matrices, inverse


@dataclass(frozen=True, slots=True)
class OwnChain:
    """An earlier answer of the student's, as a chain that a later part may follow from.

    ``frames`` ``(k + 1, SAMPLES, 4, 4)`` are its frames in the base frame, from the base on; the
    last is the tool's. ``nearest_links`` ``(k, SAMPLES, 4, 4)`` are the link transforms of the
    valid table nearest to it, None where it is no table.
    """

    frames: Matrices
    nearest_links: Matrices | None

    @property
    def links(self) -> Matrices:
        """The link transforms as the student has them, ``(k, SAMPLES, 4, 4)``."""
        return inverse(self.frames[:-1]) @ self.frames[1:]


@dataclass(frozen=True, slots=True)
class Grading:
    """One submission being graded: what every answer kind may look at.

    ``source`` is the earlier answer that the part follows from, where there is one. With
    ``following`` the part is judged by that answer and not by the reference.
    """

    exercise: Exercise
    samples: Samples
    reader: Reader
    level: FeedbackLevel
    source: OwnChain | None = None
    following: bool = False

    def visible(
        self, findings: tuple[Finding, ...], row: str | None = None, cell: str | None = None
    ) -> tuple[Feedback, ...]:
        """The findings as messages, as far as the feedback level lets them through."""
        return shown(findings, self.level, row, cell)


class AnswerKind(Protocol):
    """Grades the parts of one kind. Pure: the same part, answer and samples, the same report."""

    def grade(self, part: Any, answer: object, grading: Grading) -> PartReport:
        """The report on ``answer``, which is whatever JSON value was handed in, never None."""
        ...


@dataclass(frozen=True, slots=True)
class PartTerms:
    """What a part is called and what it is worth, whatever its kind."""

    id: str
    kind: str
    points: float
    all_or_nothing: bool

    def report(
        self, rows: tuple[RowReport, ...], feedback: tuple[Feedback, ...] = (), lost: float = 0.0
    ) -> PartReport:
        """The part from its rows; ``lost`` is the share of the points that extra rows cost."""
        verdict = combined(row.verdict for row in rows)
        if lost and verdict is Verdict.CORRECT:
            verdict = Verdict.PARTIAL
        earned = total_of(rows) - lost * self.points
        if verdict is Verdict.CORRECT:
            earned = self.points
        elif self.all_or_nothing:
            earned = 0.0
        return PartReport(
            part=self.id,
            kind=self.kind,
            verdict=verdict,
            points=rounded_points(max(0.0, earned)),
            max_points=self.points,
            follow_through=False,
            rows=rows,
            feedback=feedback,
        )

    def unread(self, verdict: Verdict, feedback: tuple[Feedback, ...] = ()) -> PartReport:
        """The report on a part of which nothing could be read, or nothing was handed in."""
        return PartReport(self.id, self.kind, verdict, 0.0, self.points, False, (), feedback)
