"""Test the student's form: suggested corrections, and whole tables in one box."""

from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise
from tests.browser.student.steps import check, part
from tests.browser.test_pages import violations

Opening = Callable[..., Visit]
DEGREES = [
    "0", "-90", "0", "theta1", "0", "90", "d2", "theta2", "0", "0", "d3", "0",
    "0", "-90", "0", "theta4", "0", "90", "0", "theta5", "0", "0", "d6", "theta6",
]  # fmt: skip


@pytest.mark.long
def test_angles_are_read_as_degrees_where_the_report_proposes_it(
    visit: Opening, service: str, axe: str
) -> None:
    page = visit(bypass_csp=True).page
    page.add_init_script(axe)
    open_exercise(page, service, "stanford-arm")
    for i, text in enumerate(DEGREES):
        cells(page).nth(i).fill(text)
    check(page)
    button = page.get_by_role("button", name="Read angles as degrees")
    assert violations(page, "") == []
    button.first.click()
    expect(part(page, 0).locator(".badge").first).to_have_text("correct")
    expect(page.get_by_label("Angles without a unit")).to_have_value("degrees")
    expect(button).to_have_count(0)


@pytest.mark.long
def test_columns_are_reordered_where_the_report_proposes_it(visit: Opening, service: str) -> None:
    page = visit().page
    open_exercise(page, service, "planar-rr")
    for i, text in enumerate(["theta1", "0", "a1", "0", "theta2", "0", "a2", "0"]):
        cells(page).nth(i).fill(text)
    check(page)
    page.get_by_role("button", name="Reorder columns").click()
    expect(part(page, 0).locator(".badge").first).to_have_text("correct")
    right = ["a1", "0", "0", "theta1", "a2", "0", "0", "theta2"]
    assert [each.input_value() for each in cells(page).all()[:8]] == right
    cells(page).first.press("Control+Z")
    expect(cells(page).first).to_have_value("theta1")


@pytest.mark.long
def test_a_box_takes_a_whole_table_and_says_what_does_not_fit(
    visit: Opening, service: str, axe: str
) -> None:
    page = visit(bypass_csp=True).page
    page.add_init_script(axe)
    open_exercise(page, service, "planar-rr")
    box = part(page, 0).locator(".paste-box")
    box.locator("summary").click()
    assert violations(page, "") == []
    box.locator("textarea").fill("[1 2 3 4; 5 6 7 8; 9 1 2 3]")
    box.get_by_role("button").click()
    expect(box).to_contain_text("3 rows")
    box.locator("textarea").fill("L(1) = Link([0 0 a1 0]); L(2) = Link([0 0 a2 0]);")
    box.get_by_role("button").click()
    expect(cells(page).first).to_have_value("a1")
    expect(box.locator("textarea")).to_be_hidden()


@pytest.mark.long
def test_nothing_covers_the_row_in_hand_at_200_percent(visit: Opening, service: str) -> None:
    # A window of 1280 × 800 at 200 %.
    page = visit(viewport={"width": 640, "height": 400}).page
    open_exercise(page, service, "stanford-arm")
    for i in (0, 9, 23):
        cell = cells(page).nth(i)
        cell.focus()
        is_free = """each => {
          const { left, right, top, bottom } = each.getBoundingClientRect();
          const root = each.getRootNode();
          const found = root.elementFromPoint((left + right) / 2, (top + bottom) / 2);
          return top >= 0 && bottom <= innerHeight && found === each;
        }"""
        assert cell.evaluate(is_free)


@pytest.mark.long
def test_the_statement_is_not_cut(visit: Opening, service: str) -> None:
    page = visit(viewport={"width": 1280, "height": 800}).page
    open_exercise(page, service, "stanford-arm")
    task = page.locator(".about")
    assert task.evaluate("each => each.scrollHeight <= each.clientHeight + 2")
    page.evaluate("scrollTo(0, document.body.scrollHeight)")
    last = page.locator(".symbols dd").last.bounding_box()
    assert last is not None
    assert last["y"] + last["height"] <= 800


@pytest.mark.long
def test_forced_colours_show_which_matrix_is_open(visit: Opening, service: str) -> None:
    page = visit(forced_colors="active").page
    open_exercise(page, service, "planar-rr")
    lines = (
        part(page, 1)
        .get_by_role("tab")
        .evaluate_all("tabs => tabs.map(each => getComputedStyle(each).borderBottomColor)")
    )
    assert len(lines) == len(set(lines)) == 2


@pytest.mark.long
def test_a_number_that_looks_like_degrees_is_said_to_be_read_in_radians(
    visit: Opening, service: str
) -> None:
    page = visit().page
    open_exercise(page, service, "planar-rr")
    alpha = cells(page).nth(1)
    alpha.fill("-90")
    shown = page.locator(f"#{alpha.get_attribute('id')}-shown")
    expect(shown).to_contain_text("rad")
    line = part(page, 0).locator(".notes").first
    expect(line).to_contain_text("90 is read as 90 rad. For degrees, write 90°")
    line.get_by_role("button", name="Read angles as degrees").click()
    expect(page.get_by_label("Angles without a unit")).to_have_value("degrees")
    expect(shown).not_to_contain_text("rad")
    expect(line).to_be_hidden()
    expect(page.locator("dh-exercise .aloud[role=status]")).to_have_text(
        "Angles without a unit are read as degrees."
    )
    expect(alpha).to_be_focused()
    # Nothing was checked.
    expect(page.locator(".total")).to_be_empty()
