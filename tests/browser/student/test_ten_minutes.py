"""Test the page "DH in ten minutes"."""

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.browser.fixtures import Visit
from tests.browser.maths.reading import typed_names
from tests.browser.steps import open_exercise
from tests.browser.test_pages import violations

Opening = Callable[..., Visit]

# A wrong and a right answer to each screen with a single number, and what the service says.
WRONG = {
    "theta": ("q2", "the variable of joint 2"),
    "d": ("0", "A distance is left out of d"),
    "a": ("r", "check the distance along x. r is the length of link 2."),
    "alpha": ("-90", "The sign of α is wrong"),
}
RIGHT = {"theta": "q1", "d": "h", "a": "w", "alpha": "90"}
LAST_ROWS = {"standard": ["r", "0", "0", "q2"], "modified": ["r", "0", "0", "0"]}
DIRECTIONS = {"standard": "to the side", "modified": "up, along the column"}
# The direction of the other convention, and what the page says about it.
NEIGHBOURS = {"standard": "points up is", "modified": "points to the side is"}
PHONE = {"width": 390, "height": 844}
IS_3D = re.compile("three|robot_view|/scene")


def told(page: Page) -> Locator:
    return page.locator(".screen:not([hidden]) form .told")


def follow_by_keyboard(page: Page, name: str) -> None:
    page.locator(".screen:not([hidden])").get_by_role("link", name=name).focus()
    page.keyboard.press("Enter")


@pytest.mark.long
@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_six_screens_are_solved_by_keyboard(
    visit: Opening, service: str, axe: str, convention: str
) -> None:
    page = visit(reduced_motion="reduce", viewport=PHONE, bypass_csp=True).page
    page.add_init_script(axe)
    loaded: list[str] = []
    page.on("request", lambda request: loaded.append(request.url))
    page.goto(service)
    page.get_by_role("link", name="DH in ten minutes").click()
    other = DIRECTIONS["modified" if convention == "standard" else "standard"]
    for name in (re.compile(convention, re.IGNORECASE), other, DIRECTIONS[convention]):
        radio = page.get_by_role("radio", name=name)
        radio.focus()
        page.keyboard.press("Space")
        expect(radio).to_be_checked()
        if name == other:
            page.keyboard.press("Enter")
            expect(told(page)).to_contain_text(NEIGHBOURS[convention])
    page.keyboard.press("Enter")
    expect(told(page)).to_contain_text("Right.")
    assert violations(page, "") == []
    for screen, right in RIGHT.items():
        follow_by_keyboard(page, "Next")
        expect(page.locator(f"#{screen} h2")).to_be_focused()
        page.get_by_role("button", name="Play", exact=True).focus()
        page.keyboard.press("Enter")
        expect(page.locator(f"#{screen} .caption")).to_contain_text(
            "about" if screen in ("theta", "alpha") else "along"
        )
        page.locator(f"#{screen} input").focus()
        page.keyboard.insert_text(WRONG[screen][0])
        page.keyboard.press("Enter")
        expect(told(page)).to_contain_text(WRONG[screen][1])
        assert typed_names(page) == []
        page.locator(f"#{screen} input").fill(right)
        page.keyboard.press("Enter")
        expect(told(page)).to_contain_text("Right.")
    follow_by_keyboard(page, "Next")
    expect(page.locator("#table h2")).to_be_focused()
    # Each of the four moves is told when it is shown, not only the last one.
    page.locator("#table").get_by_role("button", name="Play", exact=True).press("Enter")
    expect(page.locator("#table .caption")).to_contain_text("1 of 4")
    page.locator("#table input").first.focus()
    for text in LAST_ROWS[convention]:
        page.keyboard.insert_text(text)
        page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    expect(told(page)).to_contain_text("Right.")
    assert violations(page, "") == []
    assert page.evaluate("document.documentElement.scrollWidth") == PHONE["width"]
    assert [each for each in loaded if IS_3D.search(each)] == []

    # The browser keeps the progress and the convention.
    page.reload()
    expect(page.locator("nav .solved")).to_have_count(6)
    expect(page.get_by_role("radio", name=re.compile(convention, re.IGNORECASE))).to_be_checked()
    follow_by_keyboard(page, "Next")
    expect(page.get_by_role("heading", level=2)).to_contain_text("A worked example")


@pytest.mark.long
@pytest.mark.parametrize("look", [{"color_scheme": "dark"}, {"forced_colors": "active"}])
def test_the_screens_have_enough_contrast(
    visit: Opening, service: str, axe: str, look: dict[str, str]
) -> None:
    page = visit(bypass_csp=True, **look).page
    page.add_init_script(axe)
    page.goto(f"{service}/learn-dh#alpha")
    expect(page.locator("#alpha")).to_be_visible()
    assert violations(page, "") == []
    page.get_by_role("link", name="A worked example").click()
    assert violations(page, "") == []


@pytest.mark.long
def test_the_arm_is_shown_in_3d_by_demand(visit: Opening, service: str) -> None:
    page = visit().page
    page.goto(f"{service}/learn-dh?convention=modified#table")
    with page.expect_response("**/v1/frames") as answered:
        page.get_by_role("button", name="Play the rows in 3D").click()
    assert len(answered.value.json()["table"]["row_joints"]) == len(LAST_ROWS) + 1
    expect(page.get_by_role("button", name="Play a row")).to_be_visible()
    page.get_by_role("radio", name="Standard").check()
    expect(page.get_by_role("button", name="Play a row")).to_have_count(0)


@pytest.mark.long
def test_the_page_can_be_read_with_scripts_blocked(visit: Opening, service: str) -> None:
    opened = visit(java_script_enabled=False)
    opened.page.goto(f"{service}/learn-dh")
    expect(opened.page.get_by_role("heading", level=2)).to_have_count(7)
    expect(opened.page.get_by_text("Modified: z₁ belongs to joint 1")).to_be_visible()
    opened.complaints.clear()


@pytest.mark.long
def test_each_column_head_leads_to_its_screen(visit: Opening, service: str) -> None:
    page = visit().page
    open_exercise(page, service, "planar-rrr-faded")
    for name, screen in (("a", "a"), ("α", "alpha"), ("d", "d"), ("θ", "theta")):
        link = page.get_by_role("link", name=f"What is {name}?").first
        with page.context.expect_page() as opened:
            link.press("Enter")
        beside = opened.value
        expect(beside.locator(f"#{screen}")).to_be_visible()
        expect(beside.get_by_role("radio", name="Modified")).to_be_checked()
        beside.close()


@pytest.mark.long
def test_a_link_transform_leads_to_its_matrix(visit: Opening, service: str) -> None:
    page = visit().page
    open_exercise(page, service, "planar-rr")
    with page.context.expect_page() as opened:
        page.get_by_role("link", name="What is A1?").click()
    expect(opened.value.locator("#link-transform")).to_be_in_viewport()
    expect(opened.value.get_by_role("radio", name="Standard")).to_be_checked()
    expect(opened.value.locator("#frames")).to_be_hidden()


@pytest.mark.long
def test_given_rows_are_filled_in_and_cannot_be_changed(
    visit: Opening, service: str, axe: str
) -> None:
    page = visit(bypass_csp=True).page
    page.add_init_script(axe)
    open_exercise(page, service, "planar-rrr-faded")
    part = page.locator(".part").first
    cells = part.locator(".entry input")
    given = ["0", "0", "0", "q1", "l1", "0", "0", "q2"]
    assert [each.input_value() for each in cells.all()] == given + [""] * 8
    second = page.get_by_role("textbox", name="a, link length, row 2, given")
    assert second.get_attribute("readonly") is not None
    second.focus()
    page.keyboard.type("7")
    expect(second).to_have_value("l1")
    assert violations(page, "") == []
    for i, text in enumerate(["l2", "0", "0", "q3", "l3", "0", "0", "0"]):
        cells.nth(len(given) + i).fill(text)
    page.get_by_role("button", name="Check", exact=True).click()
    expect(part.locator(".badge")).to_have_text("correct")
    expect(part.locator("tr.given td.worth")).to_have_text(["given", "given"])
    expect(page.locator(".saved")).to_have_text("Saved in this browser")
    page.reload()
    expect(cells.nth(len(given))).to_have_value("l2")
    assert [each.input_value() for each in cells.all()][: len(given)] == given
