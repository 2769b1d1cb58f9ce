"""An answer kind: how answers of it are read and judged. One file of ``kinds`` holds each."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Protocol

from service.catalogue import Exercise, FeedbackLevel, PartSpec
from service.expressions.printing.spelling import Spelling, spelling_of
from service.grading.feedback import Finding, visible_messages
from service.grading.reading.entry import Entry, Reader
from service.grading.report import (
    Feedback,
    PartReport,
    Place,
    RowReport,
    Verdict,
    combined,
    rounded_points,
    total_of,
)
from service.grading.samples import Samples
from service.kinematics.transforms import Matrices, inverse


@dataclass(frozen=True, slots=True)
class StudentChain:
    """An answer as a chain of links, which a later part may follow from.

    ``frames`` ``(k + 1, SAMPLES, 4, 4)`` are its frames in the base frame, from the base on; the
    last is the tool's. ``tool_at`` gives the tool's frame at other samples, NaN where it has none.
    ``nearest_links`` ``(k, SAMPLES, 4, 4)`` are the link transforms of the valid table nearest to
    the answer, None where it is no table.
    """

    frames: Matrices
    tool_at: Callable[[Samples], Matrices]
    nearest_links: Matrices | None = None

    @property
    def links(self) -> Matrices:
        """The link transforms as the student has them, ``(k, SAMPLES, 4, 4)``."""
        return inverse(self.frames[:-1]) @ self.frames[1:]


@dataclass(frozen=True, slots=True)
class Grading:
    """One submission being graded: everything that an answer kind may use.

    ``echo`` says that each cell is reported as it was understood. ``student_chain`` is the earlier
    answer that the part follows from, where there is one. With
    ``following`` the part is judged by that answer and not by the reference.
    """

    exercise: Exercise
    samples: Samples
    reader: Reader
    level: FeedbackLevel
    echo: bool = False
    student_chain: StudentChain | None = None
    following: bool = False

    def visible(
        self, findings: tuple[Finding, ...], places: tuple[Place, ...] = ()
    ) -> tuple[Feedback, ...]:
        """The findings as messages, as far as the feedback level lets them through.

        ``places`` are those that they are about, where they do not stand with them.
        """
        return visible_messages(findings, self.level, places)

    def spelling(self, entries: Iterable[Entry]) -> Spelling:
        """The spelling of the entries of a part, in which the student is answered."""
        # Half the cells of a table are a bare 0, which shows nothing.
        expressions = [entry.expression for entry in entries]
        typed = [each.typed for each in expressions if each is not None and each.source != "0"]
        degrees = self.reader.angle_unit == "degrees"
        return spelling_of(typed, self.exercise.vocabulary, degrees=degrees)

    @property
    def corrects(self) -> bool:
        """Whether corrections are told, so that they need to be worked out."""
        return self.level is FeedbackLevel.FULL


def _no_chain() -> StudentChain | None:
    return None


@dataclass(frozen=True, slots=True)
class Judged:
    """An answer that was judged: its rows, and the messages on the part as a whole.

    ``lost`` is the share of the points that is lost beside those of the rows. ``stands_still``
    says that no joint moves an answer that must move. ``chain`` gives the answer as a chain, if it
    is one; it is asked only where another part follows this one.
    """

    rows: tuple[RowReport, ...]
    feedback: tuple[Feedback, ...] = ()
    lost: float = 0.0
    stands_still: bool = False
    chain: Callable[[], StudentChain | None] = _no_chain


class AnswerKind(Protocol):
    """The reading and the judging of answers of one kind.

    Pure: the same part, answer and samples, the same result.
    """

    def read(self, part: Any, answer: object, grading: Grading) -> Any:
        """The answer as ``judge`` takes it, from whatever JSON value was handed in, never None.

        None where nothing is written. Raises UnreadableAnswerError where nothing can be read.
        """
        ...

    def judge(self, part: Any, answer: Any, grading: Grading) -> Judged:
        """The judgement on an answer that was read."""
        ...


def part_report(part: PartSpec, judged: Judged) -> PartReport:
    """The report on a part that was judged: the rows share its points."""
    verdict = combined(row.verdict for row in judged.rows)
    if judged.lost and verdict is Verdict.CORRECT:
        verdict = Verdict.PARTIAL
    earned = total_of(judged.rows) - judged.lost * part.points
    if verdict is Verdict.CORRECT:
        earned = part.points
    elif part.all_or_nothing:
        earned = 0.0
    return PartReport(
        part=part.id,
        kind=part.kind,
        verdict=verdict,
        points=rounded_points(max(0.0, earned)),
        max_points=part.points,
        follow_through=False,
        rows=judged.rows,
        feedback=judged.feedback,
    )


def unjudged_report(
    part: PartSpec, verdict: Verdict, feedback: tuple[Feedback, ...] = ()
) -> PartReport:
    """The report on a part of which nothing was handed in, or nothing could be read."""
    return PartReport(part.id, part.kind, verdict, 0.0, part.points, False, (), feedback)
