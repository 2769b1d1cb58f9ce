"""Grade a submission: read and judge each answer, and return a report.

This file knows in which order parts are graded, and when an answer follows from an earlier one. How
an answer is read and judged is known to its kind (``kinds``), its points to ``marks.py``.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

from dh_grader import VERSION
from dh_grader.catalogue import Exercise, FeedbackLevel, PartSpec
from dh_grader.expressions import AngleUnit
from dh_grader.grading.frames import OWN_FRAME_CHOICE
from dh_grader.grading.judging import Grading, Judged, StudentChain
from dh_grader.grading.kinds import KINDS
from dh_grader.grading.marks import (
    STANDS_STILL,
    can_carry,
    follows_from,
    has_earned,
    part_report,
    unjudged_report,
)
from dh_grader.grading.numbers import draw
from dh_grader.grading.reading.entries import Reader
from dh_grader.grading.report import (
    Finding,
    PartReport,
    Report,
    Severity,
    UnreadableAnswerError,
    Verdict,
    WorkBudget,
    parts_at_level,
    rounded_points,
    was_read,
)
from dh_grader.translations import say


@dataclass(frozen=True, slots=True)
class Submission:
    """The submitted answers to an exercise: a JSON value for each answered question."""

    answers: Mapping[str, object]
    angle_unit: AngleUnit = "radians"
    # The feedback level of the report.
    feedback: FeedbackLevel = FeedbackLevel.FULL
    # If True, the report shows how each cell was read.
    echo: bool = False


class UnknownPartError(ValueError):
    """The submission answers a question that the exercise does not have."""

    def __init__(self, unknown: str, exercise: Exercise) -> None:
        self.unknown = unknown
        self.known = tuple(part.id for part in exercise.parts)
        super().__init__(
            f"exercise {exercise.id!r} has no part {unknown!r}; it has {', '.join(self.known)}"
        )


_WORK_LIMIT: Final = Finding(
    "work_limit",
    say(
        "Not every mistake is explained: there are too many for one report. Correct those that are "
        "explained, then check again."
    ),
    severity=Severity.INFO,
).message(corrects=False)


@dataclass(frozen=True, slots=True)
class GradedAnswers:
    """Answers that were graded once, for reports at several feedback levels."""

    exercise: Exercise
    # With all their messages.
    parts: tuple[PartReport, ...]
    # True if corrections were computed.
    corrects: bool
    # True if the work budget did not allow all explanations.
    has_left_out: bool

    def can_tell(self, level: FeedbackLevel) -> bool:
        """True if a report at this feedback level can be made without grading again."""
        return self.corrects == (level is FeedbackLevel.FULL)

    def report(self, level: FeedbackLevel) -> Report:
        """Return the report at a feedback level for which ``can_tell`` is true."""
        assert self.can_tell(level)
        points = rounded_points(sum(part.points for part in self.parts))
        max_points = rounded_points(sum(part.max_points for part in self.parts))
        return Report(
            exercise=self.exercise.id,
            version=self.exercise.version,
            grader=VERSION,
            feedback=level,
            gradable=any(map(was_read, self.parts)),
            points=points,
            max_points=max_points,
            score=round(points / max_points, 6),
            parts=parts_at_level(self.parts, level, _WORK_LIMIT if self.has_left_out else None),
        )


def grade(exercise: Exercise, submission: Submission) -> Report:
    """Return the report on a submission.

    The same submission gives the same report. Raises UnknownPartError for a part that does not
    exist; no other submission raises an error.
    """
    return graded_answers(exercise, submission).report(submission.feedback)


def graded_answers(exercise: Exercise, submission: Submission) -> GradedAnswers:
    """Grade a submission once, for reports at several feedback levels."""
    grading = _begun(exercise, submission)
    parts = tuple(_reports(submission.answers, grading))
    left_out = grading.reader.budget.has_left_out
    return GradedAnswers(exercise, parts, grading.corrects, left_out)


def report_on_part(exercise: Exercise, submission: Submission, part_id: str) -> PartReport | None:
    """Return the report on one part as in ``grade``; None if the exercise has no such part.

    The answers to later parts are not read.
    """
    for report in _reports(submission.answers, _begun(exercise, submission)):
        if report.part == part_id:
            [shown] = parts_at_level([report], submission.feedback, None)
            return shown
    return None


def is_all_right(exercise: Exercise, submission: Submission) -> bool:
    """True if the answers to all parts of the exercise are right.

    If an answer is missing, nothing is read; nothing is read after the first wrong answer.
    """
    if any(submission.answers.get(part.id) is None for part in exercise.parts):
        return False
    grading = replace(_begun(exercise, submission), explains=False)
    reports = _reports(submission.answers, grading)
    return all(report.verdict is Verdict.CORRECT for report in reports)


def _begun(exercise: Exercise, submission: Submission) -> Grading:
    for part_id in submission.answers:
        if exercise.part(part_id) is None:
            raise UnknownPartError(part_id, exercise)
    degrees = submission.angle_unit == "degrees"
    samples = draw(exercise, submission.answers, degrees=degrees)
    budget = WorkBudget(answers=submission.answers)
    reader = Reader.of(exercise, samples, submission.angle_unit, budget)
    corrects = submission.feedback is FeedbackLevel.FULL
    return Grading(exercise, samples, reader, corrects=corrects, echo=submission.echo)


def _reports(answers: Mapping[str, object], grading: Grading) -> Iterator[PartReport]:
    # A part is graded when its report is taken.
    graded: dict[str, _Graded] = {}
    for part in grading.exercise.parts:
        graded[part.id] = _graded(part, answers, graded, grading)
        yield graded[part.id].report


@dataclass(frozen=True)
class _Graded:
    # A wrong answer may have been judged by an earlier answer of the student instead of the
    # reference.
    part: PartSpec
    report: PartReport
    # None if there was no readable answer.
    judged: Judged | None
    # True if the answer is correct by the reference, or by an earlier answer that is right.
    is_right: bool = False

    @cached_property
    def chain(self) -> StudentChain | None:
        # The answer as a chain by which later parts may be judged, or None.
        return None if self.judged is None else self.judged.chain()

    def carries(self, share: float, grading: Grading) -> bool:
        # True if later parts may be judged by this answer instead of by the reference. It must be
        # an arm with the robot's joints (``can_carry``) and must have earned ``share`` of the
        # points. These are counted as in the marking "content", even if the part has another one.
        return (
            self.judged is not None
            and self.chain is not None
            and has_earned(self.part, self.judged, share)
            and can_carry(self.chain, grading)
        )


def _graded(
    part: PartSpec, answers: Mapping[str, object], earlier: Mapping[str, _Graded], grading: Grading
) -> _Graded:
    answer = answers.get(part.id)
    if answer is None:
        return _Graded(part, unjudged_report(part, Verdict.MISSING), None)
    followed = _followed(part, answers, earlier)
    if followed is not None:
        grading = replace(grading, student_chain=followed.chain)
    kind = KINDS[part.kind]
    try:
        read = kind.read(part, answer, grading)
    except UnreadableAnswerError as error:
        messages = grading.messages((error.finding,))
        return _Graded(part, unjudged_report(part, Verdict.UNREADABLE, messages), None)
    if read is None:
        return _Graded(part, unjudged_report(part, Verdict.MISSING), None)
    judged = kind.judge(part, read, grading)
    # A table with missing cells only does not imply that no joint moves.
    if judged.stands_still and judged.is_wrong:
        messages = grading.messages((STANDS_STILL,))
        # A table without any motion implies no choice of frames.
        others = (each for each in judged.feedback if each.code != OWN_FRAME_CHOICE)
        judged = replace(judged, feedback=(*messages, *others))
    report = part_report(part, judged)
    is_right = report.verdict is Verdict.CORRECT
    if is_right or judged.stands_still or followed is None:
        return _Graded(part, report, judged, is_right)
    if followed.carries(part.follows_from, grading):
        by_student = kind.judge(part, read, replace(grading, following=True))
        following = part_report(part, by_student)
        if following.points > report.points:
            is_right = followed.is_right and following.verdict is Verdict.CORRECT
            told = follows_from(followed.part, is_right=followed.is_right)
            messages = grading.messages((told,))
            report = replace(
                following, follow_through=True, feedback=(*messages, *following.feedback)
            )
            judged = replace(by_student, chain=judged.chain)
    return _Graded(part, report, judged, is_right)


def _followed(
    part: PartSpec, answers: Mapping[str, object], earlier: Mapping[str, _Graded]
) -> _Graded | None:
    # The nearest earlier part that this part depends on and that has an answer.
    while part.follows is not None:
        part = earlier[part.follows].part
        if answers.get(part.id) is not None:
            return earlier[part.id]
    return None
