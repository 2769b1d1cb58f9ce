"""Test reports in JSON, CSV and HTML."""

import ast
import csv
import io
import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from dh_grader.formats import texts as html_templates
from dh_grader.formats import texts as spreadsheet
from dh_grader.formats.documents import rendered
from dh_grader.formats.texts import lines, own_html
from dh_grader.grading import (
    CellReport,
    Correction,
    Feedback,
    FeedbackLevel,
    PartReport,
    Place,
    Report,
    RowReport,
    Severity,
    Verdict,
)
from dh_grader.translations import say
from jinja2 import Environment, UndefinedError
from playwright.sync_api import expect

from tests.browser.fixtures import APPEARANCES, Visit
from tests.formats.html_reader import PageReader
from tests.formats.submissions import HOSTILE, WRITTEN, cases, document
from tests.translations.pseudo import PSEUDO

MESSAGE = Feedback(
    "sign",
    Severity.ERROR,
    "Vorzeichen: −θ₁",
    places=(Place("1"),),
    span=(0, 2),
    correction=Correction("q1", "q_{1}"),
    values={"q1": 0.5, "w": "x"},
)
CELL = CellReport("a", Verdict.INCORRECT, (MESSAGE,))
ROW = RowReport("1", Verdict.INCORRECT, 0.0, 1.0, (CELL,))
PART = PartReport("table", "dh_table", Verdict.INCORRECT, 0.0, 1.0, False, (ROW,))
REPORT = Report("arm", "v1", "1.0", FeedbackLevel.HINTS, True, 0.0, 1.0, 0.0, (PART,))


def test_a_report_matches_the_contract_without_empty_fields() -> None:
    cell = {
        "label": "a",
        "verdict": "incorrect",
        "feedback": [
            {
                "code": "sign",
                "severity": "error",
                "message": "Vorzeichen: −θ₁",
                "places": [{"row": "1"}],
                "span": [0, 2],
                "correction": {"text": "q1", "latex": "q_{1}"},
                "values": {"q1": 0.5, "w": "x"},
            }
        ],
    }
    row = {
        "label": "1", "verdict": "incorrect", "points": 0.0, "max_points": 1.0,
        "cells": [cell], "feedback": [],
    }  # fmt: skip
    part = {
        "part": "table", "kind": "dh_table", "verdict": "incorrect", "points": 0.0,
        "max_points": 1.0, "follow_through": False, "rows": [row], "feedback": [], "lost": [],
    }  # fmt: skip
    expected = {
        "exercise": "arm", "version": "v1", "grader": "1.0", "feedback": "hints",
        "gradable": True, "points": 0.0, "max_points": 1.0, "score": 0.0, "parts": [part],
    }  # fmt: skip
    assert json.loads(rendered(REPORT)) == expected
    assert json.loads(rendered(REPORT, indent=2)) == expected
    assert b"\n" not in rendered(REPORT)


def test_nan_is_written_as_valid_json() -> None:
    undefined = Feedback("u", Severity.ERROR, "m", values={"yours": float("nan")})
    part = PartReport("t", "k", Verdict.INCORRECT, 0, 1, False, (), (undefined,))
    report = Report("arm", "v1", "1.0", FeedbackLevel.HINTS, True, 0, 1, 0, (part,))
    content = rendered(report)
    assert b"NaN" not in content
    json.loads(content, parse_constant=pytest.fail)


def test_the_list_has_an_entry_for_each_file() -> None:
    assert json.loads(document("json")) == []
    [right] = json.loads(document("json", cases()["right"]))
    assert right == {
        "submission": "folder/anna.json", "file": "folder/anna.json", "exercise": "planar-rrr",
        "passed": True, "report": json.loads(rendered(report_on("right"))),
    }  # fmt: skip
    entries = json.loads(document("json", *cases().values()))
    assert {tuple(sorted(entry)) for entry in entries} == {
        ("exercise", "file", "passed", "report", "submission"),
        ("error", "exercise", "file", "passed", "submission"),
        ("error", "exercise", "file", "passed", "report", "submission"),
    }
    assert [entry["file"] for entry in entries[-2:]] == ["anna/one.json", ""]


def test_hostile_texts_come_back_unchanged() -> None:
    [entry] = json.loads(document("json", cases()["hostile words"]))
    [message, *_] = entry["report"]["parts"][0]["feedback"]
    assert message["message"] == message["suggestion"] == WRITTEN
    # In names of files, a byte that is not UTF-8 is replaced.
    assert entry["file"] == HOSTILE.replace("\udc80", "?")


def report_on(case: str) -> Report:
    report = cases()[case].files[0].report
    assert report is not None
    return report


# --- Jsonl


def test_each_line_is_an_entry_of_the_json_list() -> None:
    submissions = list(cases().values())
    text = document("jsonl", *submissions)
    listed = json.loads(document("json", *submissions))
    assert [json.loads(line) for line in text.split("\n")[:-1]] == listed
    # The assignment has two files.
    assert len(listed) == len(submissions) + 1


def test_without_submissions_there_are_no_lines() -> None:
    assert document("jsonl") == ""


# --- Csv

COLUMNS = [
    "submission", "points", "max_points", "score", "passed", "problem", "messages",
    "planar-rrr.table", "planar-rrr.pose",
]  # fmt: skip


def read(*names: str, format_name: str = "csv") -> list[list[str]]:
    text = document(format_name, *(cases()[name] for name in names))
    return list(csv.reader(io.StringIO(text, newline=""), strict=True))


def test_each_submission_is_a_line_and_each_part_a_column() -> None:
    head, right, wrong, empty = read("right", "wrong", "empty")
    assert head == COLUMNS
    assert right == ["folder/anna.json", "16", "16", "1", "yes", "", "", "8", "8"]
    # Worked out by hand in docs/marks.md: the first joint's row is worth 0.421053.
    assert wrong[1:5] == ["11", "16", "0.6875", "no"]
    assert wrong[6:] == [
        "table.quarter_turn table.joint_variable_index pose.sign", "4", "7",
    ]  # fmt: skip
    assert empty[1:] == ["", "16", "", "no", "Nothing is answered.", "", "", ""]


def test_a_file_that_cannot_be_used_has_no_points() -> None:
    _, unusable = read("unusable")
    assert unusable[1:5] == ["", "16", "", "no"]
    assert unusable[5].startswith("is no JSON: =cmd")
    assert unusable[6:] == ["", "", ""]


def test_a_hostile_file_name_stays_in_one_line() -> None:
    names = [name for name in cases() if name != "assignment"]
    lines = read(*names)
    assert len(lines) == 1 + len(names)
    text = document("csv", *(cases()[name] for name in names))
    assert text.count("\r\n") == len(lines)
    assert "\n" not in text.replace("\r\n", "")


@pytest.mark.parametrize(
    ("cell", "written"),
    [
        ("=1+1", "'=1+1"),
        ('x;=cmd|"/c calc"!A0', 'x;\'=cmd|"/c calc"!A0'),
        ('x;"=1+1"', 'x;\'"=1+1"'),
        ("x; +1;@SUM(A1);－1", "x;' +1;'@SUM(A1);'－1"),
        ("\t=1", "\ufffd=1"),
        ("x\r\n=1", "x\ufffd\ufffd=1"),
        ("a; b; c=1", "a; b; c=1"),
        ("1-2;3", "1-2;3"),
    ],
)
def test_no_cell_is_a_formula_even_if_semicolons_end_cells(cell: str, written: str) -> None:
    line = spreadsheet.line((cell, "end"))
    [cells] = csv.reader(io.StringIO(line.decode(), newline=""), strict=True)
    assert cells == [written, "end"]
    for each in csv.reader(io.StringIO(line.decode(), newline=""), delimiter=";"):
        for text in each:
            assert not text.lstrip().startswith(("=", "+", "-", "@", "－"))


def test_no_cell_starts_like_a_formula() -> None:
    assert HOSTILE.startswith("=")
    for format_name in ("csv", "gradebook"):
        for line in read(*cases(), format_name=format_name):
            for cell in line:
                assert not cell.lstrip().startswith(("=", "+", "-", "@", "\t", "\r"))


def test_points_have_two_decimals() -> None:
    assert spreadsheet.line([7.0, 7 / 3, 0.5, None]) == b"7,2.33,0.5,\r\n"


# --- Gradebook


def test_each_learner_is_a_line_under_moodles_headings() -> None:
    head, right, wrong = read("right", "wrong", format_name="gradebook")
    # Moodle (mod/assign) uses these headings in its grading worksheet.
    assert head == ["Identifier", "Grade", "Maximum Grade", "Feedback comments"]
    assert right[1:3] == ["16", "16"]
    assert wrong[1] == "11"
    assert wrong[3] == "Denavit-Hartenberg table: 4 / 8; Pose of the end effector: 7 / 8"


def test_an_unusable_file_gets_no_grade() -> None:
    _, unusable = read("unusable", format_name="gradebook")
    assert unusable[:3] == ["b", "", "16"]
    assert "is no JSON" in unusable[3]


# --- Html


def read_html(*names: str) -> str:
    page = document("html", *(cases()[name] for name in names))
    assert page.startswith("<!doctype html>\n")
    return " ".join(PageReader(page).texts)


@pytest.mark.parametrize("case", cases())
def test_a_page_has_only_allowed_elements(case: str) -> None:
    read_html(case)


def test_all_submissions_are_on_one_page() -> None:
    told = read_html(*cases())
    for word in ("16 / 16 points", "11 / 16 points", "Not graded", "Nothing was handed in."):
        assert word in told


def test_each_cell_shows_its_entry_and_its_sign() -> None:
    told = re.sub(r"\s+", " ", read_html("wrong"))
    assert "✓ l 1 ✗ π 2 ✓ 0 ✓ q 2 0.5 / 2.5" in told
    assert "row 2 α :" in told


class Prose(PageReader):
    """Collects the texts of a page outside of formulas and code."""

    def handle_data(self, data: str) -> None:
        if not {"math", "code", "style", "title"} & set(self.open):
            self.texts.append(data)


def test_names_and_entries_are_typeset() -> None:
    page = document("html", *(cases()[name] for name in ("right", "wrong", "unreadable")))
    plain = r"theta|alpha|\bpi\b|[αθπ]|(?<![A-Za-z0-9.])[A-Za-z][0-9](?![A-Za-z0-9])|\{\w\}|\*"
    texts = [text for text in Prose(page).texts if "version" not in text]
    assert any("is not right: compare" in text for text in texts)
    assert [text for text in texts if re.search(plain, text)] == []


def test_hostile_text_is_shown_as_text() -> None:
    told = read_html("hostile words")
    assert "<script>alert(1)</script> <img src=x onerror=alert(1)>" in HOSTILE
    assert "<script>alert(1)</script> <img src=x onerror=alert(1)>" in told


def test_a_page_loads_no_other_file() -> None:
    page = document("html", cases()["right"])
    assert "url(" not in page
    assert "@import" not in page
    assert "default-src 'none'; style-src 'sha256-" in page


# The colours of the page: of its background and of its text.
COLOURS = """() => {
  const style = getComputedStyle(document.body);
  return [style.backgroundColor, style.color];
}"""


@pytest.mark.long
def test_a_browser_shows_it_light_dark_and_printed(
    visit: Callable[..., Visit], tmp_path: Path
) -> None:
    file = tmp_path / "page.html"
    file.write_text(document("html", *cases().values()), encoding="utf-8")
    opened = visit()
    page = opened.page
    page.goto(file.as_uri())
    expect(page.locator("article")).to_have_count(8)
    colours = []
    for media, scheme in APPEARANCES:
        page.emulate_media(media=media, color_scheme=scheme)
        colours.append(page.evaluate(COLOURS))
    light, dark, paper = (list(map(brightness, pair)) for pair in colours)
    assert light[0] - light[1] > 180
    assert dark[1] - dark[0] > 180
    assert paper[0] == 255
    assert paper[1] < 60
    page.emulate_media(media="screen")
    # A table that is wider than its card scrolls.
    scrolls = "every(each => getComputedStyle(each).overflowX === 'auto')"
    assert page.evaluate(f"[...document.querySelectorAll('.cells')].{scrolls}")
    # No text of a student ran as a script, and only the page was requested.
    assert opened.requests == [file.as_uri()]
    assert page.locator("script").count() == 0
    # Long texts do not make the page wider.
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def brightness(colour: str) -> float:
    """Return the brightness of ``rgb(r, g, b)``, 0..255."""
    red, green, blue = map(int, re.findall(r"\d+", colour)[:3])
    return 0.3 * red + 0.59 * green + 0.11 * blue


# --- HTML templates escape every text

SERVICE = Path(__file__).parents[2] / "service" / "dh_grader"
TEMPLATES = sorted(SERVICE.rglob("templates/**/*.html"))
# The functions that call `own_html`, with the HTML that each one passes.
TRUSTED = {
    "formats/texts.py style_sheet": "the style sheets of reports",
    "formats/texts.py typeset": "texts with names in MathML: names.typeset()",
    "formats/texts.py _filled": "texts of templates and of their catalogues",
    "formats/texts.py formula": "formulas in MathML: formulas.formula()",
    "web/pages.py _markdown": "statements and prompts: statement_html()",
    "web/pages.py ten_minutes_page": "the matrix of a row: typeset() and matrix()",
    "web/tutor.py _formula": "MathML of model solutions: formula_html()",
}


@pytest.fixture
def environment() -> Environment:
    return html_templates.environment()


def rendered_template(environment: Environment, source: str, **values: object) -> str:
    return environment.from_string(source).render(values)


def calls(name: str) -> Iterator[str]:
    """Yield the functions of service/ that call the function ``name``."""
    for file in sorted(SERVICE.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef):
                called = {
                    each.func.id
                    for each in ast.walk(node)
                    if isinstance(each, ast.Call) and isinstance(each.func, ast.Name)
                }
                if name in called:
                    yield f"{file.relative_to(SERVICE).as_posix()} {node.name}"


def test_a_printed_text_is_escaped_and_visible(environment: Environment) -> None:
    shown = rendered_template(environment, '<p title="{{ text }}">{{ text }}</p>', text=HOSTILE)
    assert "<script" not in shown
    assert "&lt;script&gt;" in shown
    assert shown.count('"') == 2
    assert shown.isprintable()
    assert not re.search("::|##", shown)


def test_values_of_macros_and_loops_are_escaped_once(environment: Environment) -> None:
    source = (
        "{% macro m(t) %}<b>{{ t }}</b>{% endmacro %}{% for t in texts %}{{ m(t) }}{% endfor %}"
    )
    assert (
        rendered_template(environment, source, texts=["<i>", "\u202e&"])
        == "<b>&lt;i&gt;</b><b>\ufffd&amp;</b>"
    )


def test_html_of_the_service_is_printed_as_it_is(environment: Environment) -> None:
    assert rendered_template(environment, "{{ html }}", html=own_html("<i>\n</i>")) == "<i>\n</i>"


def test_line_breaks_are_kept_where_a_template_says_so() -> None:
    assert lines("a <b>\n\x1b c\r") == "a &lt;b&gt;\n\ufffd c\ufffd"


def test_a_variable_that_is_missing_fails(environment: Environment) -> None:
    with pytest.raises(UndefinedError):
        rendered_template(environment, "{{ misspelt }}")


def test_a_template_is_compiled_once(environment: Environment) -> None:
    name = TEMPLATES[0].relative_to(SERVICE).as_posix()
    assert html_templates.environment() is environment
    assert environment.get_template(name) is environment.get_template(name)


@pytest.mark.parametrize("file", TEMPLATES, ids=lambda file: file.name)
def test_no_template_turns_escaping_off(file: Path) -> None:
    source = file.read_text(encoding="utf-8")
    assert not re.search(r"\|\s*safe|autoescape|\bMarkup\b|xmlattr|\|\s*tojson", source)
    # The text of an author's file, in a text area, keeps its control characters.
    assert len(re.findall(r"\|\s*(?:e|escape|forceescape)\b", source)) == (
        file.name == "editor.html"
    )


@pytest.mark.long
def test_only_listed_functions_pass_unescaped_html() -> None:
    assert set(calls("own_html")) == set(TRUSTED)
    assert list(calls("Markup")) == ["formats/texts.py own_html"]


def test_a_printed_sentence_is_told_in_the_language_of_the_page() -> None:
    environment = html_templates.environment(PSEUDO)
    source = (
        '{{ s }}|{{ s | typeset }}|{{ "row" }}|{{ _("<i>") }}|'
        "{% trans a=s %}<b>{{ a }}</b>{% endtrans %}"
    )
    sentence = say("Row {row}\u00a0: {text}", row=2, text="<u>")
    shown = rendered_template(environment, source, s=sentence)
    told = "Rów 2\u00a0: &lt;u&gt;"
    printed, names, plain, text, html = shown.split("|")
    assert printed.startswith(told)
    assert names.startswith("Rów")
    assert plain == "row"
    assert text.startswith("&lt;i&gt;")
    assert html.startswith(f"<b>{told}")


def test_trusted_html_of_a_catalogue_does_not_trust_its_values(environment: Environment) -> None:
    source = '{% trans t=text %}<b>{{ t }}</b>{% endtrans %}{{ _("T: %(t)s", t=text) }}'
    assert (
        rendered_template(environment, source, text="<i>\u202e")
        == "<b>&lt;i&gt;\ufffd</b>T: &lt;i&gt;\ufffd"
    )


def test_a_template_counts(environment: Environment) -> None:
    source = "{% trans n=n %}one{% pluralize %}{{ n }} <b>rows</b>{% endtrans %}"
    assert [rendered_template(environment, source, n=n) for n in (1, 2)] == ["one", "2 <b>rows</b>"]
    assert rendered_template(html_templates.environment(PSEUDO), source, n=2).startswith("2 <b>rów")
