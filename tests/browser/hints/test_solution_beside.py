"""A student opens the model solution, and compares it with each matrix of the answer."""

from collections.abc import Callable

import pytest
from dh_grader.catalogue import load_catalogue, shipped_folder
from playwright.sync_api import expect

from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise, right_answers
from tests.browser.student.steps import PHONE, check
from tests.browser.test_pages import violations


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
