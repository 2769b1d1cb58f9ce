"""A submission -> a report: each part is read and judged by its kind."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from service.catalogue import Exercise, FeedbackLevel, PartSpec
from service.expressions import AngleUnit
from service.grading.feedback import Finding, UnreadableAnswerError, told_once
from service.grading.follow_through import STANDS_STILL, can_carry, follows_from
from service.grading.judging.marks import has_earned, part_report, unjudged_report
from service.grading.judging.own_frames.remarks import OWN_FRAME_CHOICE
from service.grading.kinds import KINDS
from service.grading.part import Grading, Judged, StudentChain
from service.grading.reading.entry import Reader
from service.grading.report import PartReport, Place, Report, Severity, Verdict, rounded_points
from service.grading.samples import draw
from service.grading.work_budget import WorkBudget
from service.version import VERSION


@dataclass(frozen=True, slots=True)
class Submission:
    """The answers that were handed in: one JSON value for each part answered.

    ``feedback`` is how much the report tells, ``echo`` whether it tells how each cell was read.
    """

    answers: Mapping[str, object]
    angle_unit: AngleUnit = "radians"
    feedback: FeedbackLevel = FeedbackLevel.FULL
    echo: bool = False


class UnknownPartError(ValueError):
    """The submission answers a part that the exercise does not have."""

    def __init__(self, unknown: str, exercise: Exercise) -> None:
        self.unknown = unknown
        self.known = tuple(part.id for part in exercise.parts)
        super().__init__(
            f"exercise {exercise.id!r} has no part {unknown!r}; it has {', '.join(self.known)}"
        )


def grade(exercise: Exercise, submission: Submission) -> Report:
    """The report on a submission. Pure: the same submission gives the same report.

    Raises UnknownPartError for a part that does not exist; nothing else that a student hands in
    raises anything.
    """
    for part_id in submission.answers:
        if exercise.part(part_id) is None:
            raise UnknownPartError(part_id, exercise)
    degrees = submission.angle_unit == "degrees"
    samples = draw(exercise, submission.answers, degrees=degrees)
    budget = WorkBudget(answers=submission.answers)
    reader = Reader.of(exercise, samples, submission.angle_unit, budget)
    grading = Grading(exercise, samples, reader, submission.feedback, submission.echo)
    graded: dict[str, _Graded] = {}
    for part in exercise.parts:
        graded[part.id] = _graded(part, submission.answers, graded, grading)
    parts = [told_once(each.report) for each in graded.values()]
    if budget.has_left_out:
        parts = _with_work_limit(parts, grading)
    if grading.level is FeedbackLevel.SCORE:
        parts = [_without_rows(part) for part in parts]
    points = rounded_points(sum(part.points for part in parts))
    max_points = rounded_points(sum(part.max_points for part in parts))
    return Report(
        exercise=exercise.id,
        version=exercise.version,
        grader=VERSION,
        feedback=submission.feedback,
        gradable=any(_was_read(each.report) for each in graded.values()),
        points=points,
        max_points=max_points,
        score=round(points / max_points, 6),
        parts=tuple(parts),
    )


@dataclass(frozen=True)
class _Graded:
    """A part that was graded; ``judged`` is None where there was nothing to judge.

    Where it follows from the student's own earlier answer, it was judged by that one.
    """

    part: PartSpec
    report: PartReport
    judged: Judged | None

    @cached_property
    def chain(self) -> StudentChain | None:
        """The answer as a chain that later parts may follow from."""
        return None if self.judged is None else self.judged.chain()

    def carries(self, share: float, grading: Grading) -> bool:
        """Whether a later part may follow from the answer.

        It must have earned its share of the points by what one has to know, however the part is
        marked, and be an arm of the robot's joints.
        """
        if self.judged is None or self.chain is None or not has_earned(self.judged, share):
            return False
        return can_carry(self.chain, grading)


_WORK_LIMIT = Finding(
    "work_limit",
    "Not every mistake is explained: there are too many for one report. Correct those that are "
    "explained, then check again.",
    severity=Severity.INFO,
)


def _with_work_limit(parts: list[PartReport], grading: Grading) -> list[PartReport]:
    """The parts; the first one that has a wrong cell without a message says that there are such."""
    for i, part in enumerate(parts):
        if _has_unexplained_cells(part):
            told = replace(part, feedback=(*part.feedback, *grading.visible((_WORK_LIMIT,))))
            return [*parts[:i], told, *parts[i + 1 :]]
    return parts


def _has_unexplained_cells(part: PartReport) -> bool:
    messages = [each for each in part.feedback if each.severity is Severity.ERROR]
    if any(message.places is None for message in messages):
        return False
    told = {(place.row, place.cell) for each in messages for place in each.places or ()}
    return any(
        cell.verdict is Verdict.INCORRECT and not cell.feedback and not row.feedback
        for row in part.rows
        for cell in row.cells
        if (row.label, cell.label) not in told and (row.label, None) not in told
    )


def _graded(
    part: PartSpec, answers: Mapping[str, object], earlier: Mapping[str, _Graded], grading: Grading
) -> _Graded:
    """A part judged by the reference, or by the student's own answer to the part it follows."""
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
        messages = grading.visible((error.finding,))
        return _Graded(part, unjudged_report(part, Verdict.UNREADABLE, messages), None)
    if read is None:
        return _Graded(part, unjudged_report(part, Verdict.MISSING), None)
    judged = kind.judge(part, read, grading)
    if judged.stands_still:
        messages = grading.visible((STANDS_STILL,))
        # Who let no joint move has chosen no frames.
        others = (each for each in judged.feedback if each.code != OWN_FRAME_CHOICE)
        judged = replace(judged, feedback=(*messages, *others))
    report = part_report(part, judged)
    if report.verdict is Verdict.CORRECT or judged.stands_still or followed is None:
        return _Graded(part, report, judged)
    if followed.carries(part.follows_from, grading):
        by_student = kind.judge(part, read, replace(grading, following=True))
        following = part_report(part, by_student)
        if following.points > report.points:
            messages = grading.visible((follows_from(followed.part),))
            report = replace(
                following, follow_through=True, feedback=(*messages, *following.feedback)
            )
            judged = replace(by_student, chain=judged.chain)
    return _Graded(part, report, judged)


def _followed(
    part: PartSpec, answers: Mapping[str, object], earlier: Mapping[str, _Graded]
) -> _Graded | None:
    """The part that this one follows: where that one has no answer, the one that it follows."""
    while part.follows is not None:
        part = earlier[part.follows].part
        if answers.get(part.id) is not None:
            return earlier[part.id]
    return None


def _without_rows(report: PartReport) -> PartReport:
    """The bare mark, with what could not be read: that is no hint, and a student must know it."""
    reading = tuple(
        replace(message, places=(Place(row.label, cell.label),))
        for row in report.rows
        for cell in row.cells
        for message in cell.feedback
    )
    return replace(report, rows=(), feedback=(*report.feedback, *reading))


def _was_read(part: PartReport) -> bool:
    """Whether any cell of the part was read."""
    unread = (Verdict.MISSING, Verdict.UNREADABLE)
    return any(cell.verdict not in unread for row in part.rows for cell in row.cells)
