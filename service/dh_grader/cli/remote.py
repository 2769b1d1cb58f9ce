"""Let a server grade instead of this program, and continue an interrupted run.

`dh-grader grade` imports this file always, so the functions that call a server import the client.
"""

import hashlib
import json
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from http import HTTPStatus
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, Final

from dh_grader.cli import spoken
from dh_grader.cli.running import mapped_in_threads
from dh_grader.cli.terminal import complain, give_up, installed_exercise
from dh_grader.formats.documents import read_report, rendered
from dh_grader.formats.graded import GradedSubmission
from dh_grader.formats.local_grading import GradingTerms, graded, unknown_part
from dh_grader.formats.texts import visible
from dh_grader.grading import Report, Submission
from dh_grader.grading.report import rounded_points
from dh_grader.regex import regex
from dh_grader.settings import Settings
from dh_grader.submissions import (
    AssignedExercise,
    Assignment,
    ExerciseOutline,
    PartOutline,
    SetExercise,
)
from dh_grader.submissions.bodies import GradeRequest, UnknownExerciseError
from dh_grader.submissions.files import HandedIn
from dh_grader.translations import say

if TYPE_CHECKING:
    from dh_grader.client import GraderClient, GraderClientError

# --- Use a server that grades instead of this program


# Concurrent requests without --jobs: the server has work while answers are on their way.
REQUESTS: Final = 4


@contextmanager
def server_of(settings: Settings) -> Iterator["GraderClient | None"]:
    """Open a client of the server in the settings; yield None if no server is set.

    Exits with code 2 if the server's address or the key is invalid.
    """
    if settings.server is None:
        yield None
        return
    from dh_grader.client import GraderClient

    try:
        client = GraderClient(settings.server, _key(settings), language=settings.language)
    except ValueError as error:
        give_up(visible(spoken(error.args[0])))
    with client:
        yield client


def _key(settings: Settings) -> str | None:
    return None if settings.key is None else settings.key.get_secret_value()


def set_exercise(exercise_id: str, *, server: "GraderClient | None") -> SetExercise:
    """Return the exercise from the server, or from this installation if ``server`` is None.

    Raises UnknownExerciseError.
    """
    if server is None:
        return installed_exercise(exercise_id)
    from dh_grader.client import GraderClientError

    try:
        return exercise_of(server, exercise_id)
    except GraderClientError as error:
        give_up(visible(spoken(error.args[0])))


def require_no_own_files(assignment: Assignment) -> None:
    """Exit with code 2 if an exercise is a local file, which the server does not have."""
    for assigned in assignment.exercises:
        if assigned.path is not None:
            give_up(
                say(
                    "{file} is a file of yours, and a server grades by its own exercises: name "
                    "one of them by its id.",
                    file=str(assigned.path),
                )
            )


@contextmanager
def graded_by(
    server: "GraderClient",
    terms: GradingTerms,
    found: Sequence[HandedIn],
    requests: int,
    output: Path | None,
    settings: Settings,
) -> Iterator[Iterator[GradedSubmission]]:
    """Yield an iterator over the submissions in order, graded by the server.

    ``requests`` is the number of concurrent requests.
    """
    # If the server fails, the reports so far stay in the journal beside the output.

    journal = Journal(journal_beside(output))
    grading = RemoteGrading(server, _key(settings), terms, journal)
    with mapped_in_threads(grading.graded, found, requests) as graded:
        yield graded
    if not grading.ungraded:
        journal.remove()
        return
    complain(
        say(
            "Not graded: {count} of {all}, for {reason}",
            count=len(grading.ungraded),
            all=len(found),
            reason=visible(grading.reason),
        )
    )
    complain(
        say(
            "The reports on the others are kept in {file}. Give the same command again, and only "
            "the rest is sent.",
            file=visible(str(journal.path)),
        )
    )


# --- The journal of reports from a server, with which an interrupted run can continue
#
# Each line is a JSON object with a report, and the digest of its submission and options.


_LINE: Final = regex(rb'\{"digest": "([0-9a-f]{64})", "report": (\{.*\})\}\n')
# The name of a journal without an output file.
_DEFAULT_NAME: Final = "dh-grader"


def journal_beside(output: Path | None) -> Path:
    """Return the path of the journal of a run that writes to ``output``."""
    # The name begins with a dot, so that no run takes the journal for a submission.
    if output is None or (output.exists() and not (output.is_file() or output.is_dir())):
        return Path(f".{_DEFAULT_NAME}.graded")
    named = output.resolve() if output.name in ("", "..") else output
    return named.with_name(f".{named.name}.graded")


def digest(content: Sequence[object]) -> str:
    """Return the SHA-256 digest of the JSON text of ``content``."""
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()


class Journal:
    """Reads the reports of earlier runs from a file, and appends the reports of this run."""

    # Several threads may use one journal. If the file cannot be written, a warning is printed and
    # the run continues.

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = Lock()
        self._places = dict(_places(path))
        self._is_writable = True

    def report(self, of: str) -> Report | None:
        """Return the report that an earlier run wrote for this digest, or None."""
        if of not in self._places:
            return None
        try:
            with self.path.open("rb") as file:
                file.seek(self._places[of])
                found = _LINE.fullmatch(file.readline())
            return read_report(found[2]) if found else None
        except (OSError, ValueError):
            return None

    def add(self, of: str, report: Report) -> None:
        """Append a report and its digest to the journal."""
        # Begin with a line break: the last line may be incomplete.
        line = b'\n{"digest": "%b", "report": %b}\n' % (of.encode(), rendered(report))
        with self._lock:
            if not self._is_writable:
                return
            try:
                with self.path.open("ab") as file:
                    file.write(line)
            except OSError as error:
                self._is_writable = False
                complain(
                    say(
                        "{file}: cannot be written: {reason}. If this run is interrupted, the next "
                        "one sends every submission again.",
                        file=str(self.path),
                        reason=str(error.strerror),
                    )
                )

    def remove(self) -> None:
        """Delete the journal."""
        self.path.unlink(missing_ok=True)


def _places(path: Path) -> list[tuple[str, int]]:
    # Return the digests, and the offsets of their lines; other lines are ignored.
    found = []
    try:
        with path.open("rb") as file:
            place = 0
            for line in file:
                if match := _LINE.fullmatch(line):
                    found.append((match[1].decode(), place))
                place += len(line)
    except OSError:
        return []
    return found


# --- Let a server grade submissions


# The statuses that concern the key or the connection; other client errors concern the answers.
_CONCERNING_ALL: Final = {HTTPStatus.UNAUTHORIZED, HTTPStatus.FORBIDDEN, HTTPStatus.REQUEST_TIMEOUT}


def exercise_of(server: "GraderClient", exercise_id: str) -> ExerciseOutline:
    """Return an exercise of the server. Raises UnknownExerciseError or GraderClientError."""
    from dh_grader.client import RequestRefusedError

    try:
        told = server.exercise(exercise_id)
    except RequestRefusedError as error:
        if error.code != "unknown-exercise":
            raise
        known = tuple(each.id for each in server.exercises())
        raise UnknownExerciseError(exercise_id, known) from error
    parts = tuple(PartOutline(part.id, part.title, part.points) for part in told.parts)
    return ExerciseOutline(told.id, told.version, told.title, told.source, told.feedback, parts)


class RemoteGrading:
    """Lets a server grade submissions, unless the journal already has their reports.

    ``ungraded`` has the names of the submissions that the server could not grade, and ``reason``
    says why.
    """

    # Several threads may use one object. The journal keeps the reports for each ``key`` apart,
    # because the feedback of a server may depend on the key.

    def __init__(
        self, server: "GraderClient", key: str | None, terms: GradingTerms, journal: Journal
    ) -> None:
        self._server = server
        self._key = key
        self._terms = terms
        self._journal = journal
        self._has_ended = False
        self.reason = ""
        self.ungraded: set[str] = set()

    def graded(self, handed: HandedIn) -> GradedSubmission:
        """Grade a submission; return a report or an error message for each exercise."""
        from dh_grader.client import GraderClientError

        def report_on(
            body: GradeRequest, assigned: AssignedExercise, terms: GradingTerms
        ) -> tuple[Report | None, str]:
            if problem := unknown_part(body, assigned):
                return None, problem
            try:
                return self._report(assigned, terms.submission(body, assigned)), ""
            except GraderClientError as error:
                if _concerns_these(error):
                    refused = say("is refused by the server: {reason}", reason=error.args[0])
                    return None, spoken(refused)
                self.reason = self.reason or error.args[0]
                self.ungraded.add(handed.name)
                return None, spoken(say("is not graded: {reason}", reason=error.args[0]))

        return graded(handed, self._terms, report_on)

    def _report(self, assigned: AssignedExercise, submission: Submission) -> Report:
        from dh_grader.client import GraderClientError

        exercise = assigned.exercise
        parts = tuple(part.id for part in exercise.parts)
        terms = (submission.angle_unit, submission.feedback, submission.echo)
        asked = (self._server.server, self._key, exercise.id, exercise.version)
        of = digest((*asked, parts, terms, submission.answers))
        if (known := self._journal.report(of)) is not None:
            return known
        if self._has_ended:
            raise GraderClientError(self.reason)
        try:
            report = self._server.grade(
                exercise.id,
                submission.answers,
                angle_unit=submission.angle_unit,
                feedback=submission.feedback,
                echo=submission.echo,
            )
        except GraderClientError as error:
            if _concerns_all(error):
                self._has_ended = True
            raise
        report = restricted(report, parts)
        self._journal.add(of, report)
        return report


def restricted(report: Report, parts: Collection[str]) -> Report:
    """Return the report, limited to these parts of the exercise."""
    kept = tuple(part for part in report.parts if part.part in parts)
    points = rounded_points(sum(part.points for part in kept))
    max_points = rounded_points(sum(part.max_points for part in kept))
    score = round(points / max_points, 6)
    return replace(report, parts=kept, points=points, max_points=max_points, score=score)


def _concerns_all(error: "GraderClientError") -> bool:
    # True if other submissions would cause the same error.
    from dh_grader.client import RequestRefusedError

    if isinstance(error, RequestRefusedError):
        return error.status in _CONCERNING_ALL or error.is_temporary
    return True


def _concerns_these(error: "GraderClientError") -> bool:
    # True if the server refuses these answers, so that sending them again is useless.
    from dh_grader.client import RequestRefusedError

    is_refusal = isinstance(error, RequestRefusedError) and 400 <= error.status < 500
    return is_refusal and not _concerns_all(error)
