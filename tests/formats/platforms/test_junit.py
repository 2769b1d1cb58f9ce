"""JUnit XML follows its schema and GitLab's rules."""

# Schema: junit-10.xsd (https://github.com/jenkinsci/xunit-plugin). Rules of GitLab:
# https://docs.gitlab.com/ci/testing/unit_test_reports/, lib/gitlab/ci/parsers/test/junit.rb.

from collections.abc import Mapping
from xml.etree.ElementTree import Element, fromstring

import pytest

from tests.formats.submissions import cases, document

# For each element: its required attributes, its optional attributes, and its children.
RULES: Mapping[str, tuple[set[str], set[str], set[str]]] = {
    "testsuites": (set(), {"name", "time", "tests", "failures", "errors"}, {"testsuite"}),
    "testsuite": (
        {"name", "tests", "failures", "errors"},
        {
            "group",
            "time",
            "skipped",
            "timestamp",
            "hostname",
            "id",
            "package",
            "file",
            "log",
            "url",
        },
        {"testsuite", "properties", "testcase", "system-out", "system-err"},
    ),
    "testcase": (
        {"name"},
        {"time", "classname", "group"},
        {"skipped", "error", "failure", "system-out", "system-err"},
    ),
    "failure": (set(), {"type", "message"}, set()),
    "error": (set(), {"type", "message"}, set()),
}


def check(element: Element) -> None:
    needed, allowed, children = RULES[element.tag]
    assert needed <= set(element.attrib) <= needed | allowed
    for child in element:
        assert child.tag in children
        check(child)


def read(*names: str) -> Element:
    root = fromstring(document("junit", *(cases()[name] for name in names)))
    assert root.tag == "testsuites"
    check(root)
    return root


def test_every_document_follows_the_schema() -> None:
    root = read(*cases())
    keys = [(case.get("classname"), case.get("name")) for case in root.iter("testcase")]
    # GitLab drops the second of two with the same class and name.
    assert len(set(keys)) == len(keys)
    for suite in root:
        assert int(suite.get("tests", "")) == len(suite.findall("testcase")) > 0
        assert int(suite.get("failures", "")) == len(suite.findall("testcase/failure"))
        assert int(suite.get("errors", "")) == len(suite.findall("testcase/error"))
        # GitHub Actions reads numbers here.
        assert {float(each.get("time", "nan")) for each in (suite, *suite)} == {0.0}


def test_a_right_part_passes_and_a_wrong_one_fails() -> None:
    [suite] = read("right")
    assert [list(case) for case in suite] == [[], []]
    [suite] = read("wrong")
    table = suite[0][0]
    assert (table.tag, table.get("type")) == ("failure", "partial")
    assert table.get("message") == "partial, 4 / 8 points"
    # GitLab shows only the text.
    assert str(table.text).startswith("4 / 8 points\n✗ row 2 alpha: ")


@pytest.mark.parametrize("case", ["unreadable", "unusable"])
def test_an_unreadable_part_is_an_error(case: str) -> None:
    [suite] = read(case)
    assert [[child.tag for child in each] for each in suite] == [["error"], ["error"]]


def test_without_submissions_there_is_an_empty_document() -> None:
    assert len(read()) == 0
