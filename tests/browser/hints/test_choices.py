"""A student with full marks looks at other valid choices of frames."""

from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.fixtures import Visit
from tests.browser.maths.reading import typed_names
from tests.browser.steps import cells, open_exercise
from tests.browser.test_pages import violations

Opening = Callable[..., Visit]
TABLE = ["a1", "0", "0", "q1", "a2", "0", "0", "q2"]


@pytest.mark.long
def test_other_choices_after_full_marks(visit: Opening, service: str, axe: str) -> None:
    page = visit(bypass_csp=True).page
    page.add_init_script(axe)
    open_exercise(page, service, "planar-rr")
    for i, text in enumerate(TABLE):
        cells(page).nth(i).fill(text)
    button = page.get_by_role("button", name="Show another valid choice of frames")
    expect(button).to_have_count(0)
    page.get_by_role("button", name="Check").click()
    button.focus()
    page.keyboard.press("Enter")
    choices = page.locator(".choices > ul > li")
    expect(choices).to_have_count(3)
    expect(choices.first.locator(".changed")).to_have_count(3)
    show = choices.first.get_by_role("button", name="Show it in 3D")
    expect(show).to_be_focused()
    page.keyboard.press("Enter")
    expect(choices.first.locator("canvas, svg").first).to_be_visible()
    expect(show).to_have_attribute("aria-expanded", "true")
    assert typed_names(page) == []
    # One view at a time.
    choices.nth(1).get_by_role("button", name="Show it in 3D").click()
    expect(choices.nth(1).locator("canvas, svg").first).to_be_visible()
    expect(choices.first.locator("canvas, svg")).to_have_count(0)
    assert violations(page, "") == []
    cells(page).first.fill("0")
    expect(page.locator(".choices")).to_have_count(0)
