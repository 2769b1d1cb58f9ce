"""Test the page of generated robots."""

import re
from collections.abc import Callable
from typing import Any

import httpx
import pytest
from playwright.sync_api import Page, expect

from tests.browser.fixtures import Visit
from tests.browser.maths.reading import typed_names
from tests.browser.steps import cells
from tests.browser.test_pages import violations

Opening = Callable[..., Visit]
SIZES = {"desktop": {"width": 1280, "height": 900}, "phone": {"width": 390, "height": 844}}


def robot(page: Page) -> str:
    """Return the id of the robot in the address."""
    page.wait_for_url(re.compile("#practice-"))
    return page.url.partition("#")[2]


def model_cells(service: str, exercise: str) -> list[str]:
    answered = httpx.get(f"{service}/v1/exercises/{exercise}/solution").raise_for_status()
    rows: list[dict[str, Any]] = answered.json()["parts"][0]["answer"]["rows"]
    return [str(row[name]) for row in rows for name in ("a", "alpha", "d", "theta")]


@pytest.mark.long
@pytest.mark.parametrize("size", SIZES)
def test_a_student_solves_a_robot_and_takes_another(
    size: str, visit: Opening, service: str, axe: str
) -> None:
    # The checker of accessibility needs ``bypass_csp``.
    page = visit(viewport=SIZES[size], bypass_csp=True).page
    page.add_init_script(axe)
    page.goto(f"{service}/")
    page.get_by_role("link", name="Practise with generated robots").click()
    first = robot(page)
    assert first.startswith("practice-1-standard~")
    expect(page.get_by_role("button", name="Easier")).to_be_disabled()
    for i, text in enumerate(model_cells(service, first)):
        cells(page).nth(i).fill(text)
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".practice-done")).to_have_text("✓ Done · 1 robot of this level solved")
    assert typed_names(page) == []
    assert violations(page, "") == []
    page.wait_for_function(
        "document.querySelector('dh-exercise').shadowRoot.querySelector('.about img').naturalWidth"
    )

    # Also by keyboard.
    page.get_by_role("button", name="Another like this").focus()
    page.keyboard.press("Enter")
    page.wait_for_url(lambda url: not url.endswith(first))
    second = robot(page)
    assert second.startswith("practice-1-standard~")
    expect(page.locator(".practice-done")).to_have_text("1 robot of this level solved")
    expect(cells(page).first).to_have_value("")
    page.get_by_role("button", name="Harder").click()
    page.wait_for_url(re.compile("#practice-2-standard~"))
    expect(page.locator("#practice-level")).to_have_value("2")
    harder = robot(page)
    page.locator("#practice-convention").select_option("modified")
    page.wait_for_url(re.compile("#practice-2-modified~"))
    assert robot(page) == harder.replace("standard", "modified")
    expect(page.locator(".badge").first).to_have_text("modified")
    width = page.evaluate("[document.documentElement.scrollWidth, innerWidth]")
    assert width[0] <= width[1]

    # Back leads to the robots of before; their marks stay.
    for back in (harder, second, first):
        page.go_back()
        page.wait_for_url(re.compile(back))
    expect(page.locator(".practice-done")).to_contain_text("✓ Done")


@pytest.mark.long
def test_back_is_followed_though_a_robot_has_just_loaded(visit: Opening, service: str) -> None:
    # A robot may be ready after the address has changed, but before the page is notified of it.
    page = visit().page
    page.goto(f"{service}/practice#practice-1-standard~5")
    expect(page.locator("#title")).to_have_text("Practice robot 5, level 1")
    page.evaluate(
        """() => {
            location.hash = "practice-2-standard~6";
            document.querySelector("dh-exercise").dispatchEvent(new CustomEvent("ready"));
        }"""
    )
    expect(page.locator("#title")).to_have_text("Practice robot 6, level 2")
    assert robot(page) == "practice-2-standard~6"


@pytest.mark.long
def test_a_link_shares_one_robot(visit: Opening, service: str) -> None:
    page = visit().page
    page.goto(f"{service}/practice#practice-3-modified~1a")
    expect(page.locator("#practice-level")).to_have_value("3")
    expect(page.locator("#title")).to_have_text("Practice robot 1a, level 3")
    page.get_by_role("link", name="Link to this robot").click()
    page.wait_for_url(re.compile("exercises/practice-3-modified~1a"))
    expect(page.locator("#title")).to_have_text("Practice robot 1a, level 3")
    page.get_by_role("link", name="More robots like this").click()
    expect(page.locator("#practice-convention")).to_have_value("modified")
    assert robot(page) == "practice-3-modified~1a"


@pytest.mark.long
def test_an_element_deals_robots_of_its_level(visit: Opening, service: str) -> None:
    page = visit().page
    page.goto(f"{service}/practice#practice-1-standard~5")
    expect(page.locator(".part")).to_be_visible()
    page.evaluate(
        """() => {
            const made = document.createElement("dh-exercise");
            made.setAttribute("practice", "4");
            made.setAttribute("convention", "modified");
            document.querySelector("dh-exercise").replaceWith(made);
        }"""
    )
    expect(page.locator("#practice-level")).to_have_value("4")
    expect(page.locator("#practice-convention")).to_have_value("modified")
    expect(page.get_by_role("button", name="Harder")).to_be_disabled()
