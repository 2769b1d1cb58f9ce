"""Test the start page: levels, search, and check marks at solved exercises."""

import re
from collections.abc import Callable

import pytest
from dh_grader.catalogue import shipped_folder
from playwright.sync_api import Page, expect

from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise

Opening = Callable[..., Visit]

TABLE = ["a1", "0", "0", "theta1", "a2", "0", "0", "theta2"]

# The shipped exercises and a hostile one.
ALL = len([*shipped_folder().glob("*.toml")]) + 1


def found(page: Page, query: str) -> list[str]:
    """Return the titles that the search shows."""
    page.get_by_label("Find an exercise").fill(query)
    return page.locator(".exercises > li:visible h3").all_inner_texts()


def card(page: Page, title: str) -> str:
    """Return the text of the card with this title."""
    link = page.get_by_role("link", name=title, exact=True)
    return page.locator(".exercises > li", has=link).inner_text()


@pytest.mark.long
def test_exercises_are_grouped_searched_and_marked_as_done(visit: Opening, service: str) -> None:
    page = visit().page
    page.goto(service)
    expect(page.locator("#count")).to_have_text(f"{ALL} exercises")
    headings = page.locator(".group > h2").all_inner_texts()
    assert [each.strip() for each in headings] == [
        "Start here", "Basics", "Arms", "Industrial robots", "More exercises"
    ]  # fmt: skip
    first = card(page, "Planar RR arm")
    assert "20 min · 17 points" in first
    assert "standard" in first
    # The citation is on the page of the exercise.
    assert "MEAM" not in first

    pumas = ["PUMA 560 after Paul", "PUMA 560 after Craig"]
    assert found(page, "puma") == ["Spatial RRR arm", "Spherical wrist", *pumas]
    assert len(found(page, "6 DOF")) == len(found(page, "6 degrees of freedom")) > 20
    assert found(page, "7R")[0] == "Baxter's left arm"
    assert len(found(page, "7R")) == 5
    assert found(page, "proximal RRRP") == found(page, "modified rrrp")
    assert found(page, "proximal RRRP") == ["RRRP arm, practised in class"]
    expect(page.locator("#count")).to_have_text(f"1 of {ALL}")

    open_exercise(page, service, "planar-rr")
    expect(page.locator("[part=source]")).to_contain_text("Source: MEAM 520")
    for i, text in enumerate(TABLE):
        cells(page).nth(i).fill(text)
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".total")).to_contain_text("4 / 17")
    page.goto(service)
    assert "4 / 17 so far" in card(page, "Planar RR arm")
    expect(page.locator(".is-done")).to_have_count(0)

    # A worse answer does not take marks away; full marks in all parts are "done".
    open_exercise(page, service, "fundamental-rotations")
    for part, texts in enumerate(ROTATIONS):
        for i, text in enumerate(texts.split()):
            cells(page, part).nth(i).fill(text)
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".total")).to_contain_text("6 / 6")
    cells(page).first.fill("5")
    page.get_by_role("button", name="Check").click()
    expect(page.locator("td[data-verdict=incorrect]")).to_have_count(1)
    page.get_by_role("link", name="Next exercise").click()
    expect(page.get_by_role("heading", level=1)).to_contain_text("Composite rotations")
    page.goto(service)
    expect(page.locator(".is-done h3")).to_have_text("Fundamental rotations")
    assert "✓ Done" in card(page, "Fundamental rotations")
    expect(page.locator(".group", has_text="Basics").locator(".done-count")).to_have_text(
        re.compile(r"^1 of \d done$")
    )


ROTATIONS = [
    "1 0 0 0 cos(phi) -sin(phi) 0 sin(phi) cos(phi)",
    "cos(phi) 0 sin(phi) 0 1 0 -sin(phi) 0 cos(phi)",
    "cos(phi) -sin(phi) 0 sin(phi) cos(phi) 0 0 0 1",
]


@pytest.mark.long
def test_without_scripts_the_catalogue_is_a_plain_list(visit: Opening, service: str) -> None:
    opened = visit(java_script_enabled=False)
    page = opened.page
    page.goto(service)
    expect(page.get_by_role("search")).to_be_hidden()
    expect(page.locator(".exercises > li:visible")).to_have_count(ALL)
    page.get_by_role("link", name="Planar RR arm", exact=True).click()
    expect(page.get_by_text("Source: MEAM 520")).to_be_visible()
    page.get_by_role("link", name="Next exercise: Planar RRR arm with two rows given").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("Planar RRR arm with two rows given")
    opened.complaints.clear()
