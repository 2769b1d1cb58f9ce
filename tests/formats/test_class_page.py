"""Test the page of a class."""

import re
import unicodedata
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from urllib.parse import unquote

import pytest
from dh_grader.formats import report_format
from dh_grader.formats.class_page import LONGEST, distinct_file_names, file_stem
from dh_grader.formats.graded import GradedSubmission
from dh_grader.grading import FeedbackLevel
from playwright.sync_api import expect

from tests.browser.fixtures import APPEARANCES, Visit
from tests.formats.class_of_seven import class_of_seven
from tests.formats.html_reader import ALLOWED, PageReader
from tests.formats.submissions import HOSTILE, cases, document, graded, setting

# --- Test the report on a class as web pages

ALLOWED_IN_INDEX = {
    **ALLOWED,
    "main": set(), "nav": {"aria-label"}, "section": {"id", "class", "aria-label"},
    "a": {"href"}, "ul": {"class", "aria-label"}, "li": {"class"}, "h4": set(),
    "dl": {"class"}, "dt": set(), "dd": {"class"}, "figure": {"class"}, "figcaption": {"class"},
    "div": {"class", "role", "aria-label", "aria-hidden", "tabindex"},
    "span": {"class", "title", "aria-hidden"}, "table": {"class"}, "caption": {"class"},
    "th": {"scope", "class"}, "details": {"class"}, "summary": set(),
    "svg": ALLOWED["svg"] | {"aria-hidden", "preserveaspectratio"},
    "rect": {"class", "y", "width", "height"}, "line": {"x1", "x2", "y1", "y2"},
}  # fmt: skip


def folder(*submissions: GradedSubmission) -> dict[str, str]:
    """Return the web pages of the report on a class, by path."""
    writes = report_format("html").folder
    assert writes is not None
    documents = writes(submissions, setting())
    return {each.path: b"".join(each.pieces).decode() for each in documents}


def read(page: str) -> PageReader:
    assert page.startswith("<!doctype html>\n")
    return PageReader(page, ALLOWED_IN_INDEX)


def told(page: str) -> str:
    return re.sub(r"\s+", " ", " ".join(read(page).texts))


@pytest.mark.long
def test_the_index_links_to_a_page_for_each_submission() -> None:
    files = folder(*class_of_seven())
    names = ("anna", "ben", "cleo", "dana", "emre", "fritz", "gina")
    assert list(files) == [*(f"reports/{name}.html" for name in names), "index.html"]
    index = read(files["index.html"])
    places = {f"#{name}" for name in index.names}
    assert {unquote(link) for link in index.links} == (files.keys() | places) - {"index.html"}
    assert files["reports/ben.html"] == document("html", class_of_seven()[1])


def test_the_index_shows_the_counts() -> None:
    words = told(folder(*class_of_seven())["index.html"])
    for sentence in (
        "Submissions 7 2 not graded",
        "5 of 6 answered, 1 all right.",
        "2 100 % 5/5 60 % 3/5",  # row 2 of the table: a, alpha
        "2 submissions α is not right: compare z1 and z2. quarter_turn in Denavit-Hartenberg",
        "table (2) ben cleo 1 submission The fixed row",
        "1 submission Something is missing after the + at the end. trailing_operator",
        "2 submissions Denavit-Hartenberg table, 1 wrong cell row 2 alpha: pi/2 ben cleo",
        "This is no proof of copying",
        "fritz Nothing is answered. is left out",
        "gina is empty is left out",
        "row 2 alpha pi/2 2",
    ):
        assert sentence in words
    anna = words.rindex("anna 16 / 16 100 % ✓ passed")
    assert words.index("gina – – ? not graded") > anna


def test_unreadable_submissions_and_unusable_files_do_not_count() -> None:
    words = told(folder(cases()["unreadable"], cases()["unusable"])["index.html"])
    assert "Nothing in this submission could be read. is left out" in words
    assert words.count("is left out") == 2


def test_a_partly_usable_file_is_listed_with_the_reason() -> None:
    [file] = class_of_seven()[1].files
    half = replace(class_of_seven()[1], files=(replace(file, problem="answers nothing for pose"),))
    words = told(folder(half)["index.html"])
    assert "ben answers nothing for pose is left out" in words


def test_the_index_says_if_the_feedback_level_hides_slips() -> None:
    scores = [graded({"table": {"rows": []}}, each, FeedbackLevel.SCORE) for each in "ab"]
    assert "2 reports without misconceptions" in told(folder(*scores)["index.html"])


def test_a_class_without_submissions_has_an_index() -> None:
    files = folder()
    assert list(files) == ["index.html"]
    assert "Nothing was graded." in told(files["index.html"])


@pytest.mark.parametrize("case", cases())
def test_hostile_texts_stay_texts(case: str) -> None:
    pair = [cases()[case], replace(cases()[case], name="another")]
    for page in folder(*pair).values():
        read(page)
        kinds = {unicodedata.category(c) for c in page} & {"Cc", "Cf", "Cs", "Cn"}
        assert kinds <= {"Cc"}
        assert "\r" not in page
        assert "default-src 'none'; style-src 'sha256-" in page
    index = folder(*pair)["index.html"]
    if case == "hostile words":
        assert "<script>alert(1)</script> <img src=x onerror=alert(1)>" in HOSTILE
        assert "<script>alert(1)</script> <img src=x onerror=alert(1)>" in told(index)


def test_hostile_names_stay_in_the_folder() -> None:
    names = ("../../etc/passwd", "/etc/passwd", "..", HOSTILE, 'x" onload="y', "a\\b:c", "CON", "")
    submissions = [replace(class_of_seven()[0], learner=name) for name in (*names, *names)]
    files = folder(*submissions)
    assert len(files) == 17
    for path in files.keys() - {"index.html"}:
        assert re.fullmatch(r"reports/[\w-]+\.html", path)
    links = {link for link in read(files["index.html"]).links if not link.startswith("#")}
    assert all(re.fullmatch(r"reports/[\w%-]+\.html", link) for link in links)


def test_learners_with_the_same_name_get_the_names_of_their_submissions() -> None:
    submissions = [replace(class_of_seven()[0], name=f"{group}/anna.json") for group in "ab"]
    words = told(folder(*submissions)["index.html"])
    assert "a/anna.json" in words
    assert "b/anna.json" in words


def test_each_submission_is_written_before_the_next_is_graded() -> None:
    taken = 0

    def many() -> Iterator[GradedSubmission]:
        nonlocal taken
        for submission in class_of_seven():
            taken += 1
            yield submission

    writes = report_format("html").folder
    assert writes is not None
    for written, _ in enumerate(writes(many(), setting()), start=1):
        assert taken == min(written, 7)


# The lowest contrast of any text with its background, by the formula of WCAG 2.
CONTRAST = """(() => {
  const canvas = document.createElement('canvas')
    .getContext('2d', {willReadFrequently: true});
  const channels = colour => {
    canvas.clearRect(0, 0, 1, 1); canvas.fillStyle = colour; canvas.fillRect(0, 0, 1, 1);
    return [...canvas.getImageData(0, 0, 1, 1).data];
  };
  const light = colour => channels(colour).slice(0, 3).map(c => c / 255)
    .map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const behind = node => {
    for (let each = node; each; each = each.parentElement) {
      const colour = getComputedStyle(each).backgroundColor;
      if (channels(colour)[3] === 255) return colour;
    }
  };
  let least = 21;
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const node = texts.currentNode.parentElement;
    if (!texts.currentNode.data.trim()) continue;
    const pair = [light(getComputedStyle(node).color), light(behind(node))].sort((a, b) => b - a);
    least = Math.min(least, (pair[0] + 0.05) / (pair[1] + 0.05));
  }
  return least;
})()"""


@pytest.mark.long
def test_a_browser_shows_it_with_contrast_and_without_requests(
    visit: Callable[..., Visit], tmp_path: Path
) -> None:
    file = tmp_path / "index.html"
    file.write_text(folder(*cases().values(), *class_of_seven())["index.html"], encoding="utf-8")
    opened = visit()
    page = opened.page
    page.goto(file.as_uri())
    expect(page.locator("section[id]")).to_have_count(7)
    page.evaluate("document.querySelectorAll('details').forEach(each => each.open = true)")
    for media, scheme in APPEARANCES:
        page.emulate_media(media=media, color_scheme=scheme)
        assert page.evaluate(CONTRAST) >= 4.5, (media, scheme)
    page.emulate_media(media="screen")
    for width in (320, 360, 1280):
        page.set_viewport_size({"width": width, "height": 800})
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), width
    assert opened.requests == [file.as_uri()]
    assert page.locator("script").count() == 0


# --- File names


@pytest.mark.parametrize(
    ("name", "stem"),
    [
        ("Anna Müller", "Anna-Müller"),
        ("李明", "李明"),
        ("s1234567_late", "s1234567_late"),
        ("../../etc/passwd", "etc-passwd"),
        ("C:\\Windows\\x", "C-Windows-x"),
        (".hidden", "hidden"),
        ("a\0b\n\x1b[31mc", "a-b-31mc"),
        ("\u202egpj.exe", "gpj-exe"),
        ('x" onmouseover="y', "x-onmouseover-y"),
        ("-rf", "rf"),
        ("", "submission"),
        ("..", "submission"),
        ("\udc80", "submission"),
        ("nul", "nul-"),
        ("COM1", "COM1-"),
        ("e\u0301va", "éva"),
    ],
)
def test_only_letters_and_digits_are_kept(name: str, stem: str) -> None:
    assert file_stem(name) == stem


def test_a_name_is_short_enough_for_any_system() -> None:
    names = ["𝔞" * 300, "é" * 300, "x" * 300]
    distinct = distinct_file_names(".html")
    for name in names * 3:
        file = distinct(name)
        assert len(file) < LONGEST + 10
        assert len(file.encode()) < 255


def test_names_are_distinct_on_any_system() -> None:
    distinct = distinct_file_names(".html")
    files = [
        distinct(name) for name in ("Anna", "anna", "ANNA", "anna-2", "éa", "e\u0301a", "ﬁ", "fi")
    ]
    assert files == [
        "Anna.html", "anna-2.html", "ANNA-3.html", "anna-2-2.html",
        "éa.html", "éa-2.html", "ﬁ.html", "fi-2.html",
    ]  # fmt: skip
    assert all(re.fullmatch(r"[\w-]+\.html", file) for file in files)
