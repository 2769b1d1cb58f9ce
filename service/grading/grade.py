"""Grading a whole submission: each part by its kind."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from service.catalogue import Exercise, PartSpec
from service.expressions import AngleUnit
from service.grading.feedback import FeedbackLevel
from service.grading.follow_through import (
    STANDS_STILL,
    carries,
    followed_part,
    follows_from,
    own_chain,
    stands_still,
)
from service.grading.kinds.dh_row import DhRowKind
from service.grading.kinds.dh_table import DhTableKind
from service.grading.kinds.euler_angles import EulerAnglesKind
from service.grading.kinds.link_transforms import LinkTransformsKind
from service.grading.kinds.matrix import MatrixKind
from service.grading.kinds.position import PositionKind
from service.grading.kinds.rotation import RotationKind
from service.grading.kinds.screw_axes import ScrewAxesKind
from service.grading.kinds.transform import TransformKind
from service.grading.kinds.vector import VectorKind
from service.grading.part import AnswerKind, Grading, PartTerms
from service.grading.reading.entry import MAX_CHARACTERS, Reader
from service.grading.report import PartReport, Report, Verdict, rounded_points
from service.grading.samples import draw

KINDS: Mapping[str, AnswerKind] = {
    "dh_table": DhTableKind(),
    "link_transforms": LinkTransformsKind(),
    "transform": TransformKind(),
    "rotation": RotationKind(),
    "matrix": MatrixKind(),
    "position": PositionKind(),
    "vector": VectorKind(),
    "euler_angles": EulerAnglesKind(),
    "screw_axes": ScrewAxesKind(),
    "dh_row": DhRowKind(),
}


@dataclass(frozen=True, slots=True)
class Submission:
    """What was handed in: one JSON value for each part answered."""

    answers: Mapping[str, object]
    angle_unit: AngleUnit = "radians"
    feedback: FeedbackLevel = FeedbackLevel.FULL


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
    reader = Reader(exercise.vocabulary, samples, submission.angle_unit)
    grading = Grading(exercise, samples, reader, submission.feedback)
    parts: list[PartReport] = []
    for part in exercise.parts:
        parts.append(_followed(part, submission.answers, parts, grading))
    if grading.level is FeedbackLevel.SCORE:
        parts = [_without_rows(part) for part in parts]
    points = rounded_points(sum(part.points for part in parts))
    max_points = rounded_points(sum(part.max_points for part in parts))
    return Report(
        exercise=exercise.id,
        version=exercise.version,
        gradable=any(_was_read(part) for part in parts),
        points=points,
        max_points=max_points,
        score=round(points / max_points, 6),
        parts=tuple(parts),
    )


def _followed(
    part: PartSpec,
    answers: Mapping[str, object],
    earlier: Sequence[PartReport],
    grading: Grading,
) -> PartReport:
    """The report on a part, by the reference or by the student's own earlier answer."""
    answer = answers.get(part.id)
    if answer is None:
        terms = PartTerms(part.id, part.kind, part.points, part.all_or_nothing)
        return terms.unread(Verdict.MISSING)
    source = followed_part(part, answers, grading.exercise)
    own = None if source is None else own_chain(source, answers[source.id], _afresh(grading))
    grading = replace(grading, source=own)
    grading.reader.moving = False
    report = KINDS[part.kind].grade(part, answer, grading)
    if report.points and stands_still(part, grading):
        return _without_points(report, grading)
    if report.verdict is Verdict.CORRECT or own is None or source is None:
        return report
    carrier = next(done for done in earlier if done.part == source.id)
    if not carries(source, answers[source.id], carrier, part, grading):
        return report
    by_own = KINDS[part.kind].grade(part, answer, replace(_afresh(grading), following=True))
    if by_own.points <= report.points:
        return report
    told = grading.visible((follows_from(source),))
    return replace(by_own, follow_through=True, feedback=(*told, *by_own.feedback))


def _without_points(report: PartReport, grading: Grading) -> PartReport:
    """The report on an answer that no joint moves: what is right in it is right by chance."""
    rows = tuple(replace(row, points=0.0) for row in report.rows)
    verdict = Verdict.INCORRECT if report.verdict is Verdict.PARTIAL else report.verdict
    told = grading.visible((STANDS_STILL,))
    return replace(
        report, rows=rows, points=0.0, verdict=verdict, feedback=(*told, *report.feedback)
    )


def _afresh(grading: Grading) -> Grading:
    """The same grading with nothing read yet."""
    return replace(grading, reader=replace(grading.reader, left=MAX_CHARACTERS, unread=0))


def _without_rows(report: PartReport) -> PartReport:
    """The bare mark, with what could not be read: that is no hint, and a student must know it."""
    reading = tuple(
        message for row in report.rows for cell in row.cells for message in cell.feedback
    )
    return replace(report, rows=(), feedback=(*report.feedback, *reading))


def _was_read(part: PartReport) -> bool:
    return part.verdict not in (Verdict.MISSING, Verdict.UNREADABLE)
