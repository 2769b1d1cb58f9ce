"""JUnit XML for GitLab and GitHub Actions: a suite for each submission, a test for each part.

Sources: https://docs.gitlab.com/ci/testing/unit_test_reports/ and the schema ``junit-10.xsd`` of
Jenkins (https://github.com/jenkinsci/xunit-plugin). GitLab shows the name of the class as the
suite, and drops the second of two tests that share class and name.
"""

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Final
from xml.etree.ElementTree import Element, indent, tostring

from service.formats.shared.graded import GradedSubmission
from service.formats.shared.part_results import PartResult, distinct_names, part_results
from service.formats.shared.plain_text import visible
from service.formats.shared.report_format import ReportFormat, Setting
from service.grading import Verdict
from service.regex import regex
from service.translations import Language


def _pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
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


_MARK: Final = regex(rb'<\?xml [^>]*>\s*<testsuites name="dh-grader">')

JUNIT: Final = ReportFormat(_pieces, _MARK, for_students=True)
