"""A student fills in the form of an exercise by keyboard only."""

import re
from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from playwright.sync_api import expect

from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise, right_answers, type_with_tab
from tests.browser.student.steps import check, part

Opening = Callable[..., Visit]
IS_FOCUSED = "each => each.matches(':focus')"
LAST_ROW = slice(12, 16)


@pytest.mark.long
def test_the_stanford_arm_is_typed_from_an_empty_page_to_full_marks(
    visit: Opening, service: str, catalogue: Mapping[str, Exercise]
) -> None:
    page = visit().page
    open_exercise(page, service, "stanford-arm")
    answers = right_answers(catalogue["stanford-arm"])
    page.get_by_role("link", name="Skip to the content").focus()
    page.keyboard.press("Enter")
    for place, spec in enumerate(catalogue["stanford-arm"].parts):
        while not cells(page, place).first.evaluate(IS_FOCUSED):
            page.keyboard.press("Tab")
        # Tab leads from the last cell of A1 to the first of A2.
        type_with_tab(page, answers[spec.id])
    expect(page.get_by_role("navigation", name="Parts")).to_have_text(
        "Table6/66 of 6 filledLinks6/66 of 6 filledPose4/44 of 4 filled"
    )
    page.keyboard.press("Control+Enter")
    page.get_by_role("button", name="Check").focus()
    page.keyboard.press("Enter")
    expect(page.locator(".total")).to_have_text("32 / 32 points")


@pytest.mark.long
def test_the_tabs_of_matrices_follow_the_arrow_keys(visit: Opening, service: str) -> None:
    page = visit().page
    open_exercise(page, service, "stanford-arm")
    tabs = page.get_by_role("tab")
    expect(tabs).to_have_count(6)
    tabs.first.focus()
    page.keyboard.press("ArrowLeft")
    expect(tabs.nth(5)).to_be_focused()
    page.keyboard.press("Home")
    page.keyboard.press("ArrowRight")
    expect(page.get_by_role("tab", name="A2", selected=True)).to_be_focused()
    panel = page.get_by_role("tabpanel", name="A2")
    expect(panel).to_be_visible()
    expect(page.get_by_role("tabpanel")).to_have_count(1)
    # The last row of a homogeneous matrix is filled in, but is not an answer yet.
    last = [each.input_value() for each in panel.locator("input").all()[LAST_ROW]]
    assert last == ["0", "0", "0", "1"]
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".bar")).to_contain_text("Nothing is filled in yet.")
    # A matrix that is begun is sent with its last row.
    panel.locator("input").first.fill("c2")
    expect(page.locator(".hint")).to_be_hidden()
    check(page)
    expect(panel.locator("td[data-verdict=correct]")).to_have_count(5)
    expect(page.get_by_role("tab", name="A1 missing")).to_be_visible()


@pytest.mark.long
def test_check_leads_to_the_first_slip_and_reads_it_out(visit: Opening, service: str) -> None:
    page = visit().page
    open_exercise(page, service, "rrrp")
    table = ["l2", "0", "l1", "q1", "l3", "pi/2", "0", "q2", "0", "0", "l4", "q3", *["0"] * 4]
    for i, text in enumerate(table):
        cells(page).nth(i).fill(text)
    expect(page.locator(".saved")).to_have_text("Saved in this browser")
    part(page, 0).get_by_role("button", name="Denavit-Hartenberg table").click()
    expect(cells(page).first).to_be_hidden()
    # A folded part is folded after a reload, too, and a slip unfolds it.
    page.reload()
    expect(page.locator(".fold").first).to_have_attribute("aria-expanded", "false")
    expect(cells(page).first).to_be_hidden()
    check(page)
    wrong = page.locator("td[data-verdict=incorrect] input").first
    expect(wrong).to_be_focused()
    expect(wrong).to_have_attribute("aria-invalid", "true")
    # Names are typeset: in a description, each of their letters is a word.
    expect(wrong).to_have_accessible_description(re.compile(r"compare z\s*1 and z\s*2"))
    told = page.get_by_role("status").last
    expect(told).to_contain_text("First slip: alpha, link twist, row 2: incorrect.")
    expect(told).to_contain_text("is not right: compare")
    cells(page).nth(5).fill("pi")
    expect(cells(page).nth(5)).not_to_have_attribute("aria-invalid", "true")
