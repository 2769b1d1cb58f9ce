"""An exercise is printed on paper without bars and buttons."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise

# The width of the text on A4 with the margins of the style sheet.
PAPER = {"width": 688, "height": 975}


def shown(page: Page, selector: str) -> int:
    return len([each for each in page.locator(selector).all() if each.is_visible()])


@pytest.mark.long
def test_an_exercise_is_printed_with_its_report(visit: Callable[..., Visit], service: str) -> None:
    page = visit(color_scheme="dark").page
    open_exercise(page, service, "planar-rr")
    # An empty form has no points to print.
    page.emulate_media(media="print")
    expect(page.locator(".bar")).to_be_hidden()
    page.emulate_media(media="screen")
    for i, text in enumerate(["a1", "0", "0", "theta1", "a2", "0", "sin(", "theta2"]):
        cells(page).nth(i).fill(text)
    page.get_by_role("button", name="Check").click()
    expect(page.locator("td[data-verdict=unreadable]")).to_have_count(1)
    page.get_by_role("button", name="Move it in 3D").click()
    expect(page.locator(".robot-view")).to_have_attribute("aria-busy", "false")

    page.set_viewport_size({"width": PAPER["width"], "height": PAPER["height"]})
    page.emulate_media(media="print")
    assert shown(page, "button:not(.fold), meter, .rail, .tools, .robot-view, nav, footer") == 0
    expect(page.locator(".total")).to_be_visible()
    expect(page.locator(".total")).to_contain_text("/ 17 points")
    # The drawing replaces the 3D view.
    expect(page.get_by_role("img", name="Drawing of the robot")).to_be_visible()
    expect(cells(page).nth(6)).to_be_visible()
    expect(page.locator(".notes li").first).to_be_visible()
    assert page.evaluate("document.documentElement.scrollWidth") <= PAPER["width"]
    colours = "getComputedStyle(document.body).backgroundColor"
    assert page.evaluate(colours) == "rgb(255, 255, 255)"
    cell = "each => getComputedStyle(each).color"
    channels = cells(page).first.evaluate(cell).removeprefix("rgb(").removesuffix(")").split(",")
    assert max(map(int, channels)) < 80
