import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests import chromium
from tests.formats.html_reader import PageReader
from tests.formats.submissions import HOSTILE, cases, document


def read(*names: str) -> str:
    page = document("html", *(cases()[name] for name in names))
    assert page.startswith("<!doctype html>\n")
    return " ".join(PageReader(page).texts)


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


@pytest.mark.skipif(chromium.FOUND is None or sys.platform == "win32", reason="needs a Chromium")
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
