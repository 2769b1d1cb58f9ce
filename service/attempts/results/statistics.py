"""The statistics of the attempts at an exercise, counted from verdicts and message codes."""

import json
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias

from sqlalchemy import ColumnElement, Connection, String, cast, func, select, type_coerce

from service.attempts.attempt import AttemptFilter
from service.attempts.hints import hint_figures
from service.attempts.results.listing import condition
from service.attempts.results.recorded_report import sentence_in
from service.attempts.storage.tables import attempts, outcomes
from service.contract.statistics import (
    CellFigures,
    ExerciseStatistics,
    IdenticalAnswers,
    MisconceptionFigures,
    PartFigures,
    RowFigures,
    ShareCorrect,
)
from service.grading import Verdict
from service.grading.report import combined
from service.statistics import Share

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
