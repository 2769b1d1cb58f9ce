import re
import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path

import pytest

from tests import chromium
from tests.formats.submissions import HOSTILE, cases, document

# Of each element that the page has, the attributes that it may have; none of them is a link, a
# script or a style.
ALLOWED = {
    "html": {"lang"}, "head": set(), "body": set(), "style": set(), "title": set(),
    "meta": {"charset", "http-equiv", "content", "name"}, "article": set(), "section": {"class"},
    "header": {"class"}, "footer": set(), "h1": set(), "h2": set(), "h3": set(), "p": {"class"},
    "div": {"class"}, "span": {"class", "title"}, "strong": set(), "code": set(), "ul": {"class"},
    "li": set(), "table": set(), "thead": set(), "tbody": set(), "tr": set(), "td": {"class"},
    "th": {"scope"}, "svg": {"class", "role", "aria-label", "viewbox"},
    "circle": {"class", "cx", "cy", "r", "stroke-width", "stroke-dasharray", "transform"},
    "text": {"x", "y", "text-anchor"},
}  # fmt: skip
VOID = {"meta"}


class Reader(HTMLParser):
    """Checks what is open and closed, and keeps the texts of the page."""

    def __init__(self, page: str) -> None:
        super().__init__(convert_charrefs=True)
        self.open: list[str] = []
        self.texts: list[str] = []
        self.feed(page)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        assert {name for name, _ in attrs} <= ALLOWED[tag]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open[-1:] != ["style"]:
            self.texts.append(data)

    def handle_comment(self, data: str) -> None:
        pytest.fail(f"a comment: {data}")


def read(*names: str) -> str:
    page = document("html", *(cases()[name] for name in names))
    assert page.startswith("<!doctype html>\n")
    return " ".join(Reader(page).texts)


@pytest.mark.parametrize("case", cases())
def test_whatever_was_written_is_text(case: str) -> None:
    read(case)


def test_all_submissions_on_one_page() -> None:
    told = read(*cases())
    for word in ("16 / 16 points", "10.79 / 16 points", "Not graded", "Nothing was handed in."):
        assert word in told


def test_the_entries_stand_in_the_cells_with_their_signs() -> None:
    told = re.sub(r"\s+", " ", read("wrong"))
    assert "✓ l1 ✗ pi/2 ✓ 0 ✓ q2 0.42 / 2.53" in told
    assert "row 2 alpha:" in told


def test_hostile_text_comes_through_as_text() -> None:
    told = read("hostile words")
    assert "<script>alert(1)</script> <img src=x onerror=alert(1)>" in HOSTILE
    assert "<script>alert(1)</script> <img src=x onerror=alert(1)>" in told


def test_nothing_is_fetched() -> None:
    page = document("html", cases()["right"])
    assert "url(" not in page
    assert "@import" not in page
    assert "default-src 'none'; style-src 'sha256-" in page


@pytest.fixture
def page() -> Iterator[chromium.Page]:
    with chromium.blank_page() as page:
        yield page


@pytest.mark.skipif(
    chromium.PROGRAM is None or sys.platform == "win32", reason="needs a Chromium on the PATH"
)
def test_a_browser_shows_it_light_dark_and_on_paper(page: chromium.Page, tmp_path: Path) -> None:
    file = tmp_path / "page.html"
    file.write_text(document("html", *cases().values()), encoding="utf-8")
    page.open(file.as_uri())
    page.wait_for("document.querySelectorAll('article').length === 8")
    colours = {}
    for media, scheme in (("screen", "light"), ("screen", "dark"), ("print", "dark")):
        page.show_as(media, scheme)
        matches = f"matchMedia('{media} and (prefers-color-scheme: {scheme})').matches"
        page.wait_for(matches)
        colours[media, scheme] = [
            page.wait_for(f"getComputedStyle(document.body).{name}")
            for name in ("backgroundColor", "color")
        ]
    light, dark, paper = (list(map(brightness, pair)) for pair in colours.values())
    assert light[0] - light[1] > 180
    assert dark[1] - dark[0] > 180
    assert paper[0] == 255
    assert paper[1] < 60
    page.show_as("screen")
    # What is wider than its card can be scrolled to.
    scrolls = "every(each => getComputedStyle(each).overflowX === 'auto')"
    assert page.wait_for(f"[...document.querySelectorAll('.cells')].{scrolls}")
    # Nothing of a student was run, and nothing was asked for but the page.
    assert page.complaints == []
    assert page.requests == [file.as_uri()]
    assert page.wait_for("document.scripts.length === 0")
    # Long texts widen no page.
    assert page.wait_for("document.documentElement.scrollWidth <= innerWidth")


def brightness(colour: str) -> float:
    """That of ``rgb(r, g, b)``, 0..255."""
    red, green, blue = map(int, re.findall(r"\d+", colour)[:3])
    return 0.3 * red + 0.59 * green + 0.11 * blue
