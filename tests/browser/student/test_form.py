"""Test the form of an exercise."""

import re
from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from playwright.sync_api import expect

from tests.browser.fixtures import Visit
from tests.browser.maths.reading import typed_names
from tests.browser.steps import cells, open_exercise, right_answers, type_with_tab
from tests.browser.student.steps import check, part
from tests.browser.test_pages import violations

# --- Test the student's form: suggested corrections, and whole tables in one box

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


# --- If a student changes a checked answer, the page removes outdated verdicts


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


# --- The page says if an exercise uses another convention than the previous exercise


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


# --- A student marks and corrects a slip by keyboard and on a phone

PHONE = {"width": 320, "height": 700}


@pytest.mark.long
def test_a_slip_is_marked_and_mended_by_keyboard(visit: Opening, service: str, axe: str) -> None:
    # The page's policy allows only its own scripts, so the checker needs ``bypass_csp``.
    page = visit(bypass_csp=True).page
    page.add_init_script(axe)
    open_exercise(page, service, "find-the-slip-scara")
    expect(cells(page).first).to_be_hidden()
    mark = page.get_by_role("button", name="alpha, link twist, row 2: 0", exact=True)
    expect(mark).to_have_attribute("aria-pressed", "false")
    mark.focus()
    page.keyboard.press("Space")
    expect(mark).to_have_attribute("aria-pressed", "true")
    expect(cells(page).nth(4)).to_have_value("a2")
    # Marked, but not mended: the mark is right, and the report says what is wrong.
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".part .points").first).to_have_text("4 / 8 points")
    expect(page.locator(".messages")).to_contain_text("Now write the mended table below")
    expect(page.locator(".slip-marks")).to_have_attribute("data-verdict", "correct")
    cells(page).nth(5).fill("180deg")
    page.keyboard.press("Control+Enter")
    expect(page.locator(".part .points").first).to_have_text("8 / 8 points")
    expect(page.locator(".messages")).to_contain_text("This was the slip")
    assert typed_names(page) == []
    assert violations(page, "") == []
    # The answer is still there after a reload.
    page.reload()
    expect(mark).to_have_attribute("aria-pressed", "true")
    expect(cells(page).nth(5)).to_have_value("180deg")


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "marked"),
    [("stanford", "alpha, link twist, row 2"), ("scara", "a, link length, row 1")],
)
def test_a_wrong_mark_has_a_hint(visit: Opening, service: str, name: str, marked: str) -> None:
    page = visit().page
    open_exercise(page, service, f"find-the-slip-{name}")
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".bar .hint")).to_have_text("First mark the cell with the slip.")
    page.locator(".slip-mark").filter(has_text=marked).click()
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".messages")).to_contain_text("The slip is not here")
    page.get_by_role("button", name="Hint", exact=True).click()
    expect(page.locator(".hint-steps > li")).to_contain_text("the four moves in a row")


@pytest.mark.campaign
def test_a_row_is_marked_on_a_phone(visit: Opening, service: str) -> None:
    page = visit(viewport=PHONE, has_touch=True, is_mobile=True).page
    open_exercise(page, service, "find-the-slip-stanford")
    page.get_by_role("button", name="mark row 3").tap()
    pressed = page.locator(".slip-mark[aria-pressed=true]")
    expect(pressed).to_have_count(4)
    box = pressed.first.bounding_box()
    assert box is not None
    assert box["height"] >= 44
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
    page.get_by_role("button", name="Check").tap()
    expect(page.locator(".messages")).to_contain_text("The slip is not here")
    expect(page.locator(".slip-marks")).to_have_attribute("data-verdict", "incorrect")


# --- A student fills in the form of an exercise by keyboard only

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
