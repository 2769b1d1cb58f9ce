"""The assignments of a course: dates, limits and extensions of a learner, variants, deletion.

It decides what an assignment allows a learner; what learners have handed in is in
``gradebook.py``.
"""

import json
import secrets
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from functools import lru_cache
from typing import Any, Final
from zoneinfo import ZoneInfo

from sqlalchemy import (
    ColumnElement,
    Connection,
    Row,
    Select,
    Table,
    and_,
    bindparam,
    delete,
    func,
    insert,
    select,
    true,
    update,
)

from dh_grader.catalogue import Exercise, FeedbackLevel, least
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.contract.courses import (
    AssignmentChange,
    AssignmentState,
    CourseAssignment,
    DeletedData,
    DeletionRequest,
    Extension,
    LearnerVariant,
    NewAssignment,
    Practice,
    RemovalRequest,
    ShowSolution,
)
from dh_grader.courses import (
    CourseError,
    local,
    moment,
    own_dates,
    roll,
    unknown_assignment,
    unknown_course,
    unknown_learner,
)
from dh_grader.store import points_after
from dh_grader.store.attempts import insert_or_ignore
from dh_grader.store.database import Priority, queue_scores
from dh_grader.store.results import delete_attempts
from dh_grader.store.tables import (
    assignments,
    attempts,
    contexts,
    course_learners,
    courses,
    deals,
    extensions,
    keys,
    line_items,
    resource_links,
    scores,
)
from dh_grader.submissions.bodies import nearest
from dh_grader.translations import paragraph, say, template
from dh_grader.variants import NoVariantError, choices_of, hidden_variant, pinned, seed_of

# --- Add, change and read the assignments of a course, and the extensions of learners


def add_assignment(
    connection: Connection, course: str, new: NewAssignment, known: Collection[str]
) -> CourseAssignment:
    """Add an assignment; ``known`` are the ids of all exercises. Raises CourseError."""
    zone = _zone(connection, course)
    values = {"late_worth": 0.5, "solution": "never", "course": course, "id": new.id}
    values |= _values(new, zone, known)
    is_graded = len(new.feedback or ()) > 1
    values.setdefault("practice", "none" if new.limit or is_graded else "open")
    statement = insert_or_ignore(assignments)[connection.dialect.name].values(values)
    if not connection.execute(statement).rowcount:
        raise CourseError(
            "already-there",
            say("The course has an assignment {assignment} already.", assignment=new.id),
        )
    return _checked(connection, course, new.id)


def change_assignment(
    connection: Connection,
    course: str,
    assignment: str,
    change: AssignmentChange,
    known: Collection[str],
) -> CourseAssignment:
    """Change an assignment and return it. Raises CourseError.

    A later due date also applies to recorded attempts that were late. An earlier due date makes no
    recorded attempt late.
    """
    zone = _zone(connection, course)
    row = assignment_row(connection, course, assignment)
    values = dict(_values(change, zone, known))
    if row.variants is not None and change.variants:
        # Another secret would change the variants of all learners.
        del values["variants"], values["choices"]
    if values:
        mine = assignments.c.number == row.number
        connection.execute(update(assignments).where(mine).values(values))
    changed = _checked(connection, course, assignment)
    _excuse(connection, assignment_row(connection, course, assignment), zone)
    if change.exercises is not None:
        handed_in = attempts.c.assignment == row.number
        queue_scores(connection, handed_in, Priority.REGRADE)
    return changed


def extend(
    connection: Connection, course: str, assignment: str, extension: Extension
) -> CourseAssignment:
    """Change the dates or the limit of attempts for one learner. Raises CourseError.

    An empty extension ends the learner's extension. Attempts that are no longer late get their
    points back.
    """
    zone = _zone(connection, course)
    row = assignment_row(connection, course, assignment)
    enrolled = (course_learners.c.course == course) & (
        course_learners.c.learner == extension.learner
    )
    if connection.scalar(select(course_learners.c.learner).where(enrolled)) is None:
        raise unknown_learner(extension.learner)
    values = {
        "due": _moment(extension.due, zone),
        "closes": _moment(extension.closes, zone),
        "max_attempts": extension.limit,
    }
    if extension.closes is not None and extension.due is None and row.due is None:
        raise _closes_needs_due()
    own = (extensions.c.assignment == row.number) & (extensions.c.learner == extension.learner)
    connection.execute(delete(extensions).where(own))
    if any(each is not None for each in values.values()):
        new = {"assignment": row.number, "learner": extension.learner}
        connection.execute(insert(extensions).values(new | values))
    _excuse(connection, row, zone)
    return assignment_of(connection, course, assignment)


def assignment_of(connection: Connection, course: str, assignment: str) -> CourseAssignment:
    """Return an assignment. Raises CourseError."""
    for each in assignments_of(connection, course):
        if each.id == assignment:
            return each
    raise unknown_assignment(assignment)


def assignments_of(connection: Connection, course: str) -> list[CourseAssignment]:
    """Return the assignments of a course in the order in which they were added.

    Raises CourseError.
    """
    zone = _zone(connection, course)
    mine = assignments.c.course == course
    extensions_of: dict[int, list[Extension]] = {}
    given = select(extensions).join_from(extensions, assignments).where(mine)
    for row in connection.execute(given.order_by(extensions.c.learner)):
        extension = Extension(
            learner=row.learner,
            due=local(row.due, zone),
            closes=local(row.closes, zone),
            limit=row.max_attempts,
        )
        extensions_of.setdefault(row.assignment, []).append(extension)
    rows = connection.execute(select(assignments).where(mine).order_by(assignments.c.number))
    return [
        CourseAssignment(
            id=row.id,
            title=row.title,
            opens=local(row.opens, zone),
            due=local(row.due, zone),
            closes=local(row.closes, zone),
            late_worth=row.late_worth,
            exercises=json.loads(row.exercises),
            limit=row.max_attempts,
            feedback=None if row.feedback is None else json.loads(row.feedback),
            practice=row.practice,
            solution=row.solution,
            variants=row.variants is not None,
            hint_prices=None if row.hint_prices is None else json.loads(row.hint_prices),
            extensions=extensions_of.get(row.number, []),
        )
        for row in rows
    ]


def assignment_row(connection: Connection, course: str, assignment: str) -> Row[Any]:
    """Return the row of an assignment. Raises CourseError."""
    mine = (assignments.c.course == course) & (assignments.c.id == assignment)
    found = connection.execute(select(assignments).where(mine)).one_or_none()
    if found is None:
        raise unknown_assignment(assignment)
    return found


def _zone(connection: Connection, course: str) -> ZoneInfo:
    return ZoneInfo(roll.course(connection, course).zone)


def _moment(written: datetime | None, zone: ZoneInfo) -> datetime | None:
    return None if written is None else moment(written, zone)


def _values(change: AssignmentChange, zone: ZoneInfo, known: Collection[str]) -> Mapping[str, Any]:
    given = change.model_dump(mode="python", exclude_unset=True, exclude={"id", "renew_variants"})
    values: dict[str, Any] = {}
    for name, value in given.items():
        match name:
            case "opens" | "due" | "closes":
                values[name] = _moment(value, zone)
            case "limit":
                values["max_attempts"] = value
            case "feedback" | "hint_prices":
                values[name] = None if value is None else json.dumps(value)
            case "variants" if value is not None:
                values[name] = secrets.token_hex(32) if value else None
                values["choices"] = None
            case "exercises" if value is not None:
                _check_exercises([each["exercise"] for each in value], known)
                values[name] = json.dumps(value)
            case _ if value is not None:
                values[name] = value
    return values


def _check_exercises(chosen: list[str], known: Collection[str]) -> None:
    for i, exercise in enumerate(chosen):
        if exercise not in known:
            meant = nearest(exercise, known)
            message = paragraph(
                say("There is no exercise {exercise}.", exercise=exercise),
                say("Did you mean {meant}?", meant=meant) if meant else "",
                say(
                    "A new file must be in a folder of DH_GRADER_EXERCISES_DIR. The service reads "
                    "it when it starts, or at once with DH_GRADER_RELOAD_EXERCISES=true."
                ),
            )
            raise CourseError("unusable", message)
        if exercise in chosen[:i]:
            raise CourseError(
                "unusable", say("The exercise {exercise} is there twice.", exercise=exercise)
            )


def _checked(connection: Connection, course: str, assignment: str) -> CourseAssignment:
    found = assignment_of(connection, course, assignment)
    if found.closes is not None and found.due is None:
        raise _closes_needs_due()
    moments = [each for each in (found.opens, found.due, found.closes) if each is not None]
    if moments != sorted(moments):
        order = say("opens, due and closes must follow each other in this order")
        raise CourseError("unusable", order)
    return found


def _closes_needs_due() -> CourseError:
    message = say("closes says how long late attempts are taken: it needs due")
    return CourseError("unusable", message)


def _excuse(connection: Connection, row: Row[Any], zone: ZoneInfo) -> None:
    # Restore the points of attempts that were late, and are in time by the current dates.
    named = ("number", "learner", "at", "report", "max_points", "hint_price")
    late = select(*(attempts.c[name] for name in named)).where(
        attempts.c.assignment == row.number, attempts.c.is_late
    )
    given = select(extensions).where(extensions.c.assignment == row.number)
    own = {each.learner: each for each in connection.execute(given)}
    excused = []
    for attempt in connection.execute(late).all():
        mine = own.get(attempt.learner)
        due = extended(row, zone, None if mine is None else mine.due).due
        if due is None or attempt.at <= due:
            points = json.loads(attempt.report)["points"]
            points = points_after(points, attempt.max_points, attempt.hint_price, 1.0)
            connection.execute(
                update(attempts)
                .where(attempts.c.number == attempt.number)
                .values(is_late=False, worth=1.0, points=points)
            )
            excused.append(attempt.number)
    if excused:
        queue_scores(connection, attempts.c.number.in_(excused))


# --- The rules of an assignment for one learner: dates, limit, feedback, practice and solution


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

    ``number`` is the row number of the assignment. ``exercises`` has the points of each exercise.
    ``variants`` is the secret that determines the learners' variants, or None. ``choices`` says
    what the variants may vary, as JSON; None if the exercise files define this.
    """

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
        """The highest feedback level for the attempt with this number that the exercise allows."""
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
    """Yield the course and the rules of each assignment of a learner, as they were added.

    ``only`` restricts the result to one course.
    """
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


# --- Choose the variant of an exercise for each learner in an assignment
#
# A secret of the assignment determines the variants, so that learners cannot guess them.


# The most deals that are tried until the seed is another one.
_TRIES: Final = 1000


def assigned(
    connection: Connection, course: str, assignment: str, learner: str, exercise: Exercise
) -> tuple[LearnerTerms, Exercise]:
    """Return an assignment's rules for a learner, and the learner's variant of the exercise.

    Raises CourseError.
    """
    terms, own, seed = assigned_seed(connection, course, assignment, learner, exercise)
    return terms, variant_for(own, seed)


def variant_for(exercise: Exercise, seed: str | None) -> Exercise:
    """Return the variant with this seed, or the exercise if ``seed`` is None.

    The variant has the id of the plain exercise. Raises CourseError, whose message does not have
    the seed.
    """
    if seed is None:
        return exercise
    try:
        return hidden_variant(exercise, seed)
    except NoVariantError:
        message = say(
            "Your variant of the exercise {exercise} cannot be made, because its file has a fault. "
            "Ask your tutor for another one.",
            exercise=exercise.plain_id,
        )
        raise CourseError("unusable", message) from None


def assigned_seed(
    connection: Connection, course: str, assignment: str, learner: str, exercise: Exercise
) -> tuple[LearnerTerms, Exercise, str | None]:
    """Return three things: the rules of an assignment for a learner, the exercise, and the seed.

    In the exercise, ``[vary]`` has the choices of the assignment. The seed determines the learner's
    variant, and is None if there are no variants. Raises CourseError.
    """
    terms = terms_of(connection, course, assignment, learner)
    if exercise.id not in terms.exercises:
        message = say(
            "The exercise {exercise} is not part of the assignment {assignment}.",
            exercise=exercise.id,
            assignment=assignment,
        )
        raise CourseError("not-assigned", message)
    own = pinned(exercise, terms.choices)
    return terms, own, _dealt_seed(connection, terms, learner, own)


def own_variant(
    connection: Connection, terms: LearnerTerms, learner: str, exercise: Exercise
) -> Exercise:
    """Return the learner's variant of an exercise, or the exercise if none can be made.

    The variant has the id of the plain exercise.
    """
    own = pinned(exercise, terms.choices)
    seed = _dealt_seed(connection, terms, learner, own)
    try:
        return exercise if seed is None else variant_for(own, seed)
    except CourseError:
        return exercise


def learner_variants(
    connection: Connection,
    course: str,
    assignment: str,
    learner: str,
    catalogue: Mapping[str, Exercise],
) -> list[LearnerVariant]:
    """Return the variants of a learner in an assignment, for tutors. Raises CourseError."""
    terms = terms_of(connection, course, assignment, learner)
    found = []
    for name in terms.exercises:
        if name not in catalogue:
            continue
        exercise = catalogue[name]
        own = pinned(exercise, terms.choices)
        seed = _dealt_seed(connection, terms, learner, own)
        if seed is not None:
            deal = _number(connection, terms, learner, name) or 0
            found.append(_told(exercise, own, seed, deal))
    return found


def deal_again(
    connection: Connection, course: str, assignment: str, learner: str, exercise: Exercise
) -> LearnerVariant:
    """Give a learner another variant of an exercise. Raises CourseError."""
    terms, own, _ = assigned_seed(connection, course, assignment, learner, exercise)
    if terms.variants is None or own.vary is None:
        reason = say(
            "The assignment {assignment} has no variants of {exercise}.",
            assignment=assignment,
            exercise=exercise.id,
        )
        raise CourseError("unusable", reason)
    dealt = _number(connection, terms, learner, exercise.id)
    before = seed_of(
        terms.variants, learner, exercise.id, dealt or 0, deployed := own.vary.deployed
    )
    for number in range((dealt or 0) + 1, (dealt or 0) + _TRIES):
        seed = seed_of(terms.variants, learner, exercise.id, number, deployed)
        if seed != before:
            break
    else:
        reason = say("There is no other deployed variant of {exercise}.", exercise=exercise.id)
        raise CourseError("unusable", reason)
    mine = {"assignment": terms.number, "learner": learner, "exercise": exercise.id}
    if dealt is None:
        connection.execute(insert(deals).values(mine | {"number": number}))
    else:
        its = [deals.c[name] == value for name, value in mine.items()]
        connection.execute(update(deals).where(*its).values(number=number))
    return _told(exercise, own, seed, number)


def needs_choices(terms: LearnerTerms, exercise: Exercise) -> bool:
    """True if the rules by which the exercise varies are not stored in the assignment yet.

    This is so if an earlier version of the program made the assignment, or if the exercise got
    variants later.
    """
    if terms.variants is None or exercise.vary is None:
        return False
    return terms.choices is None or exercise.id not in json.loads(terms.choices)


def pin_choices(
    connection: Connection,
    course: str,
    assignment: str,
    catalogue: Mapping[str, Exercise],
    *,
    renew: bool = False,
) -> None:
    """Store the rules by which the exercises of an assignment vary. Raises CourseError.

    Rules that are stored already stay, unless ``renew`` is True, so a changed exercise file changes
    no variant.
    """
    row = assignment_row(connection, course, assignment)
    if row.variants is None:
        return
    exercises = {
        each["exercise"]: catalogue[each["exercise"]]
        for each in json.loads(row.exercises)
        if each["exercise"] in catalogue
    }
    kept = {} if renew or row.choices is None else json.loads(row.choices)
    written = json.dumps({**choices_of(exercises), **kept})
    if written != row.choices:
        mine = assignments.c.number == row.number
        connection.execute(update(assignments).where(mine).values(choices=written))


def _told(exercise: Exercise, own: Exercise, seed: str, deal: int) -> LearnerVariant:
    assert exercise.vary is not None
    assert own.vary is not None
    values = own.vary.written(seed)
    return LearnerVariant(
        exercise=exercise.id,
        variant=f"{exercise.id}~{seed}",
        seed=seed,
        deals=deal + 1,
        values=None if exercise.vary.written(seed) == values else dict(values),
    )


def _dealt_seed(
    connection: Connection, terms: LearnerTerms, learner: str, exercise: Exercise
) -> str | None:
    if terms.variants is None or exercise.vary is None:
        return None
    number = _number(connection, terms, learner, exercise.id) or 0
    return seed_of(terms.variants, learner, exercise.id, number, exercise.vary.deployed)


def _number(connection: Connection, terms: LearnerTerms, learner: str, exercise: str) -> int | None:
    return connection.scalar(
        select(deals.c.number).where(
            deals.c.assignment == terms.number,
            deals.c.learner == learner,
            deals.c.exercise == exercise,
        )
    )


# --- Delete courses and assignments, and remove learners


_COURSE_HAS_ATTEMPTS = template(
    "The course {name} has {count} recorded attempts. Delete them, too: with_attempts."
)
_ASSIGNMENT_HAS_ATTEMPTS = template(
    "The assignment {name} has {count} recorded attempts. Delete them, too: with_attempts."
)


def delete_course(
    connection: Connection, course: str, wanted: DeletionRequest, now: datetime
) -> DeletedData:
    """Delete a course with its assignments, and end its keys and links. Raises CourseError."""
    roll.course(connection, course)
    mine = _assignments(connection, course, true())
    ending = (keys.c.course == course) & keys.c.revoked_at.is_(None)
    enrolled = course_learners.c.course == course
    data = DeletedData(
        deleted=wanted.apply,
        assignments=_count(connection, assignments, assignments.c.course == course),
        learners=_count(connection, course_learners, enrolled),
        extensions=_count(connection, extensions, extensions.c.assignment.in_(mine)),
        keys=_count(connection, keys, ending & (keys.c.expires_at > now)),
        attempts=_count(connection, attempts, attempts.c.assignment.in_(mine)),
    )
    if wanted.apply:
        _require_none(data, wanted, _COURSE_HAS_ATTEMPTS, course)
        _delete_assignments(connection, mine)
        # The next launch from there makes a new course.
        of_course = select(contexts.c.number).where(contexts.c.course == course)
        connection.execute(delete(resource_links).where(resource_links.c.context.in_(of_course)))
        connection.execute(delete(contexts).where(contexts.c.course == course))
        connection.execute(delete(course_learners).where(enrolled))
        connection.execute(update(keys).where(ending).values(revoked_at=now))
        connection.execute(delete(courses).where(courses.c.id == course))
    return data


def delete_assignment(
    connection: Connection, course: str, assignment: str, wanted: DeletionRequest
) -> DeletedData:
    """Delete an assignment with its extensions. Raises CourseError."""
    assignment_of(connection, course, assignment)
    mine = _assignments(connection, course, assignments.c.id == assignment)
    data = DeletedData(
        deleted=wanted.apply,
        assignments=1,
        learners=0,
        extensions=_count(connection, extensions, extensions.c.assignment.in_(mine)),
        keys=0,
        attempts=_count(connection, attempts, attempts.c.assignment.in_(mine)),
    )
    if wanted.apply:
        _require_none(data, wanted, _ASSIGNMENT_HAS_ATTEMPTS, assignment)
        _delete_assignments(connection, mine)
    return data


def remove_learner(
    connection: Connection, course: str, wanted: RemovalRequest, now: datetime
) -> DeletedData:
    """Remove a learner from a course. Raises CourseError.

    Without ``with_attempts`` the learner's attempts stay, and count again if the learner comes
    back.
    """
    learner = wanted.learner
    if learner not in {each.learner for each in roll.people(connection, course)}:
        raise unknown_learner(learner)
    mine = _assignments(connection, course, true())
    ending = (keys.c.course == course) & (keys.c.learner == learner) & keys.c.revoked_at.is_(None)
    extended = extensions.c.assignment.in_(mine) & (extensions.c.learner == learner)
    handed_in = attempts.c.assignment.in_(mine) & (attempts.c.learner == learner)
    data = DeletedData(
        deleted=wanted.apply,
        assignments=0,
        learners=1,
        extensions=_count(connection, extensions, extended),
        keys=_count(connection, keys, ending & (keys.c.expires_at > now)),
        attempts=_count(connection, attempts, handed_in),
    )
    if wanted.apply:
        if wanted.with_attempts:
            queue_scores(connection, handed_in)
            delete_attempts(connection, handed_in)
            dealt = deals.c.assignment.in_(mine) & (deals.c.learner == learner)
            connection.execute(delete(deals).where(dealt))
        connection.execute(delete(extensions).where(extended))
        connection.execute(update(keys).where(ending).values(revoked_at=now))
        enrolled = (course_learners.c.course == course) & (course_learners.c.learner == learner)
        connection.execute(delete(course_learners).where(enrolled))
    return data


def _assignments(
    connection: Connection, course: str, chosen: ColumnElement[bool]
) -> Select[tuple[int]]:
    # Nobody can hand in at these assignments until the transaction ends, because they are locked.
    mine = select(assignments.c.number).where(assignments.c.course == course, chosen)
    connection.execute(mine.with_for_update()).all()
    return mine


def _delete_assignments(connection: Connection, numbers: Select[tuple[int]]) -> None:
    delete_attempts(connection, attempts.c.assignment.in_(numbers))
    # What platforms know already stays in their gradebooks.
    items = select(line_items.c.number).where(line_items.c.assignment.in_(numbers))
    connection.execute(delete(scores).where(scores.c.line_item.in_(items)))
    connection.execute(delete(line_items).where(line_items.c.assignment.in_(numbers)))
    linked = resource_links.c.assignment.in_(numbers)
    connection.execute(update(resource_links).where(linked).values(assignment=None))
    for table in (extensions, deals):
        connection.execute(delete(table).where(table.c.assignment.in_(numbers)))
    connection.execute(delete(assignments).where(assignments.c.number.in_(numbers)))


def _require_none(data: DeletedData, wanted: DeletionRequest, told: str, name: str) -> None:
    if data.attempts and not wanted.with_attempts:
        raise CourseError("has-attempts", say(told, name=name, count=data.attempts))


def _count(connection: Connection, table: Table, condition: ColumnElement[bool]) -> int:
    return connection.scalar(select(func.count()).select_from(table).where(condition)) or 0
