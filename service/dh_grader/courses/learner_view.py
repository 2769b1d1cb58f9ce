"""The courses and assignments of one learner, as the learner sees them."""

import json
import logging
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from datetime import datetime
from functools import cache
from itertools import groupby

from sqlalchemy import Connection, case, or_, select

from dh_grader.catalogue import Exercise, in_language
from dh_grader.contract.courses import OwnAssignment, OwnAttempt, OwnCourse, OwnCourses, OwnExercise
from dh_grader.courses import local
from dh_grader.courses.assignments import LearnerTerms, learner_terms, own_variant
from dh_grader.store import ListedAttempt, points_after
from dh_grader.store.attempts import hints_of
from dh_grader.store.results import LISTED
from dh_grader.store.tables import attempts, course_learners, courses
from dh_grader.translations import ENGLISH, Language

_log = logging.getLogger("uvicorn.error")
# Full marks, but for rounding.
_FULL = 1 - 1e-9


@dataclass(frozen=True, slots=True)
class _Done:
    attempt: ListedAttempt
    report_points: float

    @property
    def share(self) -> float:
        return self._share(self.attempt.earned)

    @property
    def whole_share(self) -> float:
        # The share of the points before a deduction for lateness.
        done = self.attempt
        if done.awarded is not None:
            return self.share
        return self._share(
            points_after(self.report_points, done.max_points, done.hint_price, worth=1.0)
        )

    @property
    def report_share(self) -> float:
        return self.share if self.attempt.awarded is not None else self._share(self.report_points)

    def _share(self, points: float) -> float:
        return points / self.attempt.max_points if self.attempt.max_points else 0.0


# The attempts of a learner by the numbers of their assignments and by exercise, oldest first.
_Attempts = Mapping[tuple[int, str], list[_Done]]


def own_view(
    connection: Connection,
    learner: str,
    only: str | None,
    catalogue: Mapping[str, Exercise],
    now: datetime,
    language: Language = ENGLISH,
) -> OwnCourses:
    """Return the courses of a learner; ``only`` restricts the result to one course."""
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

    taken = hints_of(connection, learner)

    def own(terms: LearnerTerms) -> list[OwnExercise]:
        found = []
        for name in terms.exercises:
            exercise = catalogue.get(name)
            if exercise is None:
                _log_missing(terms.id, name)
            else:
                exercise = own_variant(connection, terms, learner, exercise)
                exercise = in_language(exercise, language)
            place = (terms.number, name)
            state = _exercise(name, exercise, terms, done.get(place, []), now)
            found.append(state.model_copy(update={"hints": taken.get(place, [])}))
        return found

    return OwnCourses(
        learner=learner,
        now=now,
        courses=[
            OwnCourse(
                **row._mapping,
                assignments=[_assignment(each, own(each), now) for each in terms.get(row.id, ())],
            )
            for row in rows
        ],
    )


@cache  # Learners ask often: once is enough.
def _log_missing(assignment: str, exercise: str) -> None:
    _log.warning(
        "The assignment %s sets the exercise %s, which this service does not have. "
        "If its file is new, restart the service.",
        assignment,
        exercise,
    )


def closed_practice(
    connection: Connection,
    learner: str,
    only: str | None,
    exercise: str,
    alike: Collection[str],
    now: datetime,
) -> tuple[LearnerTerms, str] | None:
    """Return an assignment that forbids practice now, and the exercise's name in it; or None.

    ``alike`` are the exercises with the same correct table as ``exercise``.
    """
    # If no assignment has the exercise itself, assignments with one of ``alike`` decide.
    for terms, name in _assigned(connection, learner, only, exercise, alike):
        full = terms.practice == "after" and has_full_marks(connection, learner, terms.number, name)
        if not terms.may_practise(now, is_full=full):
            return terms, name
    return None


def hides_solution(
    connection: Connection,
    learner: str,
    only: str | None,
    exercise: str,
    alike: Collection[str],
    now: datetime,
) -> bool:
    """True if an assignment hides the solution of the exercise from the learner now.

    ``alike`` are the exercises with the same correct table as ``exercise``.
    """
    return any(
        not terms.shows_solution(
            now, is_full=has_full_marks(connection, learner, terms.number, name)
        )
        for terms, name in _assigned(connection, learner, only, exercise, alike)
    )


def _assigned(
    connection: Connection, learner: str, only: str | None, exercise: str, alike: Collection[str]
) -> list[tuple[LearnerTerms, str]]:
    # The assignments of the exercise, or if there are none, of the exercises ``alike``.
    found = [terms for _, terms in learner_terms(connection, learner, only)]
    own = [(terms, exercise) for terms in found if exercise in terms.exercises]
    return own or [(terms, name) for terms in found for name in terms.exercises if name in alike]


def has_priced_hints(
    connection: Connection,
    learner: str,
    only: str | None,
    exercise: Exercise,
    alike: Collection[str],
    now: datetime,
) -> bool:
    """True if hints on the exercise have a price in an open assignment of the learner.

    ``alike`` are the exercises with the same correct table as ``exercise``.
    """
    return any(
        terms.hint_prices(exercise) is not None and terms.state(now) in ("open", "late")
        for terms, _ in _assigned(connection, learner, only, exercise.plain_id, alike)
    )


def has_full_marks(connection: Connection, learner: str, number: int, exercise: str) -> bool:
    """True if an attempt of the learner has full marks before deductions."""
    return _is_full(_attempts(connection, learner).get((number, exercise), []))


def _attempts(connection: Connection, learner: str) -> _Attempts:
    found: dict[tuple[int, str], list[_Done]] = {}
    # Dividing the points by the worth would lose them if it is 0, and digits if it is small.
    is_reduced = or_(attempts.c.worth != 1, attempts.c.hint_price != 0)
    reduced = case((is_reduced, attempts.c.report))
    rows = connection.execute(
        select(*LISTED, attempts.c.assignment, reduced)
        .where(attempts.c.learner == learner, attempts.c.assignment.is_not(None))
        .order_by(attempts.c.number)
    )
    for *listed, assignment, report in rows:
        attempt = ListedAttempt(*listed)
        whole = attempt.points if report is None else float(json.loads(report)["points"])
        found.setdefault((assignment, attempt.exercise), []).append(_Done(attempt, whole))
    return found


def _assignment(terms: LearnerTerms, exercises: list[OwnExercise], now: datetime) -> OwnAssignment:
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
        exercises=exercises,
    )


def _exercise(
    name: str, exercise: Exercise | None, terms: LearnerTerms, done: list[_Done], now: datetime
) -> OwnExercise:
    counted = [
        each
        for each in done
        if each.attempt.ordinal is not None or each.attempt.awarded is not None
    ]
    best = max(counted, key=lambda it: it.share, default=None)
    points, is_full, limit = terms.exercises[name], _is_full(done), terms.rules.limit
    tried = sum(each.attempt.ordinal is not None for each in done)
    return OwnExercise(
        exercise=name,
        title=name if exercise is None else exercise.title,
        is_missing=exercise is None,
        points=points,
        earned=None if best is None else round(best.share * points, 6),
        best=max((round(each.whole_share * points, 6) for each in counted), default=None),
        attempts_left=None if limit is None else max(0, limit - tried),
        may_practise=terms.may_practise(now, is_full=is_full),
        shows_solution=terms.shows_solution(now, is_full=is_full),
        hint_prices=None if exercise is None else terms.hint_prices(exercise),
        attempts=[
            OwnAttempt(
                **{field: getattr(each.attempt, field) for field in _SHOWN},
                at=each.attempt.at.astimezone(terms.zone),
                points=each.attempt.earned,
                counts=each is best,
            )
            for each in done
        ],
    )


_SHOWN = ("id", "exercise", "learner", "ordinal", "is_late", "max_points", "hint_points")


def _is_full(done: list[_Done]) -> bool:
    return any(each.report_share >= _FULL for each in done)
