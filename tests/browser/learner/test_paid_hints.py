"""A learner takes hints that cost points, and opens the model solution."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.fixtures import Visit
from tests.browser.learner.conftest import COURSE, Course
from tests.browser.steps import cells
from tests.browser.test_pages import violations

Opening = Callable[..., Visit]
# Row 2 of the SCARA, whose twist is a half turn, and row 4.
ROWS = ["a2", "0", "0", "theta2", "0", "0", "d4", "theta4"]


def hand_in(page: Page, alpha: str) -> None:
    inputs = page.locator("dh-exercise input:not([readonly]):not([type=range])")
    for i, text in enumerate([ROWS[0], alpha, *ROWS[2:]]):
        inputs.nth(i).fill(text)
    with page.expect_response("**/attempts"):
        page.locator(".bar").get_by_role("button", name="Hand in").click()


@pytest.mark.long
def test_hints_have_a_price_and_the_report_says_it(
    course: Course, visit: Opening, axe: str
) -> None:
    opened = visit(bypass_csp=True, viewport={"width": 1280, "height": 900})
    page = opened.page
    page.add_init_script(axe)
    page.goto(course.link)
    page.goto(f"{course.address}/learn#/{COURSE}/hints/scara-faded")
    expect(cells(page).first).to_be_visible()
    hand_in(page, "0")
    button, steps = page.locator(".hints button"), page.locator(".hint-steps > li")
    expect(button).to_have_text("Hint")
    button.click()
    expect(steps).to_have_count(1)
    expect(page.get_by_text("hand it in again. Then the next hint opens.")).to_be_visible()
    expect(page.locator(".counts")).to_contain_text("1 hint taken")
    hand_in(page, "90deg")
    page.reload()
    expect(cells(page).first).to_be_visible()
    hand_in(page, "0")
    # The step that was taken is shown again for nothing, the next one names its price.
    expect(button).to_have_text("Hint: you have taken it")
    button.click()
    expect(steps).to_have_count(1)
    # The same answer is no try between two steps, another one is.
    expect(button).to_be_hidden()
    hand_in(page, "360deg")
    expect(button).to_have_text("Hint 2 of 3: costs 0.5 of 10 points of each later attempt")
    assert violations(page, "") == []
    button.click()
    expect(steps).to_have_count(2)
    lesson = page.get_by_role("link", name="See it move in DH in ten minutes")
    assert str(lesson.get_attribute("href")).endswith("/learn-dh?convention=standard#alpha")
    expect(page.locator(".counts")).to_contain_text("2 hints taken: −0.5 in the next attempt")
    hand_in(page, "180deg")
    expect(page.get_by_text("9.5 of 10 points, −0.5 for hints").first).to_be_visible()

    page.get_by_role("button", name="Compare with the model solution").click()
    boxes = page.locator("dh-exercise .side-by-side section")
    expect(boxes).to_have_count(2)
    expect(boxes.nth(1)).to_contain_text("Model solution")
    assert violations(page, "") == []

    # The rows of the recorded table can be played.
    page.locator(".handed-in li a").last.click()
    page.get_by_role("button", name="Play this table in 3D").click()
    page.get_by_role("button", name="Play a row").click()
    expect(page.get_by_role("group", name="Play a row")).to_be_visible()
