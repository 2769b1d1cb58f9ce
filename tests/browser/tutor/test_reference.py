"""The page /docs is accessible, and has the same colours as all pages of the service."""

from collections.abc import Callable
from typing import Final

import pytest
from playwright.sync_api import expect

from tests.browser.fixtures import Visit
from tests.browser.test_pages import violations

NARROW: Final = {"width": 390, "height": 844}
BACKGROUND: Final = "getComputedStyle(document.body).backgroundColor"


@pytest.mark.long
def test_the_reference_is_accessible_light_and_dark(
    visit: Callable[..., Visit], service: str, axe: str
) -> None:
    page = visit(bypass_csp=True, viewport=NARROW).page
    page.add_init_script(axe)
    page.goto(f"{service}/tutor")
    expected = page.evaluate(BACKGROUND)
    page.get_by_role("link", name="API documentation").click()
    many = page.locator("#operations-grading-gradeMany")
    many.locator(".opblock-summary-control").click()
    many.locator(".execute").click()
    expect(many.locator(".live-responses-table .response")).to_contain_text("200")
    assert page.evaluate(BACKGROUND) == expected
    # Swagger UI colours the lines of examples only after it has drawn them.
    expect(many.locator("pre.microlight span").first).to_be_visible()
    assert "\n".join(violations(page, "")) == ""
    assert page.evaluate("document.documentElement.scrollWidth") <= NARROW["width"]


@pytest.mark.long
def test_the_reference_follows_the_choice_of_colours(
    visit: Callable[..., Visit], service: str
) -> None:
    page = visit(color_scheme="light").page
    page.goto(f"{service}/docs")
    method = page.locator(".opblock-summary-method").first
    colour = "each => getComputedStyle(each).backgroundColor"
    light = method.evaluate(colour)
    page.get_by_label("Colours").select_option("dark")
    expect(page.locator("html.dark-mode")).to_be_attached()
    assert method.evaluate(colour) != light
