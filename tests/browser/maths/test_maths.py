"""Pages show symbols as formulas, and never as plain text such as theta1."""

import re
from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from playwright.sync_api import Page, expect

from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise

PLAIN = re.compile(
    r"(?<![A-Za-z])(?:alpha|beta|gamma|theta|phi|psi|omega)(?![a-z])"
    r"|(?<![A-Za-z0-9])[A-Za-z]_\w(?!\w)|(?<![A-Za-z0-9.])[A-Za-z][0-9](?![A-Za-z0-9])|\{\w\}|[$^θαφ]|```"
)
# The texts of the element outside of formulas and code; what only screen readers read is spoken.
TEXTS = """() => {
  const found = [];
  const walk = (node) => {
    if (node.nodeType === Node.TEXT_NODE) found.push(node.nodeValue);
    if (node.matches?.("math, code, thead, .aloud, .echo, .repair")) return;
    node.childNodes.forEach(walk);
  };
  walk(document.querySelector("dh-exercise").shadowRoot.querySelector(".outer"));
  return found;
}"""
# The formulas that are wider than their paragraph and do not scroll. After an index is a space of
# some pixels, which may stand out.
CUT = """() => [...document.querySelector("dh-exercise").shadowRoot.querySelectorAll("math")]
  .filter((math) => {
    const block = math.closest("p, dd, dt, li, h1, h2, caption, th, button, .display, .shown");
    const scrolls = block.matches(".display, .shown");
    const [inner, outer] = [math, block].map((each) => each.getBoundingClientRect());
    return !scrolls && (inner.right > outer.right + 5 || inner.left < outer.left - 1);
  }).map((math) => math.textContent)"""
SHOW = """(id) => new Promise((resolve) => {
  const element = document.querySelector("dh-exercise");
  element.addEventListener("ready", resolve, { once: true });
  element.setAttribute("exercise", id);
})"""


def plain(page: Page) -> list[str]:
    return [text for text in page.evaluate(TEXTS) if PLAIN.search(text)]


@pytest.mark.long
def test_every_exercise_is_typeset_and_fits_a_phone(
    visit: Callable[..., Visit], service: str, catalogue: Mapping[str, Exercise]
) -> None:
    page = visit(viewport={"width": 390, "height": 844}).page
    open_exercise(page, service, "planar-rr")
    for exercise in catalogue:
        if exercise != "planar-rr":
            page.evaluate(SHOW, exercise)
        assert plain(page) == [], exercise
        assert page.evaluate(CUT) == [], exercise
        assert page.evaluate("document.documentElement.scrollWidth") <= 390, exercise


@pytest.mark.long
def test_a_matrix_in_a_prompt_has_brackets_and_entries(
    visit: Callable[..., Visit], service: str
) -> None:
    page = visit().page
    open_exercise(page, service, "dh-conditions")
    matrix = page.locator(".prompt math").first
    expect(matrix.locator("mtd")).to_have_count(16)
    assert matrix.locator("mtd").nth(3).text_content() == "l\u2062cos\u2061(φ)"
    style = "each => getComputedStyle(each).borderInlineStartWidth"
    assert float(matrix.locator("mtable").evaluate(style).removesuffix("px")) >= 1


@pytest.mark.long
def test_messages_are_typeset(visit: Callable[..., Visit], service: str) -> None:
    page = visit().page
    open_exercise(page, service, "planar-rr")
    for i, text in enumerate(["a2", "pi/2", "0", "theta2", "a1", "0", "theta 1", "-theta2"]):
        cells(page).nth(i).fill(text)
    expect(page.locator(".part").first.locator(".unread")).not_to_have_count(0)
    page.get_by_role("button", name="Check").click()
    told = page.locator(".part").first.locator(".messages math, .notes math")
    expect(told).not_to_have_count(0)
    assert plain(page) == []


@pytest.mark.long
def test_messages_of_the_3d_view_are_typeset(visit: Callable[..., Visit], service: str) -> None:
    page = visit().page
    open_exercise(page, service, "planar-rr")
    page.get_by_role("button", name="Move it in 3D").click()
    for i, text in enumerate(["a1", "0", "0", "thta1"]):
        cells(page).nth(i).fill(text)
    told = page.locator(".told")
    expect(told).to_contain_text("Did you mean")
    expect(told.locator("math")).to_have_text(["θ", "θ1"])
