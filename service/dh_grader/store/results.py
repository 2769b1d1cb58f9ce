"""What is read from recorded attempts: grades, lists, statistics, and one learner's data.

It also changes what tutors change: points, and whose data are deleted. Attempts are recorded in
``attempts.py``, and regraded in ``regrades.py``.
"""

import json
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from itertools import groupby
from typing import Any, Final, Literal, TypeAlias

from sqlalchemy import (
    ColumnElement,
    Connection,
    Result,
    Row,
    String,
    Table,
    Tuple,
    and_,
    bindparam,
    cast,
    delete,
    exists,
    func,
    insert,
    literal,
    or_,
    select,
    tuple_,
    type_coerce,
    update,
)
from sqlalchemy.exc import IntegrityError

from dh_grader.catalogue import Exercise
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.contract import (
    CellFigures,
    ExerciseStatistics,
    IdenticalAnswers,
    MisconceptionFigures,
    PartFigures,
    RowFigures,
    ShareCorrect,
    TakenHint,
)
from dh_grader.formats import texts
from dh_grader.grading import Verdict
from dh_grader.grading.report import combined
from dh_grader.regex import regex
from dh_grader.statistics import Share
from dh_grader.store import (
    AttemptFilter,
    BadCursorError,
    GradesFormat,
    ListedAttempt,
    UnknownAttemptError,
    UnusablePointsError,
    sentence_in,
    shown_report,
    tables,
)
from dh_grader.store.attempts import hint_figures, hints_before
from dh_grader.store.database import forget_scores, queue_scores
from dh_grader.store.tables import (
    UtcTime,
    assignments,
    attempts,
    course_learners,
    deals,
    earlier_reports,
    extensions,
    hints,
    keys,
    outcomes,
    overrides,
    regrade_queue,
)
from dh_grader.translations import ENGLISH, say

# --- Choose the attempts that count, and export attempts for other programs


Counting = Literal["best", "last"]

# The attempts that are read at once. An export of them takes about two milliseconds.
_PAGE: Final = 100


def counting_rules(exercises: Mapping[str, Exercise]) -> Callable[[str], Counting]:
    """Return a function that takes an exercise's id and returns its rule, "best" or "last".

    The rule chooses the attempt that counts for a learner.
    """

    def rule(exercise_id: str) -> Counting:
        exercise = exercises.get(exercise_id)
        return (AttemptsSpec() if exercise is None else exercise.attempts).counts

    return rule


@dataclass(frozen=True, slots=True)
class GradedAttempt:
    """An attempt; ``counts`` is True if it is the attempt that counts for the learner."""

    attempt: ListedAttempt
    counts: bool


def graded_attempts(
    connection: Connection,
    wanted: AttemptFilter,
    counting: Callable[[str], Counting],
    pause: Callable[[], None] = lambda: None,
) -> Iterator[GradedAttempt]:
    """Yield the wanted attempts, sorted by exercise, learner and time.

    ``counting`` takes the id of an exercise and returns the rule for the attempt that counts.
    ``pause`` is called after each page of attempts.
    """
    ordered = (
        select(*LISTED)
        .where(condition(wanted))
        .order_by(attempts.c.exercise, attempts.c.learner, attempts.c.at, attempts.c.number)
        .execution_options(yield_per=_PAGE)
    )
    found = _paged(connection.execute(ordered), pause)
    for (exercise, _), group in groupby(found, lambda each: (each.exercise, each.learner)):
        of_learner = list(group)
        chosen = _counting_attempt(of_learner, counting(exercise))
        yield from (GradedAttempt(each, each is chosen) for each in of_learner)


def _paged(rows: Result[Any], pause: Callable[[], None]) -> Iterator[ListedAttempt]:
    for page in rows.partitions():
        yield from (ListedAttempt(**row._mapping) for row in page)
        pause()


def _counting_attempt(of_learner: Iterable[ListedAttempt], rule: Counting) -> ListedAttempt | None:
    counted = [each for each in of_learner if each.ordinal is not None]
    if not counted:
        return None
    if rule == "last":
        return max(counted, key=lambda each: each.ordinal or 0)
    return max(counted, key=lambda each: (each.earned, -(each.ordinal or 0)))


def written(graded: Iterable[GradedAttempt], form: GradesFormat, title: str) -> Iterator[bytes]:
    """Yield the attempts in a format, line by line.

    Gradebooks (``canvas``, ``moodle``) have only the attempts that count. ``title`` is the heading
    of the points for Canvas.
    """
    match form:
        case GradesFormat.CSV:
            yield texts.line(_FIELDS)
            for each in graded:
                yield texts.line(map(_as_cell, _values(each)))
        case GradesFormat.JSONL:
            for each in graded:
                named = dict(zip(_FIELDS, _values(each), strict=True))
                known = {name: value for name, value in named.items() if value is not None}
                yield json.dumps(known, ensure_ascii=False).encode("utf-8", "replace") + b"\n"
        case GradesFormat.CANVAS:
            yield from _canvas((each.attempt for each in graded if each.counts), title)
        case GradesFormat.MOODLE:
            yield from _moodle(each.attempt for each in graded if each.counts)


_FIELDS: Final = (
    "exercise", "learner", "attempt", "ordinal", "at", "is_late", "points", "max_points",
    "report_points", "counts", "version", "grader", "variant",
)  # fmt: skip
_Value = str | float | bool | None


def _values(graded: GradedAttempt) -> tuple[_Value, ...]:
    each = graded.attempt
    return (
        each.exercise, each.learner, each.id, each.ordinal, each.at.isoformat(), each.is_late,
        each.earned, each.max_points, each.points, graded.counts, each.version, each.grader,
        each.variant,
    )  # fmt: skip


def _as_cell(value: _Value) -> str | float | None:
    return str(value).lower() if isinstance(value, bool) else value


def _canvas(counted: Iterable[ListedAttempt], title: str) -> Iterator[bytes]:
    # Source: Canvas, "How do I import grades in the Gradebook?".
    kept = list(counted)
    possible = max((each.max_points for each in kept), default=0.0)
    yield texts.line(("Student", "ID", "SIS User ID", "SIS Login ID", "Section", title))
    yield texts.line(("    Points Possible", "", "", "", "", possible))
    for each in kept:
        yield texts.line((each.learner, "", "", each.learner, "", each.earned))


def _moodle(counted: Iterable[ListedAttempt]) -> Iterator[bytes]:
    yield texts.line(texts.GRADEBOOK_HEAD)
    for each in counted:
        late = "late" if each.is_late else ""
        yield texts.line((each.learner, each.earned, each.max_points, late))


# --- Read recorded attempts: lists page by page, or one attempt with its history


LISTED: Final = [attempts.c[name] for name in ListedAttempt.__dataclass_fields__]


# The place of an attempt in time: its moment, and its number among attempts of the same moment.
TimePlace = tuple[datetime, int]


BY_TIME: Final = (attempts.c.at, attempts.c.number)


@dataclass(frozen=True, slots=True)
class AttemptHistory:
    """An attempt with all its records; ``submission`` and ``report`` are JSON.

    ``course`` is the course of the attempt's assignment, or None.
    """

    attempt: ListedAttempt
    submission: str
    report: str
    overrides: Sequence[Row[Any]]
    earlier: Sequence[Row[Any]]
    course: str | None
    hints: Sequence[TakenHint] = ()


def page(
    connection: Connection, wanted: AttemptFilter, cursor: str | None, most: int
) -> tuple[list[ListedAttempt], str | None]:
    """Return at most ``most`` attempts, the newest first, and the cursor of the next page, if any.

    Raises BadCursorError.
    """
    newest = select(*LISTED).where(condition(wanted))
    if cursor is not None:
        newest = newest.where(earlier_than(place_of(cursor)))
    newest = newest.order_by(attempts.c.at.desc(), attempts.c.number.desc()).limit(most + 1)
    found = [ListedAttempt(**row._mapping) for row in connection.execute(newest)]
    if len(found) <= most:
        return found, None
    shown = found[:most]
    return shown, cursor_of((shown[-1].at, shown[-1].number))


def history(connection: Connection, attempt_id: str) -> AttemptHistory | None:
    """Return an attempt with its answers, reports and overrides; None if the id is unknown."""
    # PostgreSQL raises an error for some characters.
    if not attempt_id.isalnum():
        return None
    found = connection.execute(
        select(*LISTED, attempts.c.submission, attempts.c.report, assignments.c.course)
        .join_from(attempts, assignments, isouter=True)
        .where(attempts.c.id == attempt_id)
    ).one_or_none()
    if found is None:
        return None
    *listed, submission, report, course = found
    attempt = ListedAttempt(*listed)
    changed, replaced = (
        connection.execute(
            select(table).where(table.c.attempt == attempt.number).order_by(table.c.id)
        ).all()
        for table in (overrides, earlier_reports)
    )
    hints = hints_before(connection, attempt_id)
    return AttemptHistory(attempt, submission, report, changed, replaced, course, hints)


_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)
_TICK: Final = timedelta(microseconds=1)
# No number in a database is larger.
_LARGEST: Final = 2**62
_CURSOR: Final = regex(r"[0-9a-f]+\.[0-9a-f]+")


def condition(wanted: AttemptFilter) -> ColumnElement[bool]:
    """Return the SQL condition for the attempts that a filter selects."""
    return and_(True, *_conditions(wanted))


def _conditions(wanted: AttemptFilter) -> Iterator[ColumnElement[bool]]:
    if wanted.exercise is not None:
        exercise, _, seed = wanted.exercise.partition("~")
        yield attempts.c.exercise == exercise
        if seed:
            yield attempts.c.variant == seed
    if wanted.learner is not None:
        yield attempts.c.learner == wanted.learner
    if wanted.since is not None:
        yield attempts.c.at >= wanted.since
    if wanted.until is not None:
        yield attempts.c.at < wanted.until
    if wanted.course is not None:
        mine = select(assignments.c.number).where(assignments.c.course == wanted.course)
        if wanted.assignment is not None:
            mine = mine.where(assignments.c.id == wanted.assignment)
        yield attempts.c.assignment.in_(mine)
    if wanted.counted is not None:
        has_ordinal = attempts.c.ordinal.is_not(None)
        yield has_ordinal if wanted.counted else ~has_ordinal


def earlier_than(place: TimePlace) -> ColumnElement[bool]:
    """Return the SQL condition for attempts before this time and number."""
    return tuple_(*BY_TIME) < _literal(place)


def later_than(place: TimePlace) -> ColumnElement[bool]:
    """Return the SQL condition for attempts after this time and number."""
    return tuple_(*BY_TIME) > _literal(place)


def _literal(place: TimePlace) -> Tuple:
    at, number = place
    return tuple_(literal(at, UtcTime()), literal(number))


def cursor_of(place: TimePlace) -> str:
    """Write the time and number of an attempt as the cursor of a page."""
    at, number = place
    return f"{(at - _EPOCH) // _TICK:x}.{number:x}"


def place_of(cursor: str) -> TimePlace:
    """Read the time and number of an attempt from a cursor. Raises BadCursorError."""
    if not _CURSOR.fullmatch(cursor):
        raise BadCursorError(cursor)
    try:
        ticks, number = (int(part, 16) for part in cursor.split("."))
        if number >= _LARGEST:
            raise BadCursorError(cursor)
        return _EPOCH + ticks * _TICK, number
    except OverflowError as error:  # after the year 9999
        raise BadCursorError(cursor) from error


# --- The statistics of the attempts at an exercise, counted from verdicts and message codes


# The most misconceptions and groups in the statistics, and the most learners of a group.
MOST_MISCONCEPTIONS: Final = 100
MOST_GROUPS: Final = 50
MOST_LEARNERS: Final = 50
# The attempts of a learner that a learning curve has.
MOST_IN_A_CURVE: Final = 12
_WRONG: Final = (Verdict.INCORRECT, Verdict.PARTIAL)

# A part and a code of a message in it.
_Slip: TypeAlias = tuple[str, str]


def exercise_statistics(connection: Connection, wanted: AttemptFilter) -> ExerciseStatistics:
    """Return the statistics of an exercise from the wanted attempts."""
    assert wanted.exercise is not None
    chosen = condition(wanted)
    counts = _counts(connection, chosen)
    contents = _contents(connection, wanted.exercise.partition("~")[0], counts)
    parts: dict[str, _PartCount] = defaultdict(_PartCount)
    slips: dict[_Slip, Counter[str]] = defaultdict(Counter)
    outcome_with: dict[_Slip, int] = {}
    for outcome, content in contents.items():
        times = counts[outcome].total()
        for part, told in content.items():
            parts[part].add(told, times)
            for code in told["codes"]:
                slips[part, code].update(counts[outcome])
                outcome_with.setdefault((part, code), outcome)
    by_attempt = _by_attempt(connection, chosen)
    return ExerciseStatistics(
        exercise=wanted.exercise,
        attempts=sum(each.total() for each in counts.values()),
        learners=connection.scalar(select(func.count(attempts.c.learner.distinct())).where(chosen))
        or 0,
        parts=[part.figures(name) for name, part in parts.items()],
        misconceptions=[
            each.model_copy(update={"by_attempt": _curve(by_attempt, contents, each)})
            for each in _commonest(connection, chosen, slips, outcome_with)
        ],
        learners_by_attempt=[counts.total() for counts in by_attempt],
        hints=hint_figures(connection, chosen),
        identical=list(_identical(connection, chosen, contents)),
    )


def _counts(connection: Connection, chosen: ColumnElement[bool]) -> dict[int, Counter[str]]:
    is_postgresql = connection.dialect.name == "postgresql"
    # SQLite stores times as text that begins with the date; parsing it would take far longer.
    day: ColumnElement[str] = (
        cast(func.date(func.timezone("UTC", attempts.c.at)), String)
        if is_postgresql
        else func.substr(type_coerce(attempts.c.at, String), 1, 10)
    )
    counted = (
        select(attempts.c.outcome, day, func.count())
        .where(chosen)
        .group_by(attempts.c.outcome, day)
    )
    found: dict[int, Counter[str]] = defaultdict(Counter)
    for outcome, date, times in connection.execute(counted).all():
        found[outcome][date] = times
    return found


def _by_attempt(connection: Connection, chosen: ColumnElement[bool]) -> list[Counter[int]]:
    place = func.row_number().over(
        partition_by=attempts.c.learner, order_by=[attempts.c.at, attempts.c.number]
    )
    placed = (
        select(attempts.c.outcome, place.label("place"))
        # An attempt in which nothing could be read has no ordinal.
        .where(chosen, attempts.c.ordinal.is_not(None))
        .subquery()
    )
    counted = (
        select(placed.c.outcome, placed.c.place, func.count())
        .where(placed.c.place <= MOST_IN_A_CURVE)
        .group_by(placed.c.outcome, placed.c.place)
    )
    found: dict[int, Counter[int]] = defaultdict(Counter)
    for outcome, at, times in connection.execute(counted).all():
        found[at][outcome] = times
    return [found[at] for at in sorted(found)]


def _curve(
    by_attempt: Sequence[Counter[int]],
    contents: Mapping[int, Mapping[str, Any]],
    slip: MisconceptionFigures,
) -> list[int]:
    having = {
        number
        for number, content in contents.items()
        if slip.part in content and slip.code in content[slip.part]["codes"]
    }
    return [sum(counts[number] for number in having & counts.keys()) for counts in by_attempt]


def _contents(
    connection: Connection, exercise: str, counts: Mapping[int, object]
) -> dict[int, dict[str, Any]]:
    told = select(outcomes.c.id, outcomes.c.content).where(outcomes.c.exercise == exercise)
    return {
        number: json.loads(content)
        for number, content in connection.execute(told.order_by(outcomes.c.id))
        if number in counts
    }


@dataclass(slots=True)
class _RowCount:
    seen: int = 0
    share: Share = field(default_factory=Share)
    cells: dict[str, Share] = field(default_factory=lambda: defaultdict(Share))

    def add(self, cells: Mapping[str, Verdict], times: int) -> None:
        self.seen += times
        self.share.add(combined(cells.values()), times)
        for label, verdict in cells.items():
            self.cells[label].add(verdict, times)


@dataclass(slots=True)
class _PartCount:
    share: Share = field(default_factory=Share)
    detailed: int = 0
    rows: dict[str, _RowCount] = field(default_factory=lambda: defaultdict(_RowCount))

    def add(self, told: Mapping[str, Any], times: int) -> None:
        self.share.add(Verdict(told["verdict"]), times)
        rows: dict[str, dict[str, Verdict]] = defaultdict(dict)
        for place, verdict in told["cells"].items():
            row, _, cell = place.partition("/")
            rows[row][cell] = Verdict(verdict)
        self.detailed += times * bool(rows)
        for row, cells in rows.items():
            self.rows[row].add(cells, times)

    def figures(self, name: str) -> PartFigures:
        rows = [
            RowFigures(
                label=label,
                **_share(row.share),
                cells=[CellFigures(label=cell, **_share(row.cells[cell])) for cell in row.cells],
            )
            for label, row in self.rows.items()
            # A few students added the other rows.
            if 2 * row.seen > self.detailed
        ]
        return PartFigures(part=name, **_share(self.share), rows=rows)


def _share(share: Share) -> dict[str, Any]:
    told = ShareCorrect(answered=share.answered, correct=share.correct, share=share.value)
    return told.model_dump()


def _commonest(
    connection: Connection,
    chosen: ColumnElement[bool],
    slips: Mapping[_Slip, Counter[str]],
    outcome_with: Mapping[_Slip, int],
) -> list[MisconceptionFigures]:
    ordered = sorted(slips.items(), key=lambda slip: (-slip[1].total(), slip[0]))
    told = ordered[:MOST_MISCONCEPTIONS]
    reports = _newest_reports(connection, chosen, {outcome_with[slip] for slip, _ in told})
    return [
        MisconceptionFigures(
            part=part,
            code=code,
            sentence=_sentence(reports[outcome_with[part, code]], part, code),
            attempts=days.total(),
            by_day=dict(sorted(days.items())),
        )
        for (part, code), days in told
    ]


def _newest_reports(
    connection: Connection, chosen: ColumnElement[bool], among: Set[int]
) -> dict[int, Any]:
    newest = (
        select(func.max(attempts.c.number))
        .where(chosen, attempts.c.outcome.in_(among))
        .group_by(attempts.c.outcome)
    )
    found = select(attempts.c.outcome, attempts.c.report).where(attempts.c.number.in_(newest))
    return {outcome: json.loads(report) for outcome, report in connection.execute(found).all()}


def _sentence(report: Mapping[str, Any], part: str, code: str) -> str | None:
    told = (each for each in report["parts"] if each["part"] == part)
    texts = (each["message"] for each in _messages(told) if each["code"] == code)
    text = next(texts, None)
    return None if text is None else sentence_in(report, text)


def _messages(places: Iterable[Mapping[str, Any]]) -> Iterator[Mapping[str, Any]]:
    for place in places:
        yield from place["feedback"]
        yield from _messages([*place.get("rows", ()), *place.get("cells", ())])


def _identical(
    connection: Connection, chosen: ColumnElement[bool], contents: Mapping[int, Mapping[str, Any]]
) -> Iterator[IdenticalAnswers]:
    learners = func.count(attempts.c.learner.distinct())
    same = (
        select(attempts.c.outcome, attempts.c.answers_digest, learners, func.count())
        .where(chosen)
        .group_by(attempts.c.outcome, attempts.c.answers_digest)
        .having(learners > 1)
        .order_by(learners.desc(), func.count().desc(), attempts.c.answers_digest)
    )
    wrong = {number: list(_wrong_places(content)) for number, content in contents.items()}
    groups = [group for group in connection.execute(same) if wrong.get(group.outcome)]
    for outcome, digest, count, times in groups[:MOST_GROUPS]:
        named = (
            select(attempts.c.learner)
            .distinct()
            .where(chosen, attempts.c.outcome == outcome, attempts.c.answers_digest == digest)
            .order_by(attempts.c.learner)
            .limit(MOST_LEARNERS)
        )
        yield IdenticalAnswers(
            learners=count,
            attempts=times,
            wrong=wrong[outcome],
            among=list(connection.scalars(named)),
        )


def _wrong_places(content: Mapping[str, Mapping[str, Any]]) -> Iterable[str]:
    for part, told in content.items():
        for place, verdict in told["cells"].items():
            if verdict in _WRONG:
                yield f"{part}/{place}"


# --- Points with which a tutor overrides those of a report


def override(
    connection: Connection,
    attempt_id: str,
    points: float | None,
    reason: str,
    author: str,
    at: datetime,
) -> None:
    """Override the points of an attempt's report; ``points=None`` withdraws the override.

    Raises UnknownAttemptError, UnusablePointsError.
    """
    found = connection.execute(
        select(attempts.c.number, attempts.c.max_points).where(attempts.c.id == attempt_id)
    ).one_or_none()
    if found is None:
        raise UnknownAttemptError(attempt_id)
    if points is not None and not 0 <= points <= found.max_points:
        most = f"{found.max_points:g}"
        raise UnusablePointsError(say("The attempt may have 0 to {most} points.", most=most))
    connection.execute(
        insert(overrides).values(
            attempt=found.number, points=points, reason=reason, author=author, at=at
        )
    )
    connection.execute(
        update(attempts).where(attempts.c.number == found.number).values(awarded=points)
    )
    queue_scores(connection, attempts.c.number == found.number)


# --- The data of one learner: counted, deleted, and written out


# How often PostgreSQL may report a concurrent write while a learner is being deleted.
_TRIES: Final = 4


@dataclass(frozen=True, slots=True)
class LearnerData:
    """Counts of a learner's attempts, earlier reports, overrides and courses."""

    attempts: int
    earlier_reports: int
    overrides: int
    courses: int


def data_of(connection: Connection, learner: str) -> LearnerData:
    """Count the records of a learner."""
    mine = select(attempts.c.number).where(attempts.c.learner == learner)
    columns = (attempts.c.number, earlier_reports.c.attempt, overrides.c.attempt)
    counts = [select(func.count(column)).where(column.in_(mine)) for column in columns]
    enrolled = course_learners.c.learner
    counts.append(select(func.count(enrolled)).where(enrolled == learner))
    return LearnerData(*(connection.scalar(count) or 0 for count in counts))


def forget(connection: Connection, learner: str) -> LearnerData:
    """Delete all records of a learner, also in courses; return their counts."""
    for _ in range(_TRIES):
        try:
            with connection.begin_nested():
                return _forget(connection, learner)
        except IntegrityError:
            # After the rows were deleted, another process has given points or begun a regrade.
            continue
    return _forget(connection, learner)


def _forget(connection: Connection, learner: str) -> LearnerData:
    data = data_of(connection, learner)
    _delete_records(connection, attempts.c.learner == learner)
    forget_scores(connection, learner)
    for table in (
        attempts,
        extensions,
        deals,
        course_learners,
        keys,
        tables.learners,
        tables.handed_files,
    ):
        connection.execute(delete(table).where(table.c.learner == learner))
    return data


# Columns that are about the database and not about the learner, and columns of JSON. A learner does
# not see the seed of a variant.
_INNER: Final = {"number", "attempt", "assignment", "outcome", "digest", "variant"}
_JSON: Final = {"submission", "exercises", "content"}

# The learner's id at learning platforms, and the points that these got or wait for.
_AT_PLATFORMS: Final = (
    select(tables.registrations.c.name, tables.registrations.c.issuer)
    .add_columns(tables.learners.c.sub, tables.learners.c.launched_at)
    .join_from(tables.learners, tables.registrations)
    .where(tables.learners.c.learner == bindparam("learner"))
)
_SCORES: Final = (
    select(assignments.c.course, assignments.c.id.label("in_assignment"))
    .add_columns(
        *(
            tables.scores.c[name]
            for name in ("sub", "points", "max_points", "submitted_at", "state")
        ),
        *(tables.scores.c[name] for name in ("sent_at", "sent_points", "refusal")),
    )
    .join_from(tables.scores, tables.line_items)
    .join(assignments, assignments.c.number == tables.line_items.c.assignment)
    .where(tables.scores.c.learner == bindparam("learner"))
)


def everything_of(connection: Connection, learner: str) -> dict[str, Any]:
    """Return all records of a learner as values for JSON."""
    which = {"learner": learner}

    def rows(table: Table, condition: ColumnElement[bool]) -> list[dict[str, Any]]:
        found = connection.execute(select(table).where(condition)).all()
        return [_known(row) for row in found]

    def attempt(row: Row[Any]) -> dict[str, Any]:
        return _known(row) | {
            "overrides": rows(overrides, overrides.c.attempt == row.number),
            "earlier_reports": rows(earlier_reports, earlier_reports.c.attempt == row.number),
            "hints": rows(hints, hints.c.attempt == row.number),
        }

    mine = select(attempts, assignments.c.course, assignments.c.id.label("in_assignment"))
    recorded = connection.execute(
        mine.join_from(attempts, assignments, isouter=True)
        .where(attempts.c.learner == learner)
        .order_by(attempts.c.number)
    ).all()

    def assigned(table: Table) -> list[dict[str, Any]]:
        found = connection.execute(
            select(table, assignments.c.course, assignments.c.id.label("in_assignment"))
            .join_from(table, assignments)
            .where(table.c.learner == learner)
        )
        return [_known(row) for row in found]

    return {
        "learner": learner,
        "courses": rows(course_learners, course_learners.c.learner == learner),
        "extensions": assigned(extensions),
        "deals": assigned(deals),
        "links": rows(keys, keys.c.learner == learner),
        "attempts": [attempt(row) for row in recorded],
        "platforms": [_known(row) for row in connection.execute(_AT_PLATFORMS, which)],
        "scores": [_known(row) for row in connection.execute(_SCORES, which)],
        "handed_files": rows(tables.handed_files, tables.handed_files.c.learner == learner),
    }


def _known(row: Row[Any]) -> dict[str, Any]:
    return {name: _plain(name, value) for name, value in _named(row).items() if value is not None}


def _named(row: Row[Any]) -> Mapping[str, Any]:
    return {name: value for name, value in row._mapping.items() if name not in _INNER}


def _plain(name: str, value: Any) -> Any:
    if isinstance(value, datetime):
        return value.isoformat()
    if name == "report":
        return json.loads(shown_report(value, ENGLISH))
    return json.loads(value) if name in _JSON else value


# --- Attempts that are deleted: old ones, and others that are chosen


def is_older(before: datetime) -> ColumnElement[bool]:
    """Return the SQL condition for attempts that are too old to be kept.

    Their retention time began before the moment ``before``.
    """
    # In an assignment, the time begins when the last learner can no longer hand in; without a due
    # date, it never begins.
    later = and_(
        extensions.c.assignment == assignments.c.number,
        func.coalesce(extensions.c.closes, extensions.c.due) >= before,
    )
    is_over = func.coalesce(assignments.c.closes, assignments.c.due) < before
    over = select(assignments.c.number).where(is_over, ~exists().where(later))
    of_none = attempts.c.assignment.is_(None)
    return and_(attempts.c.at < before, or_(of_none, attempts.c.assignment.in_(over)))


def delete_older(connection: Connection, before: datetime) -> int:
    """Delete the attempts that ``is_older`` selects; return the number of deleted attempts."""
    return delete_attempts(connection, is_older(before))


def delete_attempts(connection: Connection, chosen: ColumnElement[bool]) -> int:
    """Delete attempts with all records about them; return the number of attempts."""
    _delete_records(connection, chosen)
    return connection.execute(delete(attempts).where(chosen)).rowcount


def _delete_records(connection: Connection, chosen: ColumnElement[bool]) -> None:
    numbers = select(attempts.c.number).where(chosen)
    for table in (regrade_queue, earlier_reports, overrides, hints):
        connection.execute(delete(table).where(table.c.attempt.in_(numbers)))


def months_before(now: datetime, months: int) -> datetime:
    """Return the time some months earlier; a day after the 28th becomes the 28th."""
    total = 12 * now.year + now.month - 1 - months
    return now.replace(year=total // 12, month=total % 12 + 1, day=min(now.day, 28))
