"""Test hints on the page."""

from collections.abc import Callable

import pytest
from dh_grader.catalogue import load_catalogue, shipped_folder
from playwright.sync_api import Page, expect

from tests.browser.fixtures import Visit
from tests.browser.maths.reading import typed_names
from tests.browser.steps import cells, open_exercise, right_answers
from tests.browser.student.steps import PHONE, check
from tests.browser.test_pages import violations

# --- A student asks for hints in a real browser, by mouse, keyboard and on a phone

Opening = Callable[..., Visit]
TABLE = ["a1", "0", "0", "q1", "a2", "pi", "0", "q2"]
ALPHA = 5


def check_answer(page: Page, alpha: str) -> None:
    cells(page).nth(ALPHA).fill(alpha)
    with page.expect_response("**/grade"):
        page.get_by_role("button", name="Check").click()


def wrong_table(page: Page, service: str) -> None:
    open_exercise(page, service, "planar-rr")
    for i, text in enumerate(TABLE):
        cells(page).nth(i).fill(text)
    check_answer(page, "pi")


@pytest.mark.long
def test_three_hints_with_a_try_in_between(visit: Opening, service: str, axe: str) -> None:
    page = visit(bypass_csp=True).page
    page.add_init_script(axe)
    wrong_table(page, service)
    button, steps = page.locator(".hints button"), page.locator(".hint-steps > li")
    button.focus()
    page.keyboard.press("Enter")
    expect(steps).to_have_count(1)
    expect(steps.first).to_be_focused()
    expect(steps.first).to_contain_text("Look at")
    # The same answer is no try; another one is.
    expect(button).to_be_hidden()
    check_answer(page, "pi")
    expect(button).to_be_hidden()
    expect(steps).to_have_count(1)
    check_answer(page, "-pi")
    expect(button).to_have_text("Hint 2 of 3")
    button.click()
    expect(steps).to_have_count(2)
    picture = steps.nth(1).get_by_role("img", name="Link twist α: the picture of this rule")
    expect(picture).to_be_visible()
    assert picture.evaluate("each => each.decode().then(() => each.naturalWidth)") > 100
    assert violations(page, "") == []
    check_answer(page, "pi")
    button.click()
    expect(steps).to_have_count(3)
    expect(steps.last).to_contain_text("point your right thumb along")
    assert typed_names(page) == []
    expect(button).to_be_hidden()
    check_answer(page, "0")
    expect(page.locator(".hints")).to_have_count(0)


@pytest.mark.long
def test_the_hints_at_a_cell_go_on_after_another_mistake(visit: Opening, service: str) -> None:
    page = visit().page
    wrong_table(page, service)
    message = page.locator(".messages li, .notes li").filter(has=page.locator(".hints"))
    before = message.inner_text()
    button, steps = page.locator(".hints button"), page.locator(".hint-steps > li")
    button.click()
    expect(steps).to_have_count(1)
    check_answer(page, "90deg")
    expect(button).to_have_text("Hint 2 of 3")
    assert message.inner_text() != before
    button.click()
    expect(steps).to_have_count(2)
    expect(steps.last).to_contain_text("by the right-hand rule")


@pytest.mark.long
def test_a_first_view_loads_no_hints(visit: Opening, service: str) -> None:
    opened = visit()
    page = opened.page
    loaded: list[str] = []
    page.on("request", lambda request: loaded.append(request.url))
    open_exercise(page, service, "planar-rr")
    page.wait_for_load_state("networkidle")
    assert loaded
    assert [url for url in loaded if "/hints" in url] == []
    for i, text in enumerate(TABLE):
        cells(page).nth(i).fill(text)
    check_answer(page, "pi")
    expect(page.locator(".hints button")).to_be_visible()
    assert [url for url in loaded if "/static/hints-" in url]


@pytest.mark.long
def test_a_hint_fits_on_a_phone(visit: Opening, service: str) -> None:
    page = visit(**PHONE).page
    wrong_table(page, service)
    for alpha in ("-pi", "pi", "-pi"):
        page.locator(".hints button").tap()
        expect(page.locator(".hint-steps")).to_be_visible()
        check_answer(page, alpha)
    expect(page.locator(".hint-steps img")).to_be_visible()
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["viewport"]["width"]


# --- A student with full marks looks at other valid choices of frames

CHOICES_TABLE = ["a1", "0", "0", "q1", "a2", "0", "0", "q2"]


@pytest.mark.long
def test_other_choices_after_full_marks(visit: Opening, service: str, axe: str) -> None:
    page = visit(bypass_csp=True).page
    page.add_init_script(axe)
    open_exercise(page, service, "planar-rr")
    for i, text in enumerate(CHOICES_TABLE):
        cells(page).nth(i).fill(text)
    button = page.get_by_role("button", name="Show another valid choice of frames")
    expect(button).to_have_count(0)
    page.get_by_role("button", name="Check").click()
    button.focus()
    page.keyboard.press("Enter")
    choices = page.locator(".choices > ul > li")
    expect(choices).to_have_count(3)
    expect(choices.first.locator(".changed")).to_have_count(3)
    show = choices.first.get_by_role("button", name="Show it in 3D")
    expect(show).to_be_focused()
    page.keyboard.press("Enter")
    expect(choices.first.locator("canvas, svg").first).to_be_visible()
    expect(show).to_have_attribute("aria-expanded", "true")
    assert typed_names(page) == []
    # One view at a time.
    choices.nth(1).get_by_role("button", name="Show it in 3D").click()
    expect(choices.nth(1).locator("canvas, svg").first).to_be_visible()
    expect(choices.first.locator("canvas, svg")).to_have_count(0)
    assert violations(page, "") == []
    cells(page).first.fill("0")
    expect(page.locator(".choices")).to_have_count(0)


# --- A student opens the model solution, and compares it with each matrix of the answer


@pytest.mark.long
@pytest.mark.parametrize("phone", [False, True])
def test_the_solution_opens_in_the_page_with_named_matrices(
    visit: Callable[..., Visit], service: str, axe: str, phone: bool
) -> None:
    page = visit(bypass_csp=True, **(PHONE if phone else {})).page
    page.add_init_script(axe)
    open_exercise(page, service, "planar-rr")
    answers = right_answers(load_catalogue(shipped_folder())["planar-rr"])
    for i, texts in enumerate(answers.values()):
        for j, text in enumerate(texts):
            cells(page, i).nth(j).evaluate(
                """(cell, text) => {
                  cell.value = text;
                  cell.dispatchEvent(new Event("input"));
                }""",
                text,
            )
    check(page)
    page.get_by_role("button", name="Compare with the model solution").click()
    beside = page.locator("section.solution-beside")
    expect(beside.get_by_role("heading", level=3).first).to_be_focused()
    expect(page.locator(".bar .solution-beside")).to_have_count(0)
    heads = beside.locator("h4").all_text_contents()
    assert heads[:6] == [
        "Your answer", "Model solution", "A1, yours", "A1, model", "A2, yours", "A2, model",
    ]  # fmt: skip
    expect(beside.locator("h4 math")).to_have_count(4)
    assert violations(page, "") == []

    cells(page).first.fill("a2")
    expect(page.locator(".solution-beside")).to_have_count(0)
