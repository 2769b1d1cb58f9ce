"""A student marks and corrects a slip by keyboard and on a phone."""

from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.fixtures import Visit
from tests.browser.maths.reading import typed_names
from tests.browser.steps import cells, open_exercise
from tests.browser.test_pages import violations

Opening = Callable[..., Visit]
PHONE = {"width": 320, "height": 700}


@pytest.mark.long
def test_a_slip_is_marked_and_mended_by_keyboard(visit: Opening, service: str, axe: str) -> None:
    # The page's policy allows only its own scripts, so the checker needs ``bypass_csp``.
    page = visit(bypass_csp=True).page
    page.add_init_script(axe)
    open_exercise(page, service, "find-the-slip-scara")
    expect(cells(page).first).to_be_hidden()
    mark = page.get_by_role("button", name="alpha, link twist, row 2: 0", exact=True)
    expect(mark).to_have_attribute("aria-pressed", "false")
    mark.focus()
    page.keyboard.press("Space")
    expect(mark).to_have_attribute("aria-pressed", "true")
    expect(cells(page).nth(4)).to_have_value("a2")
    # Marked, but not mended: the mark is right, and the report says what is wrong.
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".part .points").first).to_have_text("4 / 8 points")
    expect(page.locator(".messages")).to_contain_text("Now write the mended table below")
    expect(page.locator(".slip-marks")).to_have_attribute("data-verdict", "correct")
    cells(page).nth(5).fill("180deg")
    page.keyboard.press("Control+Enter")
    expect(page.locator(".part .points").first).to_have_text("8 / 8 points")
    expect(page.locator(".messages")).to_contain_text("This was the slip")
    assert typed_names(page) == []
    assert violations(page, "") == []
    # The answer is still there after a reload.
    page.reload()
    expect(mark).to_have_attribute("aria-pressed", "true")
    expect(cells(page).nth(5)).to_have_value("180deg")


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "marked"),
    [("stanford", "alpha, link twist, row 2"), ("scara", "a, link length, row 1")],
)
def test_a_wrong_mark_has_a_hint(visit: Opening, service: str, name: str, marked: str) -> None:
    page = visit().page
    open_exercise(page, service, f"find-the-slip-{name}")
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".bar .hint")).to_have_text("First mark the cell with the slip.")
    page.locator(".slip-mark").filter(has_text=marked).click()
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".messages")).to_contain_text("The slip is not here")
    page.get_by_role("button", name="Hint", exact=True).click()
    expect(page.locator(".hint-steps > li")).to_contain_text("the four moves in a row")


@pytest.mark.campaign
def test_a_row_is_marked_on_a_phone(visit: Opening, service: str) -> None:
    page = visit(viewport=PHONE, has_touch=True, is_mobile=True).page
    open_exercise(page, service, "find-the-slip-stanford")
    page.get_by_role("button", name="mark row 3").tap()
    pressed = page.locator(".slip-mark[aria-pressed=true]")
    expect(pressed).to_have_count(4)
    box = pressed.first.bounding_box()
    assert box is not None
    assert box["height"] >= 44
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
    page.get_by_role("button", name="Check").tap()
    expect(page.locator(".messages")).to_contain_text("The slip is not here")
    expect(page.locator(".slip-marks")).to_have_attribute("data-verdict", "incorrect")
