"""The queue of submissions to grade; each submission is leased to one process."""

from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, Final

from sqlalchemy import Connection, delete, or_, select, update

from service.attempts.recording import insert_or_ignore
from service.attempts.storage.lti_tables import handed_files
from service.lti.handed_files.notices import HandedFiles, SubmissionNotice
from service.lti.problems import LtiError
from service.lti.registrations import Registration, deployments_of, registration

# In ``Connection.info``: True if the transaction has queued files.
QUEUED: Final = "files_queued"
# How long files belong to the process that grades them.
LEASE: Final = timedelta(minutes=5)
# How long the addresses of files are kept: as long as a report may be opened.
_KEPT: Final = timedelta(days=400)
_OF: Final = handed_files.c


@dataclass(frozen=True, slots=True)
class TakenFiles:
    """The files of a submission that is leased to this process."""

    number: int
    registration: Registration
    files: HandedFiles
    tries: int
    received_at: datetime


def queue_files(
    connection: Connection,
    known: Registration,
    notice: SubmissionNotice,
    learner: str,
    now: datetime,
) -> None:
    """Add the files of a notice to the queue. Raises LtiError."""
    # A repeated notice changes nothing.
    if not known.any_deployment and notice.deployment not in deployments_of(connection, known.id):
        raise LtiError("unknown-deployment", deployment=notice.deployment)
    connection.execute(delete(handed_files).where(_OF.received_at < now - _KEPT))
    values = {
        "registration": known.id,
        "notice": notice.id,
        "submission": notice.submission,
        "learner": learner,
        "content": notice.files.model_dump_json(),
        "received_at": now,
        "state": "waiting",
        "tries": 0,
        "next_try_at": now,
    }
    added = insert_or_ignore(handed_files)[connection.dialect.name].values(values)
    if connection.execute(added).rowcount:
        connection.info[QUEUED] = True


def take(connection: Connection, now: datetime) -> TakenFiles | None:
    """Lease and return the files of the next submission, or return None if none is due."""
    free = or_(_OF.leased_until.is_(None), _OF.leased_until <= now)
    chosen = select(handed_files).where(_OF.state == "waiting", _OF.next_try_at <= now, free)
    ordered = chosen.order_by(_OF.next_try_at).limit(1).with_for_update(skip_locked=True)
    row = connection.execute(ordered).one_or_none()
    if row is None:
        return None
    taken = {"leased_until": now + LEASE, "tries": row.tries + 1}
    connection.execute(update(handed_files).where(_OF.number == row.number).values(taken))
    return TakenFiles(
        row.number,
        registration(connection, row.registration),
        HandedFiles.model_validate_json(row.content),
        row.tries,
        row.received_at,
    )


def note_done(connection: Connection, number: int, refusal: str | None = None) -> None:
    """Mark a submission as done; ``refusal`` says why the platform does not get the reports."""
    _note(connection, number, state="refused" if refusal else "sent", refusal=refusal)


def note_later(connection: Connection, number: int, at: datetime, refusal: str) -> None:
    """Store when to grade a submission again, and why."""
    _note(connection, number, next_try_at=at, refusal=refusal)


def _note(connection: Connection, number: int, **values: Any) -> None:
    mine = update(handed_files).where(_OF.number == number)
    connection.execute(mine.values(leased_until=None, **values))


def next_due(connection: Connection) -> datetime | None:
    """Return when the next submission is due, or None if none waits."""
    waiting = select(_OF.next_try_at, _OF.leased_until).where(_OF.state == "waiting")
    row = connection.execute(waiting.order_by(_OF.next_try_at).limit(1)).one_or_none()
    return None if row is None else max(row.next_try_at, row.leased_until or row.next_try_at)


def files_of(
    connection: Connection, registration_id: str, submission: str, asset: str
) -> tuple[HandedFiles, str] | None:
    """Return all files of a submission, and the learner who has handed them in.

    Return None if no such submission contains the file ``asset``.
    """
    mine = (_OF.registration == registration_id) & (_OF.submission == submission)
    newest = select(_OF.content, _OF.learner).where(mine).order_by(_OF.number.desc())
    for row in connection.execute(newest.limit(10)):
        files = HandedFiles.model_validate_json(row.content)
        if any(each.asset_id == asset for each in files.assets):
            return files, row.learner
    return None
