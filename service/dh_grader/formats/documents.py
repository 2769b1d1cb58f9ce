"""Report formats for programs, spreadsheets and pages, and those that platforms read."""

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain, islice
from pathlib import Path
from typing import Any, Final
from xml.etree.ElementTree import Element, indent, tostring

from pydantic import TypeAdapter

from dh_grader.formats import texts
from dh_grader.formats.class_page import class_folder
from dh_grader.formats.graded import (
    NOTHING_ANSWERED,
    NOTHING_READ,
    GradedFile,
    GradedSubmission,
    ReportFormat,
    Setting,
    UnusableSettingError,
    json_document,
    printable,
    single,
)
from dh_grader.formats.texts import (
    NOT_GRADED,
    NOT_PASSED,
    PASSED,
    SIGNS,
    VERDICT_NAMES,
    PartResult,
    distinct_names,
    escaped,
    html_pieces,
    part_details,
    part_results,
    percent,
    points,
    points_in_words,
    style_sheet,
    total_points,
    visible,
)
from dh_grader.grading import PartReport, Report, RowReport, Severity, Verdict
from dh_grader.grading.report import messages_of
from dh_grader.regex import regex
from dh_grader.translations import Language, Translation, joined, paragraph, say, told

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


# --- Formats of platforms: PrairieLearn, JUnit, Gradescope, GitHub annotations, Classroom 50

# --- The ``results.json`` of a PrairieLearn external grader
#
# Source: https://prairielearn.readthedocs.io/en/latest/externalGrading/, "Grading results". An
# unreadable submission is reported as not gradable, so it costs no attempt.


def _prairielearn_document(submission: GradedSubmission, setting: Setting) -> bytes:
    results = part_results(submission, setting.language)
    content = (
        _graded(submission, results, setting.language.translation)
        if submission.is_gradable
        else _not_gradable(results)
    )
    return json_document(content)


def _graded(
    submission: GradedSubmission, results: list[PartResult], translation: Translation | None
) -> dict[str, Any]:
    total = points_in_words(submission.points, submission.max_points, translation)
    return {
        "gradable": True,
        "score": submission.score,
        "message": f"{total}, {percent(submission.score)}",
        "tests": [_prairielearn_test(each) for each in results],
    }


def _prairielearn_test(result: PartResult) -> dict[str, Any]:
    return {
        "name": result.name,
        "points": result.points,
        "max_points": result.max_points,
        "message": "\n".join(result.lines()),
    }


def _not_gradable(results: list[PartResult]) -> dict[str, Any]:
    lines = (
        line if each.report is None else f"{each.name}: {line}"
        for each in results
        for line in each.message_lines()
    )
    return {"gradable": False, "score": 0.0, "format_errors": list(dict.fromkeys(lines))}


_PRAIRIELEARN_MARK: Final = regex(
    rb'\{\s*"gradable": (?:true|false),\s*"score": [\d.]+,\s*"(?:message|format_errors|tests)": '
)

PRAIRIELEARN: Final = ReportFormat(
    single(_prairielearn_document), _PRAIRIELEARN_MARK, is_single=True, for_students=True
)


# --- JUnit XML for GitLab and GitHub Actions: a suite for each submission, a test for each part
#
# Sources: https://docs.gitlab.com/ci/testing/unit_test_reports/ and the schema ``junit-10.xsd`` of
# Jenkins (https://github.com/jenkinsci/xunit-plugin). GitLab shows the name of the class as the
# suite, and drops the second of two tests that share class and name.


def _junit_pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    yield b'<?xml version="1.0" encoding="UTF-8"?>\n<testsuites name="dh-grader">\n'
    distinct = distinct_names()
    for submission in submissions:
        suite = _suite(submission, distinct(submission.name), setting.language)
        indent(suite)
        yield tostring(suite, encoding="utf-8", xml_declaration=False) + b"\n"
    yield b"</testsuites>\n"


def _suite(submission: GradedSubmission, name: str, language: Language) -> Element:
    cases = [_case(each, name) for each in part_results(submission, language)]
    found = Counter(child.tag for case in cases for child in case)
    return _element(
        "testsuite",
        *cases,
        name=name,
        tests=str(len(cases)),
        failures=str(found["failure"]),
        errors=str(found["error"]),
        skipped="0",
        time="0",
    )


def _case(result: PartResult, suite: str) -> Element:
    case = _element("testcase", classname=suite, name=result.name, time="0")
    if not result.passed:
        case.append(_failure(result))
    return case


def _failure(result: PartResult) -> Element:
    is_unread = result.verdict is Verdict.UNREADABLE
    failure = _element(
        "error" if is_unread else "failure",
        message=f"{result.verdict_name}, {result.points_in_words}",
        type=result.verdict.value,
    )
    failure.text = "\n".join([result.points_in_words, *result.lines()])
    return failure


def _element(tag: str, *children: Element, **attributes: str) -> Element:
    # XML may forbid invisible characters.
    made = Element(tag, {name: visible(value) for name, value in attributes.items()})
    made.extend(children)
    return made


_JUNIT_MARK: Final = regex(rb'<\?xml [^>]*>\s*<testsuites name="dh-grader">')

JUNIT: Final = ReportFormat(_junit_pieces, _JUNIT_MARK, for_students=True)


# --- The ``results.json`` of a Gradescope autograder: a test for each part, with its rows
#
# Source: https://gradescope-autograders.readthedocs.io/en/latest/specs/, "Output format".


def _gradescope_document(submission: GradedSubmission, setting: Setting) -> bytes:
    content = {
        "score": submission.points,
        "output": "\n\n".join(
            [_gradescope_total(submission, setting.language.translation), *_tasks(submission)]
        ),
        "output_format": "text",
        "test_name_format": "text",
        "test_output_format": "md",
        "visibility": setting.visibility.value,
        "stdout_visibility": "hidden",
        "tests": [_gradescope_test(each) for each in part_results(submission, setting.language)],
    }
    return json_document(content)


def _gradescope_total(submission: GradedSubmission, translation: Translation | None) -> str:
    if not submission.is_graded:
        problems = "; ".join(submission.problems)
        nothing = say("Nothing could be graded: {problems}", problems=problems)
        return visible(told(nothing, translation))
    return told(paragraph(total_points(submission), _unread(submission)), translation)


def _tasks(submission: GradedSubmission) -> Iterator[str]:
    for file in submission.files:
        yield from map(visible, file.exercise.task)


def _unread(submission: GradedSubmission) -> str:
    if submission.is_gradable:
        return ""
    return NOTHING_READ if submission.is_answered else NOTHING_ANSWERED


def _gradescope_test(result: PartResult) -> dict[str, Any]:
    return {
        "name": result.name,
        "score": result.points,
        "max_score": result.max_points,
        "status": "passed" if result.passed else "failed",
        "output": part_details(result),
    }


_GRADESCOPE_MARK: Final = regex(
    rb'\{\s*"score": [\d.]+,\s*"output": ".{0,60000}",'
    rb'\s*"output_format": "text",\s*"test_name_format": "text",'
)

GRADESCOPE: Final = ReportFormat(
    single(_gradescope_document), _GRADESCOPE_MARK, is_single=True, for_students=True
)


# --- Annotations of GitHub Actions: one for each part that lost points, and one for the total
#
# Source: https://docs.github.com/en/actions/reference/workflow-commands-for-github-actions, and the
# code with which the runner parses them, ``src/Runner.Common/ActionCommand.cs`` of
# https://github.com/actions/runner. The runner shows only ten errors of a step, so all messages on
# a part share one annotation.


# Percent comes first, because all replacements contain it.
_IN_DATA: Final = (("%", "%25"), ("\r", "%0D"), ("\n", "%0A"))
_IN_PROPERTIES: Final = (*_IN_DATA, (":", "%3A"), (",", "%2C"))


def _github_pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    for submission in submissions:
        for result in part_results(submission, setting.language):
            if not result.passed:
                yield _part(result)
        yield _github_total(submission, setting.language.translation)


def _part(result: PartResult) -> bytes:
    title = f"{result.name}: {result.points_in_words}"
    level = "warning" if result.points else "error"
    return _command(level, result.file.file, title, "\n".join(result.lines() or [title]))


def _github_total(submission: GradedSubmission, translation: Translation | None) -> bytes:
    file = submission.files[0].file if len(submission.files) == 1 else ""
    needed = say("{share} is needed to pass.", share=percent(submission.pass_mark))
    if not submission.is_graded:
        return _command("error", file, told(NOT_GRADED, translation), told(needed, translation))
    total = told(paragraph(total_points(submission), needed), translation)
    if submission.passed:
        return _command("notice", file, told(PASSED, translation), total)
    return _command("error", file, told(NOT_PASSED, translation), total)


def _command(level: str, file: str, title: str, message: str) -> bytes:
    properties = {"file": visible(file), "title": title}
    written = ",".join(
        f"{name}={_escaped(value, _IN_PROPERTIES)}" for name, value in properties.items() if value
    )
    return f"::{level} {written}::{_escaped(message, _IN_DATA)}\n".encode()


def _escaped(text: str, replacements: tuple[tuple[str, str], ...]) -> str:
    for sign, replacement in replacements:
        text = text.replace(sign, replacement)
    return text


_GITHUB_MARK: Final = regex(rb"::(?:notice|warning|error) (?:file|title)=")

GITHUB: Final = ReportFormat(_github_pieces, _GITHUB_MARK, is_stream=True, for_students=True)


# --- The ``result.json`` of a Classroom 50 autograder, schema ``classroom50/result/v1``
#
# Source: https://github.com/foundation50/classroom50, ``schemas/result-v1.schema.json``, and its
# wiki, "Advanced Autograding". In Classroom 50, a score is a whole number, so the scores in this
# file count hundredths of a point.


# Each field with the environment variables of the runner; the first that is set counts.
_FIELDS: Final[Mapping[str, tuple[str, ...]]] = {
    "classroom": ("CLASSROOM",),
    "assignment": ("ASSIGNMENT",),
    "owner": ("OWNER", "USERNAME", "GITHUB_ACTOR"),
    "submission": ("SUBMISSION_TAG",),
    "commit": ("COMMIT_URL",),
    "release": ("RELEASE_URL",),
}
_TYPES: Final = ("ASSIGNMENT_TYPE", "MODE")
_HUNDREDTHS: Final = 100


def _classroom50_document(submission: GradedSubmission, setting: Setting) -> bytes:
    tests = [_classroom50_test(each) for each in part_results(submission, setting.language)]
    content = {
        "schema": "classroom50/result/v1",
        **_identity(setting.environment),
        "datetime": setting.now.strftime("%Y-%m-%dT%H:%M:%SZ"),
        "score": sum(test["score"] for test in tests),
        "max-score": sum(test["max-score"] for test in tests),
        "tests": tests,
    }
    return json_document(content)


def _identity(environment: Mapping[str, str]) -> dict[str, str]:
    found = {field: _first(environment, names) for field, names in _FIELDS.items()}
    lacking = [_FIELDS[field][0] for field, value in found.items() if not value]
    if lacking:
        raise UnusableSettingError(
            "the runner of Classroom 50 sets environment variables that are not here: "
            f"{', '.join(lacking)}"
        )
    return {
        "assignment_type": _first(environment, _TYPES) or "individual",
        **found,
        "review": environment.get("REVIEW_URL") or found["commit"],
    }


def _first(environment: Mapping[str, str], names: tuple[str, ...]) -> str:
    return next((environment[name] for name in names if environment.get(name)), "")


def _classroom50_test(result: PartResult) -> dict[str, Any]:
    return {
        "test-name": result.name,
        "passed": result.passed,
        # Not rounded up to points that were not earned.
        "score": int(result.points * _HUNDREDTHS + 1e-3),
        "max-score": round(result.max_points * _HUNDREDTHS),
        "output": "\n".join(result.lines()),
    }


_CLASSROOM50_MARK: Final = regex(rb'\{\s*"schema": "classroom50/result/v1",')

CLASSROOM50: Final = ReportFormat(
    single(_classroom50_document), _CLASSROOM50_MARK, is_single=True, for_students=True
)
