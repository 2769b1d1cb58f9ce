"""The editor shows the student's form before anything is saved."""

from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.fixtures import Visit
from tests.browser.steps import cells
from tests.browser.test_pages import violations


@pytest.mark.long
def test_the_unsaved_text_is_tried_in_the_real_form(
    visit: Callable[..., Visit], service: str, axe: str
) -> None:
    page = visit(bypass_csp=True).page
    page.add_init_script(axe)
    page.goto(f"{service}/tutor/editor?exercise=planar-rr")
    expect(page.get_by_label("Exercise id")).to_have_value("planar-rr-copy")
    expect(page.get_by_text("This is a copy of planar-rr")).to_be_visible()
    text = page.get_by_label("Exercise file, TOML")
    text.fill(text.input_value().replace('title = "', 'title = "Unsaved: ', 1))
    page.get_by_role("button", name="Open the form").click()
    form = page.locator("dh-exercise")
    expect(form.get_by_role("heading", name="Unsaved: ")).to_be_visible()
    for i, entry in enumerate(["a1", "0", "0", "theta1", "a2", "0", "0", "theta2"]):
        cells(page).nth(i).fill(entry)
    form.get_by_role("button", name="Move it in 3D").click()
    expect(form.locator(".robot-view")).to_have_attribute("aria-busy", "false")
    form.get_by_role("button", name="Check").click()
    expect(form.locator("td[data-verdict=correct]")).to_have_count(8)
    assert "\n".join(violations(page, "")) == ""
    text.fill(text.input_value().replace("Unsaved: ", "Changed: ", 1))
    page.get_by_role("button", name="Update the form").click()
    expect(form.get_by_role("heading", name="Changed: ")).to_be_visible()
    # The answers are still there.
    expect(cells(page).first).to_have_value("a1")
