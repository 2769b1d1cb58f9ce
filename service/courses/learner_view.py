"""The courses and assignments of one learner, as this learner sees them."""

from collections.abc import Mapping
from datetime import datetime
from itertools import groupby

from sqlalchemy import Connection, select

from service.attempts.attempt import ListedAttempt
from service.attempts.results.listing import LISTED
from service.attempts.storage.tables import attempts, course_learners, courses
from service.catalogue import Exercise
from service.contract.courses import (
    OwnAssignment,
    OwnAttempt,
    OwnCourse,
    OwnCourses,
    OwnExercise,
)
from service.courses.terms import LearnerTerms, learner_terms
from service.courses.times import local

# Full marks, but for rounding.
_FULL = 1 - 1e-9

# The attempts of a learner by the numbers of their assignments and by exercise, oldest first.
_Attempts = Mapping[tuple[int, str], list[tuple[ListedAttempt, float]]]


def own_view(
    connection: Connection,
    learner: str,
    only: str | None,
    catalogue: Mapping[str, Exercise],
    now: datetime,
) -> OwnCourses:
    """Return the courses of a learner; with ``only``, this course."""
    mine = course_learners.c.learner == learner
    if only is not None:
        mine &= course_learners.c.course == only
    rows = connection.execute(
        select(courses.c.id, courses.c.title, courses.c.zone, course_learners.c.name)
        .join_from(course_learners, courses)
        .where(mine)
        .order_by(courses.c.created_at.desc(), courses.c.id)
    ).all()
    done = _attempts(connection, learner)
    terms = {
        course: [each for _, each in found]
        for course, found in groupby(learner_terms(connection, learner, only), lambda it: it[0])
    }
    return OwnCourses(
        learner=learner,
        now=now,
        courses=[
            OwnCourse(
                **row._mapping,
                assignments=[
                    _assignment(each, done, catalogue, now) for each in terms.get(row.id, ())
                ],
            )
            for row in rows
        ],
    )


def closed_practice(
    connection: Connection, learner: str, only: str | None, exercise: str, now: datetime
) -> LearnerTerms | None:
    """Return an assignment that does not let the learner practise the exercise; None if all do."""
    for _, terms in learner_terms(connection, learner, only):
        if exercise in terms.exercises:
            full = terms.practice == "after" and has_full_marks(
                connection, learner, terms.number, exercise
            )
            if not terms.may_practise(now, is_full=full):
                return terms
    return None


def has_full_marks(connection: Connection, learner: str, number: int, exercise: str) -> bool:
    """True if an attempt of the learner in this assignment has full marks, late or not."""
    return _is_full(_attempts(connection, learner).get((number, exercise), []))


def _attempts(connection: Connection, learner: str) -> _Attempts:
    found: dict[tuple[int, str], list[tuple[ListedAttempt, float]]] = {}
    rows = connection.execute(
        select(*LISTED, attempts.c.assignment, attempts.c.worth)
        .where(attempts.c.learner == learner, attempts.c.assignment.is_not(None))
        .order_by(attempts.c.number)
    )
    for *listed, assignment, worth in rows:
        attempt = ListedAttempt(*listed)
        found.setdefault((assignment, attempt.exercise), []).append((attempt, worth))
    return found


def _assignment(
    terms: LearnerTerms, done: _Attempts, catalogue: Mapping[str, Exercise], now: datetime
) -> OwnAssignment:
    rules = terms.rules
    return OwnAssignment(
        id=terms.id,
        title=terms.title,
        state=terms.state(now),
        opens=local(rules.opens, terms.zone),
        due=local(rules.due, terms.zone),
        closes=local(rules.closes, terms.zone),
        late_worth=rules.late_worth,
        limit=rules.limit,
        is_extended=terms.is_extended,
        exercises=[
            _exercise(name, terms, done.get((terms.number, name), []), catalogue.get(name), now)
            for name in terms.exercises
        ],
    )


def _exercise(
    name: str,
    terms: LearnerTerms,
    done: list[tuple[ListedAttempt, float]],
    exercise: Exercise | None,
    now: datetime,
) -> OwnExercise:
    counted = [each for each in done if each[0].ordinal is not None or each[0].awarded is not None]
    best = max(counted, key=_share, default=None)
    points, is_full, limit = terms.exercises[name], _is_full(done), terms.rules.limit
    tried = sum(attempt.ordinal is not None for attempt, _ in done)
    return OwnExercise(
        exercise=name,
        title=exercise.title if exercise else name,
        points=points,
        earned=None if best is None else round(_share(best) * points, 6),
        best=max((round(_whole_share(each) * points, 6) for each in counted), default=None),
        attempts_left=None if limit is None else max(0, limit - tried),
        may_practise=terms.may_practise(now, is_full=is_full),
        shows_solution=terms.shows_solution(now, is_full=is_full),
        attempts=[
            OwnAttempt(
                **{field: getattr(each[0], field) for field in _SHOWN},
                at=each[0].at.astimezone(terms.zone),
                points=each[0].earned,
                counts=each is best,
            )
            for each in done
        ],
    )


_SHOWN = ("id", "exercise", "learner", "ordinal", "is_late", "max_points")


def _share(done: tuple[ListedAttempt, float]) -> float:
    attempt, _ = done
    return attempt.earned / attempt.max_points if attempt.max_points else 0.0


def _whole_share(done: tuple[ListedAttempt, float]) -> float:
    """Return the share of an attempt's points before a deduction for lateness."""
    attempt, worth = done
    if attempt.awarded is not None or not worth:
        return _share(done)
    return _share(done) / worth


def _is_full(done: list[tuple[ListedAttempt, float]]) -> bool:
    return any(_whole_share(each) >= _FULL for each in done)
