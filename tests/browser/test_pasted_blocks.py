"""Paste part of a table from a spreadsheet; undo a change in free play."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise, paste

Opening = Callable[..., Visit]

CLIPBOARD = ["clipboard-read", "clipboard-write"]


def texts(page: Page, selector: str) -> list[str]:
    return [each.input_value() for each in page.locator(selector).all()]


@pytest.mark.campaign
def test_a_block_fills_the_cells_from_the_cursor_on(visit: Opening, service: str) -> None:
    page = visit(permissions=CLIPBOARD).page
    open_exercise(page, service, "rrrp")
    table = cells(page)
    table.nth(6).focus()
    # Spreadsheets add quotes, and a line break at the end.
    paste(page, 'l1\t"q1"\r\n0\tq2\r\n')
    expect(table.nth(11)).to_have_value("q2")
    block = ["", "", "l1", "q1", "", "", "0", "q2"]
    assert texts(page, ".part >> nth=0 >> input")[4:12] == block
    expect(page.locator(".reading").first).to_contain_text("filled 4 cells")
    page.keyboard.press("Control+Z")
    expect(table.nth(11)).to_have_value("")
    assert set(texts(page, ".part >> nth=0 >> input")) == {""}
    page.keyboard.press("Control+Shift+Z")
    expect(table.nth(11)).to_have_value("q2")
    # A column fills cells downwards. One that is too long for the table stays in one cell.
    table.nth(1).focus()
    paste(page, "0\n180°\n0\n0")
    expect(table.nth(13)).to_have_value("0")
    table.nth(11).fill("")
    paste(page, "1\t2")
    expect(page.locator(".reading").first).to_contain_text("Not read")
    assert "2" in table.nth(11).input_value()
    # A script that is refused leaves the cell as it was.
    table.nth(11).fill("q2")
    paste(page, "for i = 1:2, L(i) = Link([0 0 a1 0]); end")
    expect(page.locator(".reading").first).to_contain_text("Not read as a table or matrix")
    expect(table.nth(11)).to_have_value("q2")


@pytest.mark.campaign
def test_changes_of_the_table_of_free_play_can_be_undone(visit: Opening, service: str) -> None:
    page = visit(permissions=CLIPBOARD).page
    page.goto(f"{service}/play")
    page.get_by_label("Start from a robot").select_option("SCARA, RRPR")
    cell = page.locator(".entry input")
    expect(cell).to_have_count(16)
    scara = texts(page, ".entry input")
    cell.nth(4).focus()
    paste(page, "0.1\tpi/2\n0.2\t0")
    expect(cell.nth(9)).to_have_value("0")
    assert texts(page, ".entry input")[4:10] == ["0.1", "pi/2", "0", "theta2", "0.2", "0"]
    # A pasted whole table replaces this one.
    paste(page, "DH = [a1 0 0 q1; a2 0 0 q2];")
    expect(cell).to_have_count(8)
    page.get_by_role("button", name="Remove row 1").click()
    expect(cell).to_have_count(4)
    cell.first.press("Control+Z")
    expect(cell).to_have_count(8)
    page.keyboard.press("Control+Z")
    expect(cell).to_have_count(16)
    expect(cell.nth(8)).to_have_value("0.2")
    page.keyboard.press("Control+Z")
    assert texts(page, ".entry input") == scara
    page.keyboard.press("Control+Y")
    expect(cell.nth(8)).to_have_value("0.2")
    # Keys typed into one cell are one step.
    cell.first.focus()
    page.keyboard.press("Control+A")
    page.keyboard.type("l1+l2")
    page.keyboard.press("Control+Z")
    expect(cell.first).to_have_value("a1")
