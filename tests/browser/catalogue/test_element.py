"""Test the exercise element that other sites embed in their pages."""

import re
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.api.serving import ROOT
from tests.browser.conftest import Origin
from tests.browser.fixtures import Visit
from tests.browser.steps import cells

Opening = Callable[..., Visit]

PAGE = """<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Course</title>
<link rel="icon" href="data:,"><style>{style}</style>
<script type="module" src="{service}/embed.js"></script></head>
<body><main><h1>Course</h1><dh-exercise {attributes}>Wait.</dh-exercise></main></body></html>"""


def course(origin: Origin, service: str, attributes: str, style: str = "") -> str:
    """Serve a page with the element; return the page's address."""
    path = f"/{abs(hash((attributes, style)))}"
    origin.pages[path] = PAGE.format(service=service, attributes=attributes, style=style)
    return origin.address + path


def colour(page: Page, selector: str, name: str = "backgroundColor") -> tuple[float, ...]:
    text: Any = page.locator(selector).first.evaluate(f"each => getComputedStyle(each).{name}")
    return tuple(float(each) for each in re.findall(r"[\d.]+", text)[:3])


LIGHT_PAGE = "body { background: white; color: #222; font-family: Georgia, serif }"
DARK_PAGE = "body { background: #111; color: #eee }"


@pytest.mark.long
@pytest.mark.parametrize(
    ("style", "system", "is_dark"),
    [
        ("", "dark", False),
        (LIGHT_PAGE, "dark", False),
        (DARK_PAGE, "light", True),
        (":root { color-scheme: dark }", "light", True),
        (":root { color-scheme: light dark }", "dark", True),
    ],
)
def test_the_element_has_the_colours_of_the_page_not_of_the_system(
    visit: Opening, service: str, other_origin: Origin, style: str, system: str, is_dark: bool
) -> None:
    page = visit(color_scheme=system).page
    page.goto(course(other_origin, service, 'exercise="planar-rr" parts="position"', style))
    expect(page.locator(".part")).to_have_count(1)
    for piece in (".part", "figure", ".check", ".entry input"):
        dark = sum(colour(page, piece)) < 384
        assert dark == (is_dark != (piece == ".check")), piece
    for piece in ("dh-exercise #title", ".part h3", ".entry input"):
        assert (sum(colour(page, piece, "color")) > 384) == is_dark, piece
    # The picture has the same colours: the browser gives it the system's if the address says none.
    expected = "" if is_dark == (system == "dark") else f"?theme={'dark' if is_dark else 'light'}"
    source = page.locator("figure img").get_attribute("src") or ""
    assert source.partition("figure.svg")[2] == expected


@pytest.mark.long
def test_the_element_follows_changes_of_the_page(
    visit: Opening, service: str, other_origin: Origin
) -> None:
    page = visit(color_scheme="light").page
    style = f"{LIGHT_PAGE} body.night {{ background: #111; color: #eee }}"
    page.goto(course(other_origin, service, 'exercise="planar-rr"', style))
    expect(page.locator(".outer")).to_have_attribute("data-scheme", "light")
    family = page.locator("#title").evaluate("each => getComputedStyle(each).fontFamily")
    assert family == "Georgia, serif"
    page.evaluate("document.body.className = 'night'")
    expect(page.locator(".outer")).to_have_attribute("data-scheme", "dark")
    expect(page.locator("figure img")).to_have_attribute("src", re.compile(r"\?theme=dark$"))
    page.locator("dh-exercise").evaluate("each => each.setAttribute('theme', 'light')")
    expect(page.locator(".outer")).to_have_attribute("data-scheme", "light")


@pytest.mark.long
def test_points_and_answers_are_those_of_the_shown_parts(
    visit: Opening, service: str, other_origin: Origin
) -> None:
    page = visit().page
    page.goto(course(other_origin, service, 'exercise="planar-rr" parts="table position"'))
    expect(page.locator(".tags")).to_have_text("standard6 points")
    cells(page).first.fill("a1")
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".total strong")).to_have_text(re.compile(r"^[\d.]+ / 6$"))
    expect(page.locator(".saved")).to_have_text("Saved in this browser")

    # Read only: the saved answer is shown, and nothing changes it.
    page.locator("dh-exercise").evaluate("each => each.setAttribute('readonly', '')")
    expect(page.get_by_role("button", name="Check")).to_be_hidden()
    expect(cells(page).first).to_have_value("a1")
    cells(page).first.focus()
    page.keyboard.type("9")
    page.keyboard.press("Control+Enter")
    cells(page).first.evaluate(
        """each => {
          const clipboardData = new DataTransfer();
          clipboardData.setData("text/plain", "1\\t2\\t3\\t4");
          const options = { clipboardData, bubbles: true, composed: true };
          each.dispatchEvent(new ClipboardEvent("paste", options));
        }"""
    )
    expect(cells(page).first).to_have_value("a1")
    expect(cells(page).nth(1)).to_have_value("")
    expect(page.locator("td[data-verdict]")).to_have_count(0)
    page.locator("dh-exercise").evaluate("each => each.removeAttribute('readonly')")
    expect(page.get_by_role("button", name="Check")).to_be_visible()
    cells(page).first.fill("a2")
    expect(cells(page).first).to_have_value("a2")


@pytest.mark.long
def test_an_unknown_exercise_shows_one_message(
    visit: Opening, service: str, other_origin: Origin
) -> None:
    opened = visit()
    page = opened.page
    page.goto(course(other_origin, service, 'exercise="planar-r"'))
    expect(page.get_by_role("alert")).to_be_visible()
    text = page.locator("dh-exercise .outer").inner_text().strip()
    assert text == "There is no exercise 'planar-r'. Did you mean 'planar-rr'?"
    expect(page.locator("dh-exercise .exercise")).to_be_hidden()
    page.locator("dh-exercise").evaluate("each => each.setAttribute('exercise', 'planar-rr')")
    expect(page.locator(".part").first).to_be_visible()
    expect(page.get_by_role("alert")).to_have_count(0)
    # An exercise on the page gives way to the message, too.
    page.locator("dh-exercise").evaluate("each => each.setAttribute('exercise', 'nothing')")
    expect(page.get_by_role("alert")).to_be_visible()
    expect(page.locator(".part").first).to_be_hidden()
    # The browser complains about the answers 404.
    opened.complaints.clear()


@pytest.mark.long
def test_documented_properties_and_parts_style_the_element(
    visit: Opening, service: str, other_origin: Origin
) -> None:
    text = (ROOT / "docs" / "embedding.md").read_text(encoding="utf-8")
    rows = text.partition("## Colours and fonts")[2].partition("\n## ")[0].split("\n")
    named = [row.split("|")[1] for row in rows if row.startswith("| `")]
    names = [name for cell in named for name in re.findall(r"`([\w-]+)`", cell)]
    properties = [name for name in names if name.startswith("--")]
    parts = [name for name in names if not name.startswith("--")]
    assert len(properties) == 17
    assert len(parts) == 8
    style = "dh-exercise {" + "".join(f"{name}: rgb(1, 2, 3);" for name in properties) + "}"
    style += "".join(f"dh-exercise::part({name}) {{ outline: 7px solid red }}" for name in parts)
    page = visit().page
    page.goto(course(other_origin, service, 'exercise="planar-rr" theme="light"', style))
    expect(page.locator(".part")).to_have_count(5)
    for name in parts:
        piece = page.locator(f"dh-exercise [part={name}]").first
        assert piece.evaluate("each => getComputedStyle(each).outlineWidth") == "7px", name
    sheet = (ROOT / "service/dh_grader/web/static/student/element.css").read_text(encoding="utf-8")
    assert [name for name in properties if f"var({name})" not in sheet] == []
    for selector in (".outer", ".part", "figure", ".check"):
        assert colour(page, selector) == (1, 2, 3), selector
    # The exercise on the page says which properties exist: none of the colours is left out.
    tokens = (ROOT / "service/dh_grader/web/static/shared/tokens.css").read_text(encoding="utf-8")
    colours = set(re.findall(r"(--[\w-]+): light-dark", tokens))
    assert {name for name in colours if not name.endswith("-tint")} <= {*properties}
