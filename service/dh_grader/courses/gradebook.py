"""The results of a course: the gradebook for tutors, and what one learner sees and may do.

It reads the recorded attempts; the rules of assignments are in ``assignments.py``.
"""

import io
import json
import logging
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime
from functools import cache
from itertools import groupby
from typing import Any, Final, NamedTuple
from zoneinfo import ZoneInfo

from sqlalchemy import (
    JSON,
    ColumnElement,
    Connection,
    case,
    func,
    or_,
    select,
    text,
    true,
    type_coerce,
)

from dh_grader.catalogue import Exercise, in_language
from dh_grader.contract.courses import (
    CourseAssignment,
    Extension,
    Gradebook,
    GradebookColumn,
    GradebookFormat,
    GradebookRow,
    MissingLearner,
    OwnAssignment,
    OwnAttempt,
    OwnCourse,
    OwnCourses,
    OwnExercise,
)
from dh_grader.courses import local, own_dates, roll
from dh_grader.courses.assignments import (
    LearnerTerms,
    assignment_of,
    assignments_of,
    learner_terms,
    own_variant,
)
from dh_grader.formats import texts
from dh_grader.formats.texts import visible
from dh_grader.store import ListedAttempt, points_after
from dh_grader.store.attempts import hints_of
from dh_grader.store.results import LISTED
from dh_grader.store.tables import assignments, attempts, course_learners, courses
from dh_grader.translations import ENGLISH, Language

# --- The gradebook of a course, and the learners who have not handed in


# The points of an attempt that count, as a share of 1.
SHARE = func.coalesce(attempts.c.awarded, attempts.c.points) / func.nullif(attempts.c.max_points, 0)

# The attempts that count: those in which something could be read, or that a tutor has given points.
COUNTS = or_(attempts.c.ordinal.is_not(None), attempts.c.awarded.is_not(None))

# A learner, an assignment and an exercise.
GradebookPlace = tuple[str, str, str]

# The aggregate that makes a list, by the name of the SQL dialect.
_TOGETHER: Final[Mapping[str, Callable[[ColumnElement[Any]], ColumnElement[Any]]]] = {
    "postgresql": func.array_agg,
    "sqlite": lambda column: type_coerce(func.json_group_array(column), JSON),
}
# The index of a gradebook has the order of its groups. Without statistics, as in a database that
# was filled a moment ago, PostgreSQL would hash and sort all rows instead, on the disk.
_IN_ORDER: Final = text(
    "SELECT set_config('enable_hashagg', 'off', true), set_config('enable_sort', 'off', true)"
)


def gradebook(connection: Connection, course: str, assignment: str | None = None) -> Gradebook:
    """Return the gradebook of a course, or of one assignment. Raises CourseError."""
    chosen = _chosen(connection, course, assignment)
    columns = [
        GradebookColumn(assignment=each.id, exercise=one.exercise, points=one.points)
        for each in chosen
        for one in each.exercises
    ]
    place_of = {(each.assignment, each.exercise): i for i, each in enumerate(columns)}
    persons = roll.people(connection, course)
    points_of: dict[str, list[float | None]] = {
        each.learner: [None] * len(columns) for each in persons
    }
    for learner, name, exercise, share in _shares(connection, course, assignment):
        place = place_of.get((name, exercise))
        points = points_of.get(learner)
        if place is not None and points is not None:
            points[place] = round((share or 0.0) * columns[place].points, 6)
    rows = []
    for person in persons:
        points = points_of[person.learner]
        total = round(sum(filter(None, points)), 6)
        rows.append(GradebookRow.model_construct(**person._mapping, points=points, total=total))
    return Gradebook.model_construct(course=course, columns=columns, rows=rows)


def missing(connection: Connection, course: str, assignment: str) -> list[MissingLearner]:
    """Return the learners who have not handed in all assigned exercises. Raises CourseError."""
    [chosen] = _chosen(connection, course, assignment)
    present = {
        (learner, exercise) for learner, _, exercise, _ in _shares(connection, course, assignment)
    }
    extension_of = {each.learner: each for each in chosen.extensions}
    found = []
    for person in roll.people(connection, course):
        absent = [
            each.exercise
            for each in chosen.exercises
            if (person.learner, each.exercise) not in present
        ]
        if absent:
            own = extension_of.get(person.learner) or Extension(learner=person.learner)
            due, closes = own_dates(chosen, own.due, own.closes)
            found.append(
                MissingLearner(**person._mapping, exercises=absent, due=due, closes=closes)
            )
    return found


def handed_in(connection: Connection, course: str) -> dict[str, int]:
    """Return the number of learners who have handed in, by assignment."""
    rows = connection.execute(
        select(assignments.c.id, func.count(attempts.c.learner.distinct()).label("number"))
        .join_from(attempts, assignments)
        .where(assignments.c.course == course, COUNTS)
        .group_by(assignments.c.id)
    )
    return {row.id: row.number for row in rows}


def written_gradebook(book: Gradebook, form: GradebookFormat) -> Iterator[bytes]:
    """Yield the lines of a gradebook as CSV, with the headings that a platform imports."""
    # Canvas finds learners by the SIS Login ID. Moodle finds them by the ID number or the e-mail
    # address. Source: Canvas, "How do I import grades in the Gradebook?"; Moodle, "Grade import".
    titles = [f"{each.assignment} {each.exercise}" for each in book.columns]
    match form:
        case "canvas":
            head = ("Student", "ID", "SIS User ID", "SIS Login ID", "Section")
            yield texts.line((*head, *titles))
            possible = (each.points for each in book.columns)
            yield texts.line(("    Points Possible", "", "", "", "", *possible))
        case "moodle":
            yield texts.line(("ID number", "Full name", "Email address", *titles))
        case _:
            yield texts.line(("learner", "name", "email", *titles, "total"))
    for row in book.rows:
        match form:
            case "canvas":
                yield texts.line((row.name, "", "", row.learner, "", *row.points))
            case "moodle":
                yield texts.line((row.learner, row.name, row.email, *row.points))
            case _:
                yield texts.line((row.learner, row.name, row.email, *row.points, row.total))


def _chosen(connection: Connection, course: str, assignment: str | None) -> list[CourseAssignment]:
    if assignment is not None:
        return [assignment_of(connection, course, assignment)]
    return assignments_of(connection, course)


def _shares(
    connection: Connection, course: str, assignment: str | None
) -> Iterator[tuple[str, str, str, float | None]]:
    # Exercises without an attempt that counts are left out.
    chosen = select(assignments.c.number, assignments.c.id).where(
        assignments.c.course == course,
        true() if assignment is None else assignments.c.id == assignment,
    )
    names = {row.number: row.id for row in connection.execute(chosen)}
    of = attempts.c
    share = func.max(SHARE).label("share")
    best = (
        select(of.assignment, of.learner, of.exercise, share)
        .where(
            of.assignment.in_(names),
            of.assignment.is_not(None),
            COUNTS,
        )
        .group_by(of.assignment, of.learner, of.exercise)
        .subquery()
    ).c
    if connection.dialect.name == "postgresql":
        connection.execute(_IN_ORDER)
    # One row for each assignment: a row for each exercise takes three times as long.
    together = _TOGETHER[connection.dialect.name]
    lists = (together(best[name]) for name in ("learner", "exercise", "share"))
    rows = connection.execute(select(best.assignment, *lists).group_by(best.assignment)).all()
    return (
        (learner, names[number], exercise, share)
        for number, *found in rows
        for learner, exercise, share in zip(*found, strict=True)
    )


# --- The gradebook as a workbook (Office Open XML)
#
# No text in the workbook becomes a formula.


_PEOPLE: Final = ("learner", "name", "email")
_WIDTHS: Final = (14, 28, 30)


class HandIns(NamedTuple):
    """The number of a learner's counted attempts at an exercise, and the time of the last one."""

    number: int
    last: datetime


def gradebook_workbook(connection: Connection, course: str, assignment: str | None = None) -> bytes:
    """Return the gradebook of a course as a workbook. Raises CourseError.

    The first sheet has the points; the second has the numbers and times of attempts.
    """
    zone = ZoneInfo(roll.course(connection, course).zone)
    book = gradebook(connection, course, assignment)
    return _written(book, _hand_ins(connection, course, assignment), zone)


def _hand_ins(
    connection: Connection, course: str, assignment: str | None
) -> Mapping[GradebookPlace, HandIns]:
    of = attempts.c
    place = (of.learner, assignments.c.id, of.exercise)
    chosen = true() if assignment is None else assignments.c.id == assignment
    rows = connection.execute(
        select(*place, func.count(), func.max(of.at))
        .join_from(attempts, assignments)
        .where(assignments.c.course == course, chosen, of.assignment.is_not(None), COUNTS)
        .group_by(*place)
    )
    return {(learner, name, exercise): HandIns(*found) for learner, name, exercise, *found in rows}


def _written(book: Gradebook, hand_ins: Mapping[GradebookPlace, HandIns], zone: ZoneInfo) -> bytes:
    # Imported here, because only this format needs it.
    from xlsxwriter import Workbook

    written = io.BytesIO()
    with Workbook(written, {"in_memory": True, "remove_timezone": True}) as file:
        bold = file.add_format({"bold": True})
        date = file.add_format({"num_format": "yyyy-mm-dd hh:mm"})
        titles = [f"{each.assignment} {each.exercise}" for each in book.columns]
        points = file.add_worksheet("Points")
        _head(points, [*titles, "total"], bold)
        counts = file.add_worksheet("Hand-ins")
        both = (f"{title}{what}" for title in titles for what in ("", ", last hand-in"))
        _head(counts, list(both), bold)
        for i, row in enumerate(book.rows, start=1):
            for sheet in (points, counts):
                for j, text in enumerate((row.learner, row.name, row.email)):
                    if text:
                        # Another method would make formulas and links of some texts.
                        sheet.write_string(i, j, visible(text))
            for j, value in enumerate((*row.points, row.total), start=len(_PEOPLE)):
                if value is not None:
                    points.write_number(i, j, value)
            for j, each in enumerate(book.columns):
                found = hand_ins.get((row.learner, each.assignment, each.exercise))
                if found is not None:
                    place = len(_PEOPLE) + 2 * j
                    counts.write_number(i, place, found.number)
                    counts.write_datetime(i, place + 1, found.last.astimezone(zone), date)
    return written.getvalue()


def _head(sheet: Any, titles: list[str], bold: Any) -> None:
    for i, title in enumerate((*_PEOPLE, *titles)):
        sheet.write_string(0, i, visible(title), bold)
        sheet.set_column(i, i, _WIDTHS[i] if i < len(_WIDTHS) else max(12, len(title)))
    sheet.freeze_panes(1, len(_PEOPLE))


# --- What one learner sees of the courses


_log = logging.getLogger("uvicorn.error")
# Full marks, but for rounding.
_FULL: Final = 1 - 1e-9
# What a learner sees of an attempt.
_SHOWN: Final = ("id", "exercise", "learner", "ordinal", "is_late", "max_points", "hint_points")


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


@cache  # Learners ask often: once is enough.
def _log_missing(assignment: str, exercise: str) -> None:
    _log.warning(
        "The assignment %s sets the exercise %s, which this service does not have. "
        "If its file is new, restart the service.",
        assignment,
        exercise,
    )


# --- What the assignments of one learner allow now: practice, solutions, free hints


def closed_practice(
    connection: Connection,
    learner: str,
    only: str | None,
    exercise: str,
    alike: Collection[str],
    now: datetime,
) -> tuple[LearnerTerms, str] | None:
    """Return an assignment that forbids practice now, and the exercise's name in it; or None.

    ``alike`` are the exercises with the same correct table as ``exercise``. Assignments with one of
    them decide if no assignment has the exercise itself.
    """
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


def _assigned(
    connection: Connection, learner: str, only: str | None, exercise: str, alike: Collection[str]
) -> list[tuple[LearnerTerms, str]]:
    # The assignments of the exercise, or if there are none, of the exercises ``alike``.
    found = [terms for _, terms in learner_terms(connection, learner, only)]
    own = [(terms, exercise) for terms in found if exercise in terms.exercises]
    return own or [(terms, name) for terms in found for name in terms.exercises if name in alike]


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


def _is_full(done: list[_Done]) -> bool:
    return any(each.report_share >= _FULL for each in done)
