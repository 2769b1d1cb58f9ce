"""Files that students hand in at a platform: notices, the queue, grading, and reports.

How a platform is asked is in ``fetching.py`` and ``grade_services.py``.
"""

import base64
import hashlib
import json
import logging
import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from math import inf
from pathlib import Path, PurePosixPath
from time import monotonic
from typing import Annotated, Any, Final, TypeGuard
from urllib.parse import urljoin

import jwt
from cryptography.hazmat.primitives.asymmetric.rsa import RSAPublicKey
from pydantic import BaseModel, ConfigDict, Field, StringConstraints, ValidationError
from sqlalchemy import Connection, Engine, delete, func, or_, select, update

from dh_grader.access import Secret
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.catalogue.schema_fields import least
from dh_grader.formats.graded import GradedSubmission, GradingTerms, graded
from dh_grader.formats.texts import points, points_in_words
from dh_grader.lti.fetching import TIMEOUT, FetchError, TooLargeError, answer, content
from dh_grader.lti.grade_services import (
    AccessTokens,
    GradeServices,
    NotThereError,
    RefusedError,
    ScoreError,
    ThisLaterError,
    available_key,
    problem_told,
)
from dh_grader.lti.launch import (
    LTI,
    check_parties,
    check_times,
    parameters_assignment,
    pseudonymous_name,
    signed_claims,
)
from dh_grader.lti.outbox import pause_after, utc_now
from dh_grader.lti.registrations import (
    NOTICES_PATH,
    LtiError,
    Registration,
    deployments_of,
    registration,
    unusable,
)
from dh_grader.regex import regex
from dh_grader.store.attempts import insert_or_ignore
from dh_grader.store.database import in_transaction
from dh_grader.store.tables import contexts, course_learners, handed_files
from dh_grader.submissions import PASS_MARK, Assignment, assigned
from dh_grader.submissions.files import PASTED_ENDINGS, HandedFile, HandedIn, most_bytes
from dh_grader.translations import ENGLISH, Language, language_named, say, told

# --- Notices of platforms (Platform Notification Service) about files that were handed in


HANDED_IN: Final = "LtiAssetProcessorSubmissionNotice"
# With this one, platforms try whether notices arrive.
HELLO: Final = "LtiHelloWorldNotice"
MOST_FILES: Final = 20
_SURROGATE: Final = regex(r"[\ud800-\udfff]")

_Name = Annotated[str, StringConstraints(min_length=1, max_length=255)]
_Address = Annotated[str, StringConstraints(min_length=1, max_length=1000)]


class _Stored(BaseModel):
    model_config = ConfigDict(extra="ignore", frozen=True)


class FileAtPlatform(_Stored):
    """A file at the platform. ``filename`` is "" for a text that a student has typed there."""

    asset_id: _Name
    url: _Address
    filename: str = ""
    content_type: str = ""
    sha256_checksum: str = ""


class HandedFiles(_Stored):
    """The files of one submission, and where to send the reports.

    ``deployment`` and ``context`` identify the course at the platform; both may be "".
    """

    assets: Annotated[list[FileAtPlatform], Field(min_length=1, max_length=MOST_FILES)]
    report_url: _Address
    custom: dict[str, str] = {}
    deployment: str = ""
    context: str = ""


class SubmissionNotice(BaseModel):
    """A checked notice: ``user`` has handed in ``files``."""

    id: str
    deployment: str
    submission: str
    user: str
    files: HandedFiles


def parties_of(token: str) -> tuple[str, str]:
    """Return the issuer and the client id in a token without checking its signature.

    Raises LtiError.
    """
    try:
        claims = jwt.decode(token, options={"verify_signature": False})
    except (jwt.InvalidTokenError, ValueError, RecursionError) as error:
        raise LtiError("token-malformed") from error
    issuer, audience, party = (claims.get(name) for name in ("iss", "aud", "azp"))
    client = party or (audience[0] if isinstance(audience, list) and audience else audience)
    if not _is_text(issuer):
        raise LtiError("wrong-issuer")
    if not _is_text(client):
        raise LtiError("wrong-audience")
    return issuer, client


def notice_in(
    token: str, key: RSAPublicKey, registration: Registration, now: datetime
) -> SubmissionNotice | None:
    """Return the notice in a token, or None if it is only a test. Raises LtiError.

    A platform may send the same notice again, with the same id.
    """
    claims = signed_claims(token, key)
    check_parties(claims, registration)
    check_times(claims, now.timestamp())
    if claims.get(f"{LTI}version") != "1.3.0":
        raise LtiError("wrong-version")
    notice = claims.get(f"{LTI}notice")
    kind = notice.get("type") if isinstance(notice, dict) else None
    if kind == HELLO:
        return None
    if kind != HANDED_IN:
        raise LtiError("wrong-notice", kind=kind)
    return SubmissionNotice(
        id=_name(claims, "notice", "id"),
        deployment=_text(claims.get(f"{LTI}deployment_id"), "no-deployment"),
        submission=_name(claims, "submission", "id"),
        user=_name(claims, "for_user", "user_id"),
        files=_files(claims, registration),
    )


def _files(claims: Mapping[str, Any], registration: Registration) -> HandedFiles:
    service, report = claims.get(f"{LTI}assetservice"), claims.get(f"{LTI}assetreport")
    custom, context = claims.get(f"{LTI}custom"), claims.get(f"{LTI}context")
    deployment = claims.get(f"{LTI}deployment_id")
    course = context.get("id") if isinstance(context, dict) else None
    try:
        found = HandedFiles(
            assets=service["assets"] if isinstance(service, dict) else [],
            report_url=report["report_url"] if isinstance(report, dict) else "",
            custom={
                name: value
                for name, value in (custom.items() if isinstance(custom, dict) else ())
                if isinstance(value, str) and len(value) <= 2000
            },
            deployment=deployment if isinstance(deployment, str) else "",
            context=course if isinstance(course, str) else "",
        )
    except (ValidationError, KeyError) as error:
        raise LtiError("no-files") from error
    for address in (found.report_url, *(each.url for each in found.assets)):
        if reason := unusable(address, local=registration.is_development):
            raise LtiError("bad-address", address=address, reason=reason)
    return found


def _is_text(value: Any) -> TypeGuard[str]:
    # No database stores a lone surrogate.
    return isinstance(value, str) and bool(value) and not _SURROGATE.search(value)


def _name(claims: Mapping[str, Any], claim: str, name: str) -> str:
    found = claims.get(f"{LTI}{claim}")
    value = found.get(name) if isinstance(found, dict) else None
    return _text(value, "bad-claim", claim=f"{LTI}{claim}")


def _text(value: Any, problem: str, **more: str) -> str:
    if not isinstance(value, str) or not 0 < len(value) <= 255:
        raise LtiError(problem, **more)
    return value


# --- The queue of submissions to grade; each submission is leased to one process


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
    """Add the files of a notice to the queue, unless it is a repeated one. Raises LtiError."""
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


# --- The services of platforms for handed-in files: notices, files (assets), and reports on them


_SCOPE: Final = "https://purl.imsglobal.org/spec/lti/scope/"
NOTICES: Final = f"{_SCOPE}noticehandlers"
READ: Final = f"{_SCOPE}asset.readonly"
REPORT: Final = f"{_SCOPE}report"
_JSON: Final = {"Content-Type": "application/json"}
_MOST_REDIRECTS: Final = 3
# How long all files of a submission may take (seconds).
_FILES_TIME: Final = 20.0


class NoFileError(Exception):
    """A file cannot be fetched or graded; ``reason`` says why.

    ``code`` is an error code of the LTI standard.
    """

    def __init__(self, code: str, reason: str) -> None:
        self.code, self.reason = code, reason
        super().__init__(reason)


class PlatformFiles:
    """Uses platforms' services for handed-in files, with the access tokens of this process."""

    def __init__(self, tokens: AccessTokens) -> None:
        self._services = GradeServices(tokens)

    def ask_for_notices(self, registration: Registration, service: str) -> None:
        """Ask the platform to send us notices of handed-in files. Raises ScoreError."""
        asked = {"notice_type": HANDED_IN, "handler": registration.address + NOTICES_PATH}
        self._send(registration, service, "PUT", NOTICES, asked)

    def send_report(self, registration: Registration, url: str, report: Mapping[str, Any]) -> None:
        """Send a report, unless the platform already has a newer one. Raises ScoreError."""
        try:
            self._send(registration, url, "POST", REPORT, report)
        except ThisLaterError as error:
            if error.name != "stamp":
                raise

    def content_of(
        self, registration: Registration, file: FileAtPlatform, latest: float = inf
    ) -> bytes:
        """Return a file's content. Raises NoFileError, or ScoreError if a later try may succeed.

        ``latest`` is the time of ``monotonic`` at which the transfer ends at the latest.
        """
        # A platform may redirect to another host. The access token is sent to the first host only.
        local, until = registration.is_development, min(latest, monotonic() + TIMEOUT)
        try:
            asked = self._services.asked(
                registration, file.url, "GET", READ, {"headers": {}, "until": until}, redirects=True
            )
            url = file.url
            with asked as response:
                if not response.is_redirect:
                    return _checked(content(response, most_bytes(file.filename)), file)
                url = urljoin(url, response.headers.get("location", ""))
            for _ in range(_MOST_REDIRECTS):
                with answer(url, local=local, until=until) as response:
                    if response.is_success:
                        return _checked(content(response, most_bytes(file.filename)), file)
                    if not response.is_redirect:
                        raise FetchError(say("the status is {status}", status=response.status_code))
                    url = urljoin(url, response.headers.get("location", ""))
            raise FetchError(say("the answers are too many redirects"))
        except TooLargeError as error:
            raise NoFileError("ASSET_TOO_LARGE", error.args[0]) from error
        except FetchError as error:
            raise NoFileError("DOWNLOAD_FAILED", error.args[0]) from error
        except NotThereError as error:
            raise NoFileError("DOWNLOAD_FAILED", say("it is not there any more")) from error
        except RefusedError as error:
            raise NoFileError("DOWNLOAD_FAILED", error.args[0]) from error

    def contents_of(
        self, registration: Registration, files: HandedFiles
    ) -> dict[str, bytes | NoFileError]:
        """Return each file's content or error, by file id. Raises ScoreError."""
        found: dict[str, bytes | NoFileError] = {}
        latest = monotonic() + _FILES_TIME
        for each in files.assets:
            try:
                found[each.asset_id] = self.content_of(registration, each, latest)
            except NoFileError as error:
                found[each.asset_id] = error
        return found

    def _send(
        self, registration: Registration, url: str, method: str, scope: str, body: Any
    ) -> None:
        sent = {"content": json.dumps(body).encode(), "headers": _JSON}
        with self._services.asked(registration, url, method, scope, sent):
            return


def _checked(data: bytes, file: FileAtPlatform) -> bytes:
    # Platforms write the checksum in hexadecimal digits or in base 64.
    digest = hashlib.sha256(data).digest()
    known = (digest.hex(), base64.b64encode(digest).decode())
    expected = file.sha256_checksum
    if expected and expected.lower() != known[0] and expected != known[1]:
        raise NoFileError("DOWNLOAD_FAILED", say("its checksum is another one"))
    return data


# --- Grade the files of a submission, and write the reports on them


# The type of our reports, and how long what they say may be.
KIND: Final = "dh-grader"
_LONGEST_RESULT: Final = 16
_LONGEST_COMMENT: Final = 500
_PASSED, _NOT_PASSED = "#1B7F4B", "#B45309"


@dataclass(frozen=True, slots=True)
class GradedFiles:
    """The graded files of a submission; ``failures`` has the errors by file id."""

    submission: GradedSubmission | None
    failures: Mapping[str, NoFileError]
    language: Language


def graded_files(
    files: HandedFiles,
    contents: Mapping[str, bytes | NoFileError],
    catalogue: Mapping[str, Exercise],
    *,
    ceiling: FeedbackLevel = FeedbackLevel.FULL,
    for_students: bool = True,
    language: Language | None = None,
) -> GradedFiles:
    """Grade all files of a submission together.

    ``contents`` has the content of each file, or an error, by file id. ``ceiling`` is the highest
    feedback level for students. Without a ``language``, the reports are in the language of the
    tutor who chose the exercises.
    """
    language = language or language_named(files.custom.get("locale", "")) or ENGLISH
    failures = {key: each for key, each in contents.items() if isinstance(each, NoFileError)}
    assignment = _assignment(files.custom, catalogue, ceiling)
    if assignment is None:
        unknown = say("The assignment names no exercise of this service.")
        why = NoFileError("UNKNOWN_EXERCISE", unknown)
        return GradedFiles(None, {each.asset_id: why for each in files.assets}, language)
    names = _names(files)
    entries = tuple(
        HandedFile(Path("/nowhere", names[key]), names[key], content=data)
        for key, data in contents.items()
        if isinstance(data, bytes)
    )
    if not entries:
        return GradedFiles(None, failures, language)
    terms = GradingTerms(
        assignment,
        PASS_MARK,
        feedback=None if for_students else FeedbackLevel.FULL,
        for_students=for_students,
        echo=True,
        language=language,
    )
    found = graded(HandedIn("submission", ", ".join(names.values()), entries), terms)
    for key, name in names.items():
        if key not in failures and (problem := _problem(found, name)):
            failures[key] = NoFileError("UNSUPPORTED_ASSET_TYPE", problem)
    return GradedFiles(found, failures, language)


def report_on(file: FileAtPlatform, found: GradedFiles, now: datetime) -> dict[str, Any]:
    """Return the report on a file: the points of the whole submission, or an error."""
    report: dict[str, Any] = {
        "assetId": file.asset_id,
        "type": KIND,
        "title": "DH Grader",
        "timestamp": now.isoformat(timespec="milliseconds").replace("+00:00", "Z"),
        "priority": 0,
    }
    failure, submission = found.failures.get(file.asset_id), found.submission
    if failure is not None or submission is None:
        code = "DOWNLOAD_FAILED" if failure is None else failure.code
        reason = "" if failure is None else told(failure.reason, found.language.translation)
        return report | {
            "processingProgress": "Failed",
            "errorCode": code,
            "comment": reason[:_LONGEST_COMMENT],
            "visibleToOwner": True,
        }
    earned, most = submission.points, submission.max_points
    # What was not read does not count as 0, so such a submission has no score.
    score = {"scoreGiven": earned, "scoreMaximum": most} if submission.is_complete else {}
    return (
        report
        | score
        | {
            "processingProgress": "Processed",
            # Teachers look first at submissions in which something could not be read.
            "priority": 0 if submission.is_complete else 3,
            "result": points(earned, most).replace(" ", "")[:_LONGEST_RESULT],
            "indicationColor": _PASSED if submission.passed else _NOT_PASSED,
            "indicationAlt": points_in_words(earned, most, found.language.translation),
            "visibleToOwner": True,
        }
    )


def _assignment(
    custom: Mapping[str, str], catalogue: Mapping[str, Exercise], ceiling: FeedbackLevel
) -> Assignment | None:
    wanted = parameters_assignment(
        {"exercise": custom.get("exercise", "")}, "files", "-", catalogue
    )
    if wanted is None or not wanted.exercises:
        return None
    chosen = [(catalogue[each.exercise], each.points) for each in wanted.exercises]
    most = least(ceiling, *(exercise.feedback for exercise, _ in chosen))
    return Assignment(
        tuple(assigned(exercise, None, points) for exercise, points in chosen), feedback=most
    )


def _names(files: HandedFiles) -> dict[str, str]:
    # Names without folders, by file id.
    names: dict[str, str] = {}
    for i, each in enumerate(files.assets):
        name = PurePosixPath(each.filename.replace("\\", "/").replace("\0", "")).name[-100:]
        # A text that was typed at the platform has no name; platforms give it as a web page.
        name = name or ("answer.html" if "html" in each.content_type else "answer.txt")
        names[each.asset_id] = name if name not in names.values() else f"{i}-{name}"
    return names


def _problem(found: GradedSubmission, name: str) -> str:
    unread = next((file.unread[name] for file in found.files if name in file.unread), "")
    if unread or any(file.report for file in found.files if name in file.names):
        return unread
    if problem := next((file.problem for file in found.files if file.problem), ""):
        return problem
    return say(
        "{file} answers nothing; known are files with {endings}",
        file=name,
        endings=" ".join(PASTED_ENDINGS),
    )


# --- Grade handed-in files, one submission after the other


_log = logging.getLogger(__name__)

# How long files are tried.
_GIVEN_UP: Final = timedelta(days=3)


class FileReporting:
    """Grades handed-in files, and sends the reports to the platform."""

    def __init__(
        self,
        engine: Engine,
        secret: Secret,
        catalogue: Mapping[str, Exercise],
        now: Callable[[], datetime] = utc_now,
        chance: Callable[[], float] = random.random,
    ) -> None:
        # ``now`` returns the time, ``chance`` a random number from 0 to 1 for each pause.
        self._engine, self._catalogue = engine, catalogue
        self.now, self._chance = now, chance
        self._platform = PlatformFiles(
            AccessTokens(now, lambda: available_key(engine, secret, now()))
        )

    def send_next(self) -> bool:
        """Grade the next submission and send its reports; return False if none is due."""
        now = self.now()
        taken = in_transaction(self._engine, lambda it: take(it, now))
        if taken is None:
            return False
        refusal: str | None = None
        try:
            self._report(taken)
        except RefusedError as error:
            refusal = error.stored
            _log.warning("LTI: the report was refused (%s): %s", taken.registration.id, error)
        except ScoreError as error:
            self._later(taken, error)
            return True
        except Exception:  # noqa: BLE001 - other files must go on
            _log.exception("LTI: handed-in files could not be graded")
            self._later(taken, ScoreError("failed"))
            return True
        in_transaction(self._engine, lambda it: note_done(it, taken.number, refusal))
        return True

    def next_due(self) -> datetime | None:
        """Return when the next submission may be graded; None if none waits."""
        with self._engine.connect() as connection:
            return next_due(connection)

    def _report(self, taken: TakenFiles) -> None:
        contents = self._platform.contents_of(taken.registration, taken.files)
        found = graded_files(taken.files, contents, self._catalogue)
        for each in taken.files.assets:
            report = report_on(each, found, self.now())
            self._platform.send_report(taken.registration, taken.files.report_url, report)

    def _later(self, taken: TakenFiles, problem: ScoreError) -> None:
        now, number = self.now(), taken.number
        at = now + pause_after(taken.tries, self._chance())
        refusal = problem.stored
        if at > taken.received_at + _GIVEN_UP:
            in_transaction(self._engine, lambda it: note_done(it, number, refusal))
        else:
            in_transaction(self._engine, lambda it: note_later(it, number, at, refusal))
        _log.warning("LTI: handed-in files wait (%s): %s", taken.registration.id, problem)


# --- For tutors: the reports on handed-in files that did not reach a platform


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
                    problem_told(row.refusal, language, of_report=True),
                )
            )
    return found[:_MOST]


def missing_counts(connection: Connection) -> Mapping[str, int]:
    """Return how many reports did not reach each platform, by registration id."""
    counted = select(_OF.registration, func.count().label("number")).where(_TROUBLED)
    rows = connection.execute(counted.group_by(_OF.registration))
    return {row.registration: row.number for row in rows}
