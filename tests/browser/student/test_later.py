"""Scripts and drawings that arrive later: a failed request is tried again."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, Route, expect

from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise
from tests.browser.student.steps import check

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
