"""Test a student who comes back, or works in two tabs."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, Route, expect

from tests.browser.conftest import Origin
from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise
from tests.browser.student.steps import check

# --- Scripts and drawings that arrive later: a failed request is tried again

Opening = Callable[..., Visit]
NOT_LOADED = "could not be loaded"


def is_drawn(page: Page) -> None:
    expect(page.locator(".robot-view")).to_have_attribute("aria-busy", "false")
    expect(page.locator(".robot-view canvas")).to_be_visible()


def test_the_3d_view_opens_after_a_failed_request(visit: Opening, service: str) -> None:
    opened = visit()
    page = opened.page
    open_exercise(page, service, "planar-rr")
    button = page.get_by_role("button", name="Move it in 3D")
    page.context.set_offline(True)
    for _ in range(2):
        button.click()
        expect(page.locator(".statement")).to_contain_text(NOT_LOADED)
        expect(button).not_to_have_attribute("aria-busy", "true")
    page.context.set_offline(False)
    button.click()
    is_drawn(page)
    expect(page.locator(".statement")).not_to_contain_text(NOT_LOADED)
    opened.complaints.clear()


@pytest.mark.long
@pytest.mark.parametrize("lost", ["robot_view-", "scene-", "three-0.185.1.core"])
def test_the_3d_view_opens_if_any_of_its_files_was_lost(
    visit: Opening, service: str, lost: str
) -> None:
    opened = visit()
    page = opened.page
    page.route(f"**/static/{lost}*", lambda route: route.abort())
    open_exercise(page, service, "planar-rr")
    page.get_by_role("button", name="Move it in 3D").click()
    expect(page.locator(".statement")).to_contain_text(NOT_LOADED)
    page.unroute_all(behavior="wait")
    page.get_by_role("button", name="3D", exact=False).last.click()
    is_drawn(page)
    opened.complaints.clear()


@pytest.mark.long
def test_a_lost_scene_can_be_loaded_over_its_drawing(visit: Opening, service: str) -> None:
    opened = visit()
    page = opened.page
    page.route("**/static/scene-*", lambda route: route.abort())
    page.goto(f"{service}/play")
    again = page.get_by_role("button", name="Try 3D again")
    expect(
        page.get_by_role("img", name="Drawing of the robot at these joint values")
    ).to_be_visible()
    again.click()
    expect(again).not_to_have_attribute("aria-busy", "true")
    page.unroute_all(behavior="wait")
    again.click()
    is_drawn(page)
    expect(again).to_be_hidden()
    opened.complaints.clear()


@pytest.mark.long
def test_the_player_of_rows_opens_after_a_failed_request(visit: Opening, service: str) -> None:
    opened = visit()
    page = opened.page
    page.route("**/static/row_player-*", lambda route: route.abort())
    open_exercise(page, service, "planar-rr")
    for i, text in enumerate(["a1", "0", "0", "theta1", "a2", "0", "0", "theta2"]):
        cells(page).nth(i).fill(text)
    page.get_by_role("button", name="Move it in 3D").click()
    play = page.get_by_role("button", name="Play a row", exact=True)
    play.click()
    expect(page.locator(".robot-view")).to_contain_text(NOT_LOADED)
    page.unroute_all(behavior="wait")
    play.click()
    expect(page.get_by_role("group", name="Play a row")).to_be_visible()
    expect(page.locator(".robot-view")).not_to_contain_text(NOT_LOADED)
    opened.complaints.clear()


@pytest.mark.long
def test_hints_come_with_the_next_check(visit: Opening, service: str) -> None:
    opened = visit()
    page = opened.page
    page.route("**/static/hints-*", lambda route: route.abort())
    open_exercise(page, service, "planar-rr")
    for i, text in enumerate(["a2", "0", "0", "theta1", "a2", "0", "0", "theta2"]):
        cells(page).nth(i).fill(text)
    check(page)
    expect(page.locator(".trouble-line")).to_contain_text("Hints could not be loaded")
    page.unroute_all(behavior="wait")
    check(page)
    expect(page.get_by_role("button", name="Hint", exact=True).first).to_be_visible()
    expect(page.locator(".trouble-line")).to_be_hidden()
    opened.complaints.clear()


@pytest.mark.long
def test_a_drawing_is_requested_again(visit: Opening, service: str) -> None:
    opened = visit()
    page = opened.page
    lost: list[str] = []

    def lose(route: Route) -> None:
        lost.append(route.request.url)
        route.abort()

    page.route("**/figure.svg*", lose)
    open_exercise(page, service, "planar-rr")
    picture = page.get_by_role("img", name="Drawing of the robot")
    picture.evaluate("each => new Promise((done) => each.addEventListener('error', done))")
    page.unroute_all(behavior="wait")
    picture.evaluate(
        """each => each.naturalWidth
             || new Promise((done) => each.addEventListener("load", done))"""
    )
    assert lost
    opened.complaints.clear()


# --- The same exercise in two tabs: nothing that was typed gets lost

SAVED = "Saved in this browser"
TOLD = "You changed these answers in another tab."
ASKED = "These answers were changed in another tab."
# Lets a tab miss what other tabs save, as a sleeping tab does.
DEAF = """for (const name of ["storage", "focus", "pageshow"]) {
  addEventListener(name, (event) => event.stopImmediatePropagation(), true);
}"""


def write(page: Page, place: int, text: str) -> None:
    cells(page).nth(place).fill(text)


def test_a_tab_takes_over_what_another_tab_saves(visit: Opening, service: str) -> None:
    first = visit().page
    open_exercise(first, service, "scara")
    second = first.context.new_page()
    open_exercise(second, service, "scara")
    write(first, 0, "a1")
    expect(cells(second).nth(0)).to_have_value("a1")
    expect(second.locator(".notice")).to_contain_text(TOLD)
    # A later save of the second tab keeps both texts.
    write(second, 1, "pi")
    expect(cells(first).nth(1)).to_have_value("pi")
    expect(cells(first).nth(0)).to_have_value("a1")
    first.reload()
    expect(cells(first).nth(0)).to_have_value("a1")
    expect(cells(first).nth(1)).to_have_value("pi")
    # Either tab can go back, and undo works, too.
    write(first, 0, "0")
    expect(cells(second).nth(0)).to_have_value("0")
    second.get_by_role("button", name="Restore the earlier answers").click()
    expect(cells(second).nth(0)).to_have_value("a1")
    expect(cells(first).nth(0)).to_have_value("a1")
    cells(first).nth(0).press("Control+Z")
    expect(cells(first).nth(0)).to_have_value("0")


@pytest.mark.long
@pytest.mark.parametrize("chosen", ["Show those answers", "Keep these answers"])
def test_two_tabs_with_changes_ask_which_to_keep(visit: Opening, service: str, chosen: str) -> None:
    first = visit().page
    open_exercise(first, service, "scara")
    second = first.context.new_page()
    second.add_init_script(DEAF)
    open_exercise(second, service, "scara")
    write(first, 0, "a1")
    expect(first.locator(".saved")).to_have_text(SAVED)
    write(second, 0, "a2")
    expect(second.locator(".saved")).to_contain_text("Not saved yet")
    expect(second.locator(".notice")).to_contain_text(ASKED)
    # Nothing is overwritten until the student has chosen.
    expect(cells(first).nth(0)).to_have_value("a1")
    second.get_by_role("button", name=chosen).click()
    kept, other = ("a1", "a2") if chosen.startswith("Show") else ("a2", "a1")
    for page in (first, second):
        expect(cells(page).nth(0)).to_have_value(kept)
    # The other answers can be restored even after both tabs are closed.
    context = first.context
    third = context.new_page()
    first.close()
    second.close()
    open_exercise(third, service, "scara")
    expect(cells(third).nth(0)).to_have_value(kept)
    third.get_by_role("button", name="Show the other answers").click()
    expect(cells(third).nth(0)).to_have_value(other)


@pytest.mark.long
def test_a_tab_that_closes_undecided_loses_nothing(visit: Opening, service: str) -> None:
    first = visit().page
    open_exercise(first, service, "scara")
    second = first.context.new_page()
    second.add_init_script(DEAF)
    open_exercise(second, service, "scara")
    write(first, 0, "a1")
    expect(first.locator(".saved")).to_have_text(SAVED)
    write(second, 0, "a2")
    second.close(run_before_unload=True)
    first.reload()
    expect(cells(first).nth(0)).to_have_value("a1")
    first.get_by_role("button", name="Show the other answers").click()
    expect(cells(first).nth(0)).to_have_value("a2")


@pytest.mark.long
def test_embedded_elements_share_answers_and_show_other_parts(
    visit: Opening, service: str, other_origin: Origin
) -> None:
    script = f'<!doctype html><script type="module" src="{service}/embed.js"></script>'
    tag = '<dh-exercise exercise="planar-rr" parts="{}"></dh-exercise>'
    other_origin.pages["/both"] = script + tag.format("table") + tag.format("position")
    first = visit().page
    first.goto(f"{other_origin.address}/both")
    second = first.context.new_page()
    second.goto(f"{other_origin.address}/both")
    for page in (first, second):
        expect(page.locator(".part")).to_have_count(2)
    table, position = (first.locator("dh-exercise").nth(i).locator("input").first for i in (0, 1))
    table.fill("a1")
    position.fill("a1 c1")
    for i, text in enumerate(("a1", "a1 c1")):
        own = second.locator("dh-exercise").nth(i)
        expect(own.locator("input").first).to_have_value(text)
    first.reload()
    expect(table).to_have_value("a1")
    expect(position).to_have_value("a1 c1")
    expect(first.locator(".notice:visible")).to_have_count(0)


@pytest.mark.long
def test_each_tab_of_free_play_keeps_its_own_table(visit: Opening, service: str) -> None:
    first = visit().page
    second = first.context.new_page()
    for page, text in ((first, "0.11"), (second, "0.22")):
        page.goto(f"{service}/play")
        cell = page.locator("dh-play td input").first
        cell.fill(text)
    for page, text in ((first, "0.11"), (second, "0.22")):
        page.reload()
        expect(page.locator("dh-play td input").first).to_have_value(text)
