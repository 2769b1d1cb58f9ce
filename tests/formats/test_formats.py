"""Test every report format."""

import re
import unicodedata
from collections.abc import Iterator
from pathlib import Path

import pytest
from dh_grader.formats import FORMAT_NAMES, documents, report_format, terminal
from dh_grader.formats.graded import GradedSubmission, ReportFormat, UnusableSettingError
from dh_grader.formats.texts import distinct_names

from tests.formats.submissions import cases, document, graded, setting
from tests.together import together

SINGLE = {"gradescope", "classroom50", "prairielearn"}
FOR_STUDENTS = {*SINGLE, "html", "junit", "markdown", "github"}


def test_each_format_is_listed() -> None:
    defined = {
        name.lower()
        for module in (documents, terminal)
        for name, value in vars(module).items()
        if isinstance(value, ReportFormat)
    }
    assert set(FORMAT_NAMES) == defined
    assert {"text", "json", "html", "csv"} | SINGLE <= set(FORMAT_NAMES)


def test_documents_for_platforms_contain_one_submission() -> None:
    assert {name for name in FORMAT_NAMES if report_format(name).is_single} == SINGLE
    right, empty = cases()["right"], cases()["empty"]
    for name in SINGLE:
        with pytest.raises(UnusableSettingError, match="one submission"):
            document(name, right, empty)
        with pytest.raises(UnusableSettingError, match="one submission"):
            document(name)


def test_the_formats_for_students_are_known() -> None:
    assert {name for name in FORMAT_NAMES if report_format(name).for_students} == FOR_STUDENTS


def commands(line: str) -> Iterator[str]:
    if line.lstrip().startswith("::"):
        yield line
    yield from re.findall(r"##(?:vso|teamcity|\w*)\[", line)


@pytest.mark.long
@together("case", cases())
@together("name", sorted(FORMAT_NAMES))
def test_no_output_has_commands_or_control_characters(name: str, case: str) -> None:
    printed = document(name, cases()[case])
    if name != "text" or case != "unusable":  # its problem is on standard error
        assert printed.endswith("\n")
    assert printed == document(name, cases()[case])
    kinds = ("Cc", "Cs") if name in ("json", "jsonl") else ("Cc", "Cs", "Cf", "Cn")
    assert {c for c in printed if unicodedata.category(c) in kinds} <= {"\n", "\r"}
    assert "\r" not in printed.replace("\r\n", "")
    if name != "github":
        assert [found for line in re.split("[\r\n]", printed) for found in commands(line)] == []


@pytest.mark.parametrize("name", ["json", "jsonl", "csv", "gradebook", "junit", "text", "html"])
def test_submissions_are_written_while_later_ones_are_graded(name: str) -> None:
    taken = 0

    def many() -> Iterator[GradedSubmission]:
        nonlocal taken
        for i in range(50):
            taken = i
            yield graded({}, f"{i}.json")

    ahead = 0
    for written, _ in enumerate(report_format(name).pieces(many(), setting())):
        ahead = max(ahead, taken - written)
    assert taken == 49
    # The format text waits for nine submissions: then each gets only one line.
    assert ahead <= (8 if name == "text" else 1)


def test_parts_with_the_same_name_get_distinct_names() -> None:
    distinct = distinct_names()
    assert [distinct(name) for name in ("A", "A (2)", "A", "A", "B\n", "B\r")] == [
        "A", "A (2)", "A (3)", "A (4)", "B\ufffd", "B\ufffd (2)",
    ]  # fmt: skip


def test_the_page_on_formats_names_every_format() -> None:
    page = (Path(__file__).parents[2] / "docs" / "formats.md").read_text(encoding="utf-8")
    table = page.partition("| format |")[2].partition("\n\n")[0]
    assert {name for name in FORMAT_NAMES if f"`{name}`" in table} == set(FORMAT_NAMES)
    assert {name for name in FORMAT_NAMES if f"--format {name}" in page} == set(FORMAT_NAMES)
