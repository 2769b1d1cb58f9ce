"""Test all pages in a browser: accessibility, embedding and hostile texts."""

import json
import re
from collections.abc import Callable
from typing import Any, Literal

import pytest
from playwright.sync_api import Frame, Page, expect

from tests.api.serving import ROOT
from tests.browser.conftest import Origin
from tests.browser.fixtures import Visit
from tests.browser.hostile import TEXTS
from tests.browser.steps import cells, open_exercise

Opening = Callable[..., Visit]
# The colours in which each page is checked: a name, the scheme, and if the reader forces colours.
MEDIA: tuple[tuple[str, Literal["light", "dark"], Literal["active", "none"]], ...] = (
    ("light", "light", "none"),
    ("dark", "dark", "none"),
    ("forced", "dark", "active"),
)


def course_page(service: str) -> str:
    """Return the example page of docs/embedding.md with the address of this service."""
    text = (ROOT / "docs" / "embedding.md").read_text(encoding="utf-8")
    [page] = re.findall(r"```html\n(.*?)```", text, re.DOTALL)
    return str(page).replace("https://grader.example.edu", service)


# JavaScript: in forced colours, Chromium reports letters as filled with the colour of the author.
FORCED_FILL = """() => {
    const own = CSSStyleDeclaration.prototype.getPropertyValue
    CSSStyleDeclaration.prototype.getPropertyValue = function (name) {
        return own.call(this, name === "-webkit-text-fill-color" ? "color" : name)
    }
}"""


def violations(shown: Page | Frame, axe: str) -> list[str]:
    """Return the accessibility violations that axe-core finds on a page."""
    page = shown.page if isinstance(shown, Frame) else shown
    shown.evaluate(f"({json.dumps(axe)}, 0)")
    shown.evaluate(FORCED_FILL)
    found = []
    options: dict[str, Any] = {"resultTypes": ["violations"]}
    for name, scheme, forced in MEDIA:
        page.emulate_media(color_scheme=scheme, forced_colors=forced)
        # The element follows the colours of its page in the next frame.
        shown.evaluate("new Promise((done) => requestAnimationFrame(() => setTimeout(done, 50)))")
        result: dict[str, Any] = shown.evaluate(f"axe.run(document, {json.dumps(options)})")
        options["runOnly"] = ["color-contrast"]
        found += [
            f"{name}: {each['id']}: {node['target']} {node['failureSummary']}"
            for each in result["violations"]
            for node in each["nodes"]
        ]
    page.emulate_media(forced_colors="none")
    return found


@pytest.mark.long
def test_the_pages_are_accessible(visit: Opening, service: str, axe: str) -> None:
    # The pages' policy allows only their own scripts, so the checker needs ``bypass_csp``.
    page = visit(bypass_csp=True, viewport={"width": 1280, "height": 900}).page
    page.add_init_script(axe)
    page.goto(service)
    page.get_by_label("Find an exercise").fill("scara")
    expect(page.get_by_role("link", name="SCARA manipulator", exact=True)).to_be_visible()
    expect(page.get_by_role("link", name="Planar RR arm", exact=True)).to_be_hidden()
    assert violations(page, "") == []
    page.get_by_label("Find an exercise").fill("no such robot")
    expect(page.get_by_text("No exercise has all these words.")).to_be_visible()
    assert violations(page, "") == []
    open_exercise(page, service, "planar-rr")
    for i, text in enumerate(["a1", "0", "sin(", "theta1", "-a2", "0", "", "theta2"]):
        cells(page).nth(i).fill(text)
    page.locator("input").first.focus()
    page.get_by_role("button", name="Check").click()
    expect(page.locator("td[data-verdict=unreadable]")).to_have_count(1)
    assert violations(page, "") == []
    page.set_viewport_size({"width": 320, "height": 700})
    assert violations(page, "") == []
    assert page.evaluate("document.documentElement.scrollWidth") <= 320
    open_exercise(page, service, "dh-conditions")
    assert violations(page, "") == []


OTHER_PAGES = (
    "/nothing", "/exercises/nothing", "/tutor/attempts", "/tutor/class",
    "/tutor/misconceptions/planar-rr", "/tutor/sign-in",
)  # fmt: skip


@pytest.mark.long
def test_pages_for_tutors_and_of_problems_are_accessible(
    visit: Opening, service: str, axe: str
) -> None:
    opened = visit(bypass_csp=True, viewport={"width": 390, "height": 844})
    page = opened.page
    page.add_init_script(axe)
    for path in OTHER_PAGES:
        page.goto(service + path)
        expect(page.get_by_role("heading", level=1)).to_be_visible()
        assert violations(page, "") == [], path
        assert page.evaluate("document.documentElement.scrollWidth") <= 390, path
    # The console tells the answers 404 to the wrong addresses.
    assert all("status of 404" in each for each in opened.complaints)
    opened.complaints.clear()


@pytest.mark.long
def test_students_read_help_in_their_language(visit: Opening, service: str, axe: str) -> None:
    page = visit(bypass_csp=True, viewport={"width": 390, "height": 844}).page
    page.add_init_script(axe)
    page.goto(f"{service}/exercises/planar-rr?lang=de")
    # The form opens the help in a tab of its own: what was typed stays.
    with page.expect_popup() as opened:
        page.locator("dh-exercise").get_by_role("link", name="Hilfe").click()
    page = opened.value
    page.add_init_script(axe)
    page.reload()
    page.set_viewport_size({"width": 390, "height": 844})
    expect(page.get_by_role("heading", name="Was Sie eingeben dürfen")).to_be_visible()
    for name in (
        "Eine Tabelle oder Matrix einfügen",
        "Wie Sie Punkte bekommen",
        "Was Sie eingeben",
    ):
        page.get_by_role("navigation", name="Hilfe").get_by_role("link", name=name).click()
        expect(page.get_by_role("heading", level=1)).to_contain_text(name)
        assert violations(page, "") == []
        assert page.evaluate("document.documentElement.scrollWidth") <= 390


@pytest.mark.long
def test_the_element_works_on_a_course_page(
    visit: Opening, service: str, other_origin: Origin, stranger: Origin, axe: str
) -> None:
    other_origin.pages["/"] = course_page(service)
    page = visit(bypass_csp=True).page
    page.add_init_script(axe)
    page.goto(other_origin.address)
    expect(page.locator(".part")).to_have_count(1)
    for i, text in enumerate(["a1", "0", "0", "theta1"]):
        cells(page).nth(i).fill(text)
    # The element sends the learner's token with the answers; a page may set it at any time.
    page.locator("dh-exercise").evaluate("each => each.setAttribute('token', 'a.b.c')")
    with page.expect_request("**/grade") as graded:
        page.get_by_role("button", name="Check").click()
    assert graded.value.header_value("authorization") == "Bearer a.b.c"
    expect(page.locator("td[data-verdict=correct]")).to_have_count(4)
    expect(page.locator("#earned")).to_have_text(re.compile(r"^\d[\d.]* of 8 points$"))
    assert violations(page, "") == []
    page.locator("dh-exercise").evaluate("each => each.setAttribute('exercise', 'planar-rr')")
    expect(page.get_by_role("heading", name="Planar RR arm")).to_be_visible()

    # On a site that the service does not allow, the element shows an error.
    stranger.pages["/"] = course_page(service)
    unknown = visit()
    unknown.page.goto(stranger.address)
    expect(unknown.page.get_by_role("alert")).to_contain_text("could not be loaded")
    assert any("CORS" in each for each in unknown.complaints)
    unknown.complaints.clear()


def test_other_sites_may_show_figures_but_not_solutions(
    visit: Opening, service: str, stranger: Origin
) -> None:
    stranger.pages["/figure"] = (
        '<link rel="icon" href="data:,">'
        f'<img id="figure" src="{service}/v1/exercises/scara/figure.svg" alt="">'
        f'<img id="frames" src="{service}/tutor/solutions/scara/frames.svg" alt="">'
    )
    opened = visit()
    opened.page.goto(f"{stranger.address}/figure")
    shown = "[...document.images].map(each => each.complete && each.naturalWidth > 0)"
    assert opened.page.evaluate(shown) == [True, False]
    assert opened.complaints
    opened.complaints.clear()


@pytest.mark.long
def test_an_exercise_can_be_read_with_scripts_blocked(visit: Opening, service: str) -> None:
    opened = visit(java_script_enabled=False)
    page = opened.page
    page.goto(service)
    page.get_by_role("link", name="SCARA manipulator", exact=True).click()
    expect(page.get_by_role("heading", level=1)).to_have_text("SCARA manipulator")
    expect(page.get_by_text("all four axes are vertical")).to_be_visible()
    expect(page.get_by_role("img", name="The robot: SCARA manipulator")).to_be_visible()
    expect(page.get_by_text("Give the standard DH table, one row for each joint.")).to_be_visible()
    # Only the scripts were refused.
    assert [each for each in opened.complaints if not each.endswith(".js")] == []
    opened.complaints.clear()


HOSTILE_PAGES = (
    "/tutor", "/tutor/solutions/hostile", "/tutor/editor?exercise=hostile", "/tutor/class", "/docs",
    "/tutor/attempts", "/v1/exercises/hostile/figure.svg", "/v1/exercises/hostile",
)  # fmt: skip


@pytest.mark.long
def test_hostile_texts_stay_texts(visit: Opening, service: str) -> None:
    page = visit().page
    page.add_init_script("window.taken = []; window.stolen = (what) => taken.push(what);")
    page.goto(service)
    expect(page.get_by_role("link", name="Hostile <img src=x")).to_be_visible()
    answers = {"unit": "radians", "parts": {"table": {"cells": TEXTS, "choice": "<img src=x>"}}}
    written = page.evaluate(
        "text => btoa(String.fromCharCode(...new TextEncoder().encode(text)))", json.dumps(answers)
    )
    open_exercise(
        page, service, "hostile", f"#answers={written.replace('+', '-').replace('/', '_')}"
    )
    expect(page.get_by_text("These answers came with the link.")).to_be_visible()
    assert [each.input_value() for each in cells(page).all()][: len(TEXTS)] == TEXTS
    page.get_by_role("button", name="Check").click()
    expect(page.locator("td[data-verdict=unreadable]").first).to_be_visible()
    for i in range(len(TEXTS)):
        cells(page).nth(i).focus()
    # A character that reverses text is shown as its code point.
    shown = page.locator("dh-exercise").evaluate(
        """(each) => {
          // The echo lies unseen below the input, letter for letter.
          for (const echo of each.shadowRoot.querySelectorAll(".echo")) echo.remove();
          return each.shadowRoot.textContent;
        }"""
    )
    assert "\u202e" not in shown
    known = "a:not(.practice-link a, th a, .help-link)"
    strange = f"script, img:not([src*='figure.svg']), svg, {known}, iframe, [onerror], [onload]"
    found = page.locator("dh-exercise").evaluate(
        "(each, strange) => each.shadowRoot.querySelectorAll(strange).length", strange
    )
    assert found == 0
    assert page.evaluate("taken") == []
    for path in HOSTILE_PAGES:
        page.goto(service + path)
        assert page.evaluate("taken") == []
