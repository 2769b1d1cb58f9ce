"""Documents in the formats of programs, spreadsheets and pages: Markdown, JSON, HTML, CSV."""

import json
import re
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from itertools import chain, islice
from pathlib import Path
from typing import Final

from pydantic import TypeAdapter

from dh_grader.formats import texts
from dh_grader.formats.class_page import class_folder
from dh_grader.formats.graded import GradedFile, GradedSubmission, ReportFormat, Setting, printable
from dh_grader.formats.texts import (
    SIGNS,
    VERDICT_NAMES,
    PartResult,
    escaped,
    html_pieces,
    part_details,
    part_results,
    percent,
    points,
    points_in_words,
    style_sheet,
)
from dh_grader.grading import PartReport, Report, RowReport, Severity
from dh_grader.grading.report import messages_of
from dh_grader.regex import regex
from dh_grader.translations import Language, Translation, joined, say, told

# --- GitHub's Markdown for the summary of a job or a comment on a pull request
#
# GitHub takes 1 MiB of summary for a step and 65,536 characters of a comment.


_MARKDOWN_HEAD: Final = (say("submission"), say("points"), say("score"), say("passed"))
_ALIGNED: Final = "|---|--:|--:|:-:|\n"


def _markdown_pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    details = []
    head = " | ".join(told(each, setting.language.translation) for each in _MARKDOWN_HEAD)
    yield f"| {head} |\n{_ALIGNED}".encode()
    for submission in submissions:
        yield _line(submission, setting.language.translation).encode()
        details.append(_details(submission, setting.language).encode())
    yield from details


def _line(submission: GradedSubmission, translation: Translation | None) -> str:
    name = escaped(submission.name)
    if not submission.is_complete:
        return f"| {name} | | {told(say('not graded'), translation)} | ✗ |\n"
    earned = points(submission.points, submission.max_points)
    sign = "✓" if submission.passed else "✗"
    return f"| {name} | {earned} | {percent(submission.score)} | {sign} |\n"


def _details(submission: GradedSubmission, language: Language) -> str:
    sections = [f"\n### {escaped(submission.name)}\n"]
    sections += (
        f"\n**{escaped(result.name)}:** {result.verdict_name}, {result.points_in_words}\n\n"
        f"{part_details(result)}"
        for result in part_results(submission, language)
    )
    return "".join(sections)


_MARKDOWN_MARK: Final = regex(rb"(?:\| [^|\n]{1,40} ){4}\|\n" + re.escape(_ALIGNED).encode())

MARKDOWN: Final = ReportFormat(_markdown_pieces, _MARKDOWN_MARK, for_students=True)


# --- Reports as a JSON list with one entry for each file


_REPORT: Final = TypeAdapter(Report)


def rendered(report: Report, *, indent: int | None = None) -> bytes:
    """Return the report as UTF-8 JSON without the fields that are None."""
    return _REPORT.dump_json(report, exclude_none=True, indent=indent)


def read_report(content: bytes) -> Report:
    """Parse a report from the JSON that ``rendered`` made. Raises pydantic.ValidationError."""
    return _REPORT.validate_json(content)


def entries(submissions: Iterable[GradedSubmission]) -> Iterator[bytes]:
    """Yield a line of JSON for each file, with its report, its error, or both."""
    for submission in submissions:
        for file in submission.files:
            yield printable(_entry(submission, file))


def _entry(submission: GradedSubmission, file: GradedFile) -> bytes:
    head: dict[str, str | bool | list[str]] = {
        "submission": _encodable(submission.name),
        "file": _encodable(file.file),
        "exercise": file.exercise.id,
        "passed": submission.passed,
    }
    if file.by_hand:
        head["error"] = _encodable(file.by_hand)
    if file.beside:
        head["unread"] = [_encodable(each) for each in file.beside]
    if file.report is None:
        return json.dumps(head).encode()
    return json.dumps(head).encode()[:-1] + b', "report": %b}' % rendered(file.report)


def _encodable(text: str) -> str:
    # Names of files may have bytes that are not UTF-8.
    return text.encode("utf-8", "replace").decode()


def _json_pieces(submissions: Iterable[GradedSubmission], _: Setting) -> Iterator[bytes]:
    opening = b"[\n"
    for entry in entries(submissions):
        yield opening + entry
        opening = b",\n"
    yield b"[]\n" if opening == b"[\n" else b"\n]\n"


JSON: Final = ReportFormat(_json_pieces, regex(rb'\[\n\{"submission": "'))


# --- Reports as JSON lines: one line for each file, written as soon as the file is graded


def _jsonl_pieces(submissions: Iterable[GradedSubmission], _: Setting) -> Iterator[bytes]:
    for entry in entries(submissions):
        yield entry + b"\n"


# A shard begins with its number.
_JSONL_MARK: Final = regex(rb'\{"submission": "|\{"shard": \d+, "shards": ')

JSONL: Final = ReportFormat(_jsonl_pieces, _JSONL_MARK, is_stream=True)


# --- A page for students: a card for each part, which shows how each entry was read


STYLE: Final = style_sheet(Path(__file__).with_name("templates") / "html.css")


def page_of(submission: GradedSubmission, language: Language) -> bytes:
    """Return the page of one submission."""
    titles = [file.exercise.title for file in submission.files]
    return b"".join(_page(" · ".join(titles), [submission], language))


def _html_pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    rest = iter(submissions)
    first = tuple(islice(rest, 2))
    names = [first[0].learner] if len(first) == 1 else []
    title = " · ".join([*names, *(each.title for each in setting.exercises)])
    yield from _page(title, chain(first, rest), setting.language)


def _page(
    title: str, submissions: Iterable[GradedSubmission], language: Language
) -> Iterator[bytes]:
    yield from html_pieces(
        "formats/templates/submissions.html",
        language=language,
        title=title,
        style=STYLE,
        submissions=submissions,
        columns_of=_columns_of,
        part_results=partial(part_results, language=language),
        points=points,
        points_in_words=partial(points_in_words, translation=language.translation),
        verdict_names=VERDICT_NAMES,
        signs=SIGNS,
    )


def _columns_of(rows: Sequence[RowReport]) -> list[str]:
    return [cell.label for cell in max((row.cells for row in rows), key=len)]


_HTML_MARK: Final = regex(
    rb'<!doctype html>.{0,500}?<meta name="generator" content="DH Grader', re.DOTALL
)

HTML: Final = ReportFormat(
    _html_pieces,
    _HTML_MARK,
    for_students=True,
    shows_entries=True,
    folder=class_folder(_html_pieces),
)


# --- Grades for the gradebook of a course: one line for each learner, with Moodle's headings


def _gradebook_pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    yield texts.line(texts.GRADEBOOK_HEAD)
    for submission in submissions:
        yield texts.line(_gradebook_cells(submission, setting))


def _gradebook_cells(submission: GradedSubmission, setting: Setting) -> list[str | float | None]:
    return [
        submission.learner,
        # On import, an empty grade keeps the old grade. What was not read does not count as 0.
        submission.points if submission.is_complete else None,
        submission.max_points,
        comment(submission, setting.language),
    ]


def comment(submission: GradedSubmission, language: Language) -> str:
    """Return the points of each part in one line."""
    results = part_results(submission, language)
    return "; ".join(f"{each.name}: {_earned(each, language)}" for each in results)


def _earned(result: PartResult, language: Language) -> str:
    if result.report is None:
        return result.file.problem
    if result.is_unread:
        return told(say("could not be read"), language.translation)
    shown = points(result.points, result.max_points)
    # Beside the grade of a worksheet, which has the decimal sign of its language.
    return shown.replace(".", ",") if language.code in _WITH_DECIMAL_COMMA else shown


_WITH_DECIMAL_COMMA: Final = frozenset({"de", "es", "fr"})

_GRADEBOOK_MARK: Final = regex(re.escape(",".join(texts.GRADEBOOK_HEAD)).encode() + b"\r?\n")

GRADEBOOK: Final = ReportFormat(_gradebook_pieces, _GRADEBOOK_MARK)


# --- Points as comma-separated values: a line for each submission, a column for each part


_CSV_HEAD: Final = ("submission", "points", "max_points", "score", "passed", "problem", "messages")
# Messages that cost points or may name a slip. Notes and hints are not listed.
_COUNTED: Final = (Severity.ERROR, Severity.WARNING)


def _csv_pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    columns = [f"{each.id}.{part.id}" for each in setting.exercises for part in each.parts]
    yield texts.line([*_CSV_HEAD, *columns])
    for submission in submissions:
        yield texts.line(_csv_cells(submission, setting))


def _csv_cells(submission: GradedSubmission, setting: Setting) -> list[str | float | None]:
    is_complete = submission.is_complete
    results = part_results(submission, setting.language)
    # If something was not graded, the points are empty.
    return [
        submission.name,
        submission.points if is_complete else None,
        submission.max_points,
        _share(submission.score) if is_complete else None,
        "yes" if submission.passed else "no",
        told(joined("; ", submission.problems), setting.language.translation),
        " ".join(code for each in results if each.report for code in _codes(each.report)),
        *(None if each.is_unread else each.points for each in results),
    ]


def _share(score: float) -> str:
    # A share of 1 needs more decimals than points.
    return f"{score:.6f}".rstrip("0").rstrip(".")


def _codes(part: PartReport) -> list[str]:
    found = (message.code for message, _, _ in messages_of(part) if message.severity in _COUNTED)
    return [f"{part.part}.{code}" for code in dict.fromkeys(found)]


CSV: Final = ReportFormat(_csv_pieces, regex(re.escape(",".join(_CSV_HEAD)).encode()))
