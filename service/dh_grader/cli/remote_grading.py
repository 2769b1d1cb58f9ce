"""Let a server grade submissions, and keep the reports until all are there.

This file loads httpx, so ``remote.py`` imports it late.
"""

import hashlib
import json
from collections.abc import Collection, Sequence
from dataclasses import replace
from http import HTTPStatus
from pathlib import Path
from threading import Lock
from typing import Final

from dh_grader.cli.terminal import complain, spoken
from dh_grader.client import GraderClient, GraderClientError, RequestRefusedError
from dh_grader.formats.documents import read_report, rendered
from dh_grader.formats.graded import GradedSubmission, GradingTerms, graded, unknown_part
from dh_grader.grading import Report, Submission
from dh_grader.grading.report import rounded_points
from dh_grader.regex import regex
from dh_grader.submissions import AssignedExercise, ExerciseOutline, PartOutline
from dh_grader.submissions.bodies import GradeRequest, UnknownExerciseError
from dh_grader.submissions.files import HandedIn
from dh_grader.translations import reason_of, say

# --- Let a server grade submissions


# The statuses that concern the key or the connection; other client errors concern the answers.
_CONCERNING_ALL: Final = {HTTPStatus.UNAUTHORIZED, HTTPStatus.FORBIDDEN, HTTPStatus.REQUEST_TIMEOUT}


def exercise_of(server: GraderClient, exercise_id: str) -> ExerciseOutline:
    """Return an exercise of the server. Raises UnknownExerciseError or GraderClientError."""
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
    says why. Several threads may use one object.
    """

    # The journal keeps the reports for each ``key`` apart,
    # because the feedback of a server may depend on the key.

    def __init__(
        self, server: GraderClient, key: str | None, terms: GradingTerms, journal: "Journal"
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


def _concerns_all(error: GraderClientError) -> bool:
    # True if other submissions would cause the same error.
    if isinstance(error, RequestRefusedError):
        return error.status in _CONCERNING_ALL or error.is_temporary
    return True


def _concerns_these(error: GraderClientError) -> bool:
    # True if the server refuses these answers, so that sending them again is useless.
    is_refusal = isinstance(error, RequestRefusedError) and 400 <= error.status < 500
    return is_refusal and not _concerns_all(error)


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
    """Reads the reports of earlier runs from a file, and appends the reports of this run.

    Several threads may use one journal. If the file cannot be written, a warning is printed and the
    run continues.
    """

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
                        "{file} cannot be written: {reason}. If this run is interrupted, the next "
                        "one sends every submission again.",
                        file=str(self.path),
                        reason=reason_of(error),
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
