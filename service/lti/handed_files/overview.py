"""Database functions: reports on handed-in files that did not reach a platform."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Final

from sqlalchemy import Connection, func, select

from service.attempts.storage.lti_tables import contexts, handed_files
from service.attempts.storage.tables import course_learners
from service.lti.handed_files.notices import HandedFiles
from service.lti.linking import pseudonymous_name
from service.lti.scores.score_problems import told
from service.translations import Language

_OF: Final = handed_files.c
# Waiting reports have a refusal, too, if they were tried in vain.
_TROUBLED: Final = _OF.state.in_(("refused", "waiting")) & _OF.refusal.is_not(None)
_MOST: Final = 200


@dataclass(frozen=True, slots=True)
class MissingReport:
    """A report that did not reach the platform; ``next_try_at`` is None after the last try."""

    learner: str
    name: str
    files: list[str]
    received_at: datetime
    next_try_at: datetime | None
    problem: str


def missing_reports(
    connection: Connection, course: str, language: Language, learner: str | None = None
) -> list[MissingReport]:
    """Return the reports that did not reach the platform, newest first.

    ``learner`` limits the result to one learner.
    """
    of_course = select(contexts).where(contexts.c.course == course)
    here = {
        (row.registration, row.deployment, row.context) for row in connection.execute(of_course)
    }
    if not here:
        return []
    named = select(course_learners.c.learner, course_learners.c.name)
    mine = named.where(course_learners.c.course == course)
    names = {row.learner: row.name for row in connection.execute(mine)}
    chosen = select(handed_files).where(
        _TROUBLED, _OF.registration.in_({registration for registration, *_ in here})
    )
    if learner is not None:
        chosen = chosen.where(_OF.learner == learner)
    found = []
    for row in connection.execute(chosen.order_by(_OF.number.desc())):
        files = HandedFiles.model_validate_json(row.content)
        if (row.registration, files.deployment, files.context) in here:
            found.append(
                MissingReport(
                    row.learner,
                    names.get(row.learner) or pseudonymous_name(row.learner),
                    [each.filename for each in files.assets if each.filename],
                    row.received_at,
                    row.next_try_at if row.state == "waiting" else None,
                    told(row.refusal, language, of_report=True),
                )
            )
    return found[:_MOST]


def missing_counts(connection: Connection) -> Mapping[str, int]:
    """Return how many reports did not reach each platform, by registration id."""
    counted = select(_OF.registration, func.count().label("number")).where(_TROUBLED)
    rows = connection.execute(counted.group_by(_OF.registration))
    return {row.registration: row.number for row in rows}
