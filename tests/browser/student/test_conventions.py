"""The page says if an exercise uses another convention than the previous exercise."""

from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.fixtures import Visit
from tests.browser.steps import open_exercise


@pytest.mark.long
def test_the_form_says_that_the_convention_has_changed(
    visit: Callable[..., Visit], service: str
) -> None:
    page = visit().page
    line = page.locator(".convention-line")
    open_exercise(page, service, "first-arm")
    expect(line).to_have_count(0)
    open_exercise(page, service, "first-arm-modified")
    expect(line).to_have_text(
        "This exercise uses the modified convention. "
        "The exercise before used the standard convention."
    )
    page.reload()
    expect(line).to_have_count(1)
    open_exercise(page, service, "first-arm")
    expect(line).to_contain_text("uses the standard convention")
    open_exercise(page, service, "planar-rr")
    expect(page.locator(".part").first).to_be_visible()
    expect(line).to_have_count(0)
