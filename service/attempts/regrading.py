"""Attempts graded anew by any number of processes, which share the work through the database.

A worker locks what it takes, and what it has regraded leaves the queue in the same commit. Where it
dies, the database gives up its locks, and another takes its attempts. In PostgreSQL workers skip
what others have locked (SKIP LOCKED); in SQLite one writes at a time, and the others wait.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any, Final

from sqlalchemy import (
    ColumnElement,
    Connection,
    Row,
    bindparam,
    delete,
    func,
    insert,
    literal,
    or_,
    select,
    update,
)

from service.attempts.database import without_time_limit
from service.attempts.graded import AttemptGrading
from service.attempts.kept_reports import KeptReports, PartResults, WrittenReport
from service.attempts.reading import BY_TIME, TimePlace, later_than
from service.attempts.recording import insert_or_ignore, outcome_ids
from service.attempts.tables import attempts, earlier_reports, regrade_queue
from service.catalogue import Exercise, FeedbackLevel, least
from service.submissions.body import GradeRequest
from service.version import VERSION

# So many are regraded in one commit.
BATCH: Final = 50


@dataclass(frozen=True, slots=True)
class RegradedAttempt:
    """An attempt before and after; ``reasons`` names the parts that are judged otherwise."""

    id: str
    learner: str
    ordinal: int | None
    before: float
    after: float
    max_points: float
    reasons: tuple[str, ...]

    @property
    def is_changed(self) -> bool:
        """Whether the learner gets another result."""
        return self.before != self.after or bool(self.reasons)


class Regrading:
    """The regrading of an exercise's attempts by its present version and the present program."""

    def __init__(self, exercise: Exercise, ceiling: FeedbackLevel) -> None:
        self._exercise = exercise
        self._ceiling = ceiling
        # The same answers get the same report.
        self._kept = KeptReports()

    def outdated(self, connection: Connection) -> list[int]:
        """The numbers of the attempts that another version has graded."""
        numbers = select(attempts.c.number).where(self._is_outdated()).order_by(attempts.c.number)
        return list(connection.scalars(numbers))

    def outdated_count(self, connection: Connection) -> int:
        """How many attempts another version has graded."""
        return connection.scalar(select(func.count()).where(self._is_outdated())) or 0

    def outdated_after(self, connection: Connection, place: TimePlace | None) -> list[TimePlace]:
        """The next of these in the order of time, as many as a batch."""
        following = select(*BY_TIME).where(self._is_outdated())
        if place is not None:
            following = following.where(later_than(place))
        found = connection.execute(following.order_by(*BY_TIME).limit(BATCH))
        return [(at, number) for at, number in found]

    def preview(self, connection: Connection, numbers: Sequence[int]) -> list[RegradedAttempt]:
        """What regrading these attempts would change; nothing is written."""
        return [self._regraded(row)[0] for row in self._rows(connection, numbers)]

    def enqueue(self, connection: Connection) -> None:
        """Have all outdated attempts wait for workers; those that wait already wait once."""
        without_time_limit(connection)
        waiting = select(attempts.c.number, literal(self._exercise.id)).where(self._is_outdated())
        connection.execute(
            insert_or_ignore(regrade_queue)[connection.dialect.name].from_select(
                ["attempt", "exercise"], waiting.order_by(attempts.c.number)
            )
        )

    def waiting(self, connection: Connection) -> int:
        """How many wait, those included that a worker is at."""
        mine = regrade_queue.c.exercise == self._exercise.id
        return connection.scalar(select(func.count()).select_from(regrade_queue).where(mine)) or 0

    def work(self, connection: Connection) -> list[RegradedAttempt]:
        """Regrade some that wait and that nobody else is at; none where there is none.

        The caller commits; what was taken leaves the queue with that.
        """
        taken = connection.scalars(
            select(regrade_queue.c.attempt)
            .where(regrade_queue.c.exercise == self._exercise.id)
            .order_by(regrade_queue.c.attempt)
            .limit(BATCH)
            .with_for_update(skip_locked=True)
        ).all()
        # One that came into the queue again while another worker was at it is done already.
        rows = [row for row in self._rows(connection, taken) if self._needs(row)]
        done = [(row, *self._regraded(row)) for row in rows]
        if done:
            self._write(connection, done)
        connection.execute(delete(regrade_queue).where(regrade_queue.c.attempt.in_(taken)))
        return [change for _, change, _ in done]

    def _is_outdated(self) -> ColumnElement[bool]:
        another = or_(attempts.c.version != self._exercise.version, attempts.c.grader != VERSION)
        return (attempts.c.exercise == self._exercise.id) & another

    def _needs(self, row: Row[Any]) -> bool:
        return (row.version, row.grader) != (self._exercise.version, VERSION)

    def _rows(self, connection: Connection, numbers: Sequence[int]) -> Sequence[Row[Any]]:
        chosen = select(attempts).where(attempts.c.number.in_(numbers))
        return connection.execute(chosen.order_by(attempts.c.number)).all()

    def _regraded(self, row: Row[Any]) -> tuple[RegradedAttempt, WrittenReport]:
        before = json.loads(row.report)
        # What a learner was not told once is not told later: the service may have had a ceiling
        # that nobody has named to this process.
        level = least(
            self._exercise.feedback_at(row.ordinal or 1),
            self._ceiling,
            FeedbackLevel(before["feedback"]),
        )
        report = self._kept.of(row.submission, level, lambda: self._report(row.submission, level))
        after = round(report.points * row.worth, 6)
        reasons = tuple(_reasons(_results(before), report.parts))
        change = RegradedAttempt(
            row.id, row.learner, row.ordinal, row.points, after, report.max_points, reasons
        )
        return change, report

    def _report(self, submission: str, level: FeedbackLevel) -> WrittenReport:
        body = GradeRequest.model_validate_json(submission)
        graded = AttemptGrading(self._exercise, body).at(level)
        report = graded.report
        parts = {part.part: (str(part.verdict), part.points) for part in report.parts}
        return WrittenReport(graded.text, report.points, report.max_points, parts, graded.outcome)

    def _write(
        self,
        connection: Connection,
        done: Sequence[tuple[Row[Any], RegradedAttempt, WrittenReport]],
    ) -> None:
        now = datetime.now(UTC)
        ids = outcome_ids(connection, [report.outcome for _, _, report in done])
        kept = ("report", "version", "grader", "points", "max_points")
        connection.execute(
            insert(earlier_reports),
            [
                {"attempt": row.number, "replaced_at": now}
                | {name: getattr(row, name) for name in kept}
                for row, _, _ in done
            ],
        )
        connection.execute(
            update(attempts).where(attempts.c.number == bindparam("which")),
            [
                {
                    "which": row.number,
                    "report": report.text,
                    "version": self._exercise.version,
                    "grader": VERSION,
                    "points": change.after,
                    "max_points": report.max_points,
                    "outcome": ids[report.outcome],
                }
                for row, change, report in done
            ],
        )


def _results(report: Mapping[str, Any]) -> PartResults:
    """The results of the parts of a report as it was written."""
    return {part["part"]: (part["verdict"], part["points"]) for part in report["parts"]}


def _reasons(old: PartResults, new: PartResults) -> list[str]:
    """The parts that are judged otherwise, each in a few words."""
    told = []
    for name in dict.fromkeys((*old, *new)):
        if name not in new:
            told.append(f"{name} is no part any more")
        elif name not in old:
            told.append(f"{name} is new, {new[name][0]}")
        elif old[name] != new[name]:
            told.append(f"{name} {_change(old[name][0], new[name][0])}")
    return told


def _change(before: str, after: str) -> str:
    return f"{before}, other points" if before == after else f"{before} → {after}"
