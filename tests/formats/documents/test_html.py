import re
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import expect

from tests.browser.fixtures import APPEARANCES, Visit
from tests.formats.html_reader import PageReader
from tests.formats.submissions import HOSTILE, cases, document


def read(*names: str) -> str:
    page = document("html", *(cases()[name] for name in names))
    assert page.startswith("<!doctype html>\n")
    return " ".join(PageReader(page).texts)


@pytest.mark.parametrize("case", cases())
def test_a_page_has_only_allowed_elements(case: str) -> None:
    read(case)


def test_all_submissions_are_on_one_page() -> None:
    told = read(*cases())
    for word in ("16 / 16 points", "11 / 16 points", "Not graded", "Nothing was handed in."):
        assert word in told


def test_each_cell_shows_its_entry_and_its_sign() -> None:
    told = re.sub(r"\s+", " ", read("wrong"))
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
    told = read("hostile words")
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
