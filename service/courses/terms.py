"""The rules of an assignment for one learner: dates, limit, feedback, practice and solution."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from functools import lru_cache
from typing import Any, Final
from zoneinfo import ZoneInfo

from sqlalchemy import Connection, Row, and_, bindparam, select

from service.attempts.storage.tables import assignments, course_learners, courses, extensions
from service.catalogue import Exercise, FeedbackLevel, least
from service.catalogue.attempts import AttemptsSpec
from service.contract.courses import (
    AssignmentState,
    Practice,
    ShowSolution,
)
from service.courses.errors import unknown_assignment, unknown_course, unknown_learner
from service.courses.times import local, own_dates

_EXTENDED: Final = ("due", "closes", "max_attempts")
_OWN: Final = and_(
    extensions.c.assignment == assignments.c.number,
    extensions.c.learner == bindparam("learner"),
)
# Build the statements once: building one takes longer than running it.
_OF_LEARNER: Final = (
    select(
        assignments,
        courses.c.zone,
        extensions.c.learner.label("extended"),
        *(extensions.c[name].label(f"own_{name}") for name in _EXTENDED),
    )
    .join_from(course_learners, courses)
    .join(assignments)
    .join(extensions, _OWN, isouter=True)
    .where(course_learners.c.learner == bindparam("learner"))
    .order_by(assignments.c.course, assignments.c.number)
)
_OF_COURSE: Final = _OF_LEARNER.where(course_learners.c.course == bindparam("course"))
_OF_ASSIGNMENT: Final = _OF_COURSE.where(assignments.c.id == bindparam("assignment"))


@dataclass(frozen=True, slots=True)
class LearnerTerms:
    """The rules of an assignment for one learner, including the learner's extension.

    ``exercises`` has the points of each exercise. ``variants`` is the secret that determines the
    learners' variants, or None.
    """

    # ``number`` is the row number of the assignment. ``choices`` says what the variants may vary,
    # as JSON; None if the exercise files define this.

    number: int
    id: str
    title: str
    zone: ZoneInfo
    exercises: Mapping[str, float]
    rules: AttemptsSpec
    feedback: tuple[FeedbackLevel, ...] | None
    practice: Practice
    solution: ShowSolution
    is_extended: bool
    variants: str | None = field(default=None, repr=False)
    choices: str | None = field(default=None, repr=False)

    def feedback_at(self, exercise: Exercise, ordinal: int) -> FeedbackLevel:
        """The highest feedback level for the attempt with this number."""
        # The level is never higher than the exercise allows.
        if self.feedback is None:
            return exercise.feedback_at(ordinal)
        most = min(exercise.feedback_by_attempt, key=list(FeedbackLevel).index)
        return least(self.feedback[min(ordinal, len(self.feedback)) - 1], most)

    def hint_prices(self, exercise: Exercise) -> list[float] | None:
        """The price of each step of a hint, or None if there are no hints."""
        if self.rules.hint_prices is None:
            return exercise.attempts.hint_prices
        return self.rules.hint_prices

    def state(self, now: datetime) -> AssignmentState:
        """Whether the learner can hand in: not yet, in time, late, or no longer."""
        if self.rules.opens is not None and now < self.rules.opens:
            return "not_open"
        if self._is_over(now):
            return "closed"
        return "late" if self._is_past_due(now) else "open"

    def may_practise(self, now: datetime, *, is_full: bool) -> bool:
        """True if the learner may practise, that is, answer without a recorded attempt.

        ``is_full`` is True if the learner has full marks.
        """
        if self.practice == "after":
            return is_full or self._is_past_due(now)
        return self.practice == "open"

    def shows_solution(self, now: datetime, *, is_full: bool) -> bool:
        """True if the learner may see the solution; ``is_full`` is True after full marks."""
        match self.solution:
            case "after_full":
                return is_full
            case "after_due":
                return self._is_over(now)
        return False

    def _is_past_due(self, now: datetime) -> bool:
        return self.rules.due is not None and now > self.rules.due

    def _is_over(self, now: datetime) -> bool:
        end = self.rules.closes or self.rules.due
        return end is not None and now > end


def terms_of(connection: Connection, course: str, assignment: str, learner: str) -> LearnerTerms:
    """Return the rules of an assignment for a learner of the course. Raises CourseError."""
    which = {"learner": learner, "course": course, "assignment": assignment}
    found = connection.execute(_OF_ASSIGNMENT, which).one_or_none()
    if found is not None:
        return _terms(found)
    enrolled = and_(course_learners.c.course == course, course_learners.c.learner == learner)
    if connection.scalar(select(courses.c.id).where(courses.c.id == course)) is None:
        raise unknown_course(course)
    if connection.scalar(select(course_learners.c.course).where(enrolled)) is None:
        raise unknown_learner(learner)
    raise unknown_assignment(assignment)


def learner_terms(
    connection: Connection, learner: str, only: str | None = None
) -> Iterator[tuple[str, LearnerTerms]]:
    """Yield the course and the rules of each assignment of a learner.

    ``only`` restricts the result to one course.
    """
    # The assignments of a course are in the order in which they were added.
    if only is None:
        rows = connection.execute(_OF_LEARNER, {"learner": learner})
    else:
        rows = connection.execute(_OF_COURSE, {"learner": learner, "course": only})
    for row in rows:
        yield row.course, _terms(row)


# The learners of a class have the same terms, but for their extensions.
@lru_cache(maxsize=256)
def _terms(row: Row[Any]) -> LearnerTerms:
    zone = ZoneInfo(row.zone)
    return LearnerTerms(
        number=row.number,
        id=row.id,
        title=row.title,
        zone=zone,
        exercises={each["exercise"]: each["points"] for each in json.loads(row.exercises)},
        rules=extended(row, zone, *(getattr(row, f"own_{name}") for name in _EXTENDED)),
        feedback=None
        if row.feedback is None
        else tuple(FeedbackLevel(each) for each in json.loads(row.feedback)),
        practice=row.practice,
        solution=row.solution,
        is_extended=row.extended is not None,
        variants=row.variants,
        choices=row.choices,
    )


def extended(
    row: Row[Any],
    zone: ZoneInfo,
    due: datetime | None = None,
    closes: datetime | None = None,
    limit: int | None = None,
) -> AttemptsSpec:
    """Return the rules of an assignment with the dates and the limit of an extension."""
    new_due, new_closes = own_dates(row, due, closes)
    return AttemptsSpec(
        limit=limit or row.max_attempts,
        opens=local(row.opens, zone),
        due=local(new_due, zone),
        closes=local(new_closes, zone),
        late_worth=row.late_worth,
        hint_prices=None if row.hint_prices is None else json.loads(row.hint_prices),
    )
