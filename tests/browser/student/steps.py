"""Helpers for tests of the student's form."""

from typing import Any, Final

from playwright.sync_api import Locator, Page, expect

PHONE: Final[dict[str, Any]] = {
    "viewport": {"width": 390, "height": 844},
    "has_touch": True,
    "is_mobile": True,
}
# The findings of axe in the exercise: each with its rule and its elements.
FINDINGS: Final = """async () => (await axe.run()).violations.map(
  ({ id, nodes }) => [id, nodes.map(({ target }) => target.join(" "))])"""


def part(page: Page, place: int) -> Locator:
    return page.locator(".part").nth(place)


def check(page: Page, *, tap: bool = False) -> None:
    """Check the answers, and wait for the report."""
    button = page.get_by_role("button", name="Check")
    if tap:
        button.tap()
    else:
        button.click()
    expect(page.locator(".total")).to_contain_text("points")
    expect(page.locator(".total.outdated")).to_have_count(0)
