"""If a student changes a checked answer, the page removes outdated verdicts."""

from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise
from tests.browser.student.steps import check, part

Opening = Callable[..., Visit]


@pytest.mark.long
def test_a_changed_cell_loses_its_mark_and_the_report_says_that_it_is_older(
    visit: Opening, service: str
) -> None:
    page = visit().page
    open_exercise(page, service, "planar-rr")
    for i, text in enumerate(["a1", "pi/2", "0", "theta1", "a2", "pi/2", "0", "theta2"]):
        cells(page).nth(i).fill(text)
    check(page)
    since = page.locator(".since:visible")
    expect(since).to_have_count(0)
    marks = part(page, 0).locator("td[data-verdict]")
    expect(marks).to_have_count(8)
    told = part(page, 0).locator(".notes li", has_text="α").first
    expect(told.locator(".badge[data-verdict]")).to_have_count(1)

    cells(page).nth(1).fill("0")
    expect(marks).to_have_count(7)
    expect(told).to_contain_text("before your change")
    expect(told.locator("p > button, .badge[data-verdict]")).to_have_count(0)
    expect(page.locator(".total")).to_contain_text("for your answer before the change")
    expect(part(page, 0).locator("header .since")).to_have_text("before your change")

    check(page)
    expect(since).to_have_count(0)
    expect(marks).to_have_count(8)


@pytest.mark.long
def test_another_unit_makes_the_report_older(visit: Opening, service: str) -> None:
    page = visit().page
    open_exercise(page, service, "planar-rr")
    cells(page).first.fill("a1")
    check(page)
    page.get_by_label("Angles without a unit").select_option("degrees")
    expect(part(page, 0).locator("header .since")).to_be_visible()
    expect(page.locator(".total")).to_contain_text("for your answer before the change")
