"""Grade the files of a submission, and write the reports on them."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path, PurePosixPath
from typing import Any, Final

from service.catalogue import Exercise, FeedbackLevel
from service.catalogue.feedback_level import least
from service.formats.shared.graded import GradedSubmission
from service.formats.shared.plain_text import points, points_in_words
from service.local_grading import GradingTerms, graded
from service.lti.handed_files.notices import FileAtPlatform, HandedFiles
from service.lti.handed_files.platform_files import NoFileError
from service.lti.linking import parameters_assignment
from service.submissions.assignment import PASS_MARK, Assignment, assigned
from service.submissions.file_content import PASTED_ENDINGS
from service.submissions.handed_in import HandedFile, HandedIn
from service.translations import ENGLISH, Language, language_named, say, told

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
    feedback level for students.
    """
    # Without a ``language``, the reports are in the language of the tutor who chose the exercises.
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
