"""A learner submits on the service's page and on a course's own site."""

import re
from collections.abc import Callable
from contextlib import suppress

import pytest
from dh_grader.catalogue import load_exercise, shipped_folder
from playwright.sync_api import Error, Page, Route, expect

from tests.browser.fixtures import Visit
from tests.browser.learner.conftest import Course
from tests.browser.steps import cells
from tests.browser.test_pages import violations

Opening = Callable[..., Visit]

# The table of the SCARA without the half turn, and the right one: 8 of the 24 points.
WRONG = [
    "a1",
    "0",
    "0",
    "theta1",
    "a2",
    "0",
    "0",
    "theta2",
    "0",
    "0",
    "d3",
    "0",
    "0",
    "0",
    "d4",
    "theta4",
]
RIGHT = [
    "a1",
    "0",
    "0",
    "theta1",
    "a2",
    "pi",
    "0",
    "theta2",
    "0",
    "0",
    "d3",
    "0",
    "0",
    "0",
    "d4",
    "theta4",
]


# Milliseconds in which a page shows what it has loaded.
SHOWN = 1000


def fill(page: Page, texts: list[str]) -> None:
    for i, text in enumerate(texts):
        cells(page).nth(i).fill(text)
    expect(page.locator(".saved")).to_have_text("Saved in this browser")


def lose_the_answer(route: Route) -> None:
    """Let the service record a request, but send no response to the page."""
    # If the page reloads meanwhile, the page cancels the request itself.
    with suppress(Error):
        route.fetch()
        route.abort()


def hand_in(page: Page) -> None:
    page.locator(".bar").get_by_role("button", name="Hand in").click()


@pytest.mark.long
def test_a_learner_hands_in(course: Course, visit: Opening, axe: str) -> None:
    opened = visit(bypass_csp=True, viewport={"width": 1280, "height": 900})
    page = opened.page
    page.add_init_script(axe)
    page.goto(course.link)
    expect(page.get_by_role("heading", name="My assignments")).to_be_visible()
    # The key is in no address, neither in the bar nor in that of a request.
    assert page.url == f"{course.address}/learn"
    assert [url for url in opened.requests if "dhg_" in url and "#dhg_" not in url] == []
    states = page.locator(".assignment header .badge")
    expect(states).to_have_text(["open", "late", "closed", "not open yet", "open", "open", "open"])
    expect(page.locator(".assignment").first).to_contain_text(re.compile(r"Due .* GMT\+9 \("))
    assert violations(page, "") == []

    page.locator(".assignment").first.get_by_role("link").click()
    expect(page.get_by_text("2 of 2 attempts left")).to_be_visible()
    expect(page.get_by_role("button", name="Check")).to_be_hidden()
    fill(page, WRONG)
    # Previews still tell how a text is read.
    expect(page.locator(".shown math").first).to_be_visible()
    page.reload()
    expect(cells(page).nth(3)).to_have_value("theta1")

    # Without a connection the hand-in waits, also over a reload, and is recorded once. It is
    # recorded while its answer is lost, so that no page may say that it was not handed in.
    lost = "**/assignments/homework/attempts"
    page.route(lost, lose_the_answer)
    hand_in(page)
    expect(page.get_by_text("Not confirmed yet, trying again.")).to_be_visible()
    expect(page.get_by_text("Not handed in")).to_have_count(0)
    page.reload()
    expect(page.get_by_text("Not confirmed yet, trying again.")).to_be_visible()
    # A second tab takes it over, and the first one gets the same answer.
    other = page.context.new_page()
    other.goto(course.link)
    other.locator(".assignment").first.get_by_role("link").click()
    expect(other.get_by_text("Handed in. Attempt 1:")).to_be_visible()
    page.unroute_all(behavior="ignoreErrors")
    page.evaluate("dispatchEvent(new Event('online'))")
    expect(page.get_by_text("Handed in. Attempt 1:")).to_be_visible()
    for each in (page, other):
        expect(each.get_by_text("1 of 2 attempts left")).to_be_visible()
        expect(each.get_by_text("Not handed in")).to_have_count(0)
    expect(page.locator("td[data-verdict=incorrect]").first).to_be_visible()
    opened.complaints.clear()
    assert violations(page, "") == []

    # Two tabs of the same learner: nothing is overwritten silently.
    expect(cells(other).nth(5)).to_have_value("0")
    cells(other).nth(5).fill("pi")
    notice = page.locator(".notice")
    expect(notice).to_contain_text("You changed these answers in another tab.")
    expect(cells(page).nth(5)).to_have_value("pi")

    hand_in(page)
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("Hand in your last attempt?")
    dialog.get_by_role("button", name="Not yet").click()
    expect(page.get_by_text("1 of 2 attempts left")).to_be_visible()
    hand_in(page)
    dialog.get_by_role("button", name="Hand in").click()
    expect(page.get_by_text("Handed in. Attempt 2: 3.33 of 10 points.")).to_be_visible()
    # The other tab knows it, too.
    for each in (page, other):
        expect(each.get_by_text("No attempts left")).to_be_visible()
        expect(each.locator(".bar").get_by_role("button", name="Hand in")).to_be_hidden()
    other.close()

    rows = page.locator(".handed-in li")
    expect(rows).to_have_count(2)
    expect(rows.first).to_contain_text("3.33 of 10 points")
    # While the exercise cannot be read, the page does not say that it is gone.
    page.route("**/v1/exercises/**", lambda route: route.abort())
    rows.last.get_by_role("link").click()
    expect(page.get_by_role("alert")).to_contain_text("The service cannot be reached.")
    page.unroute_all(behavior="ignoreErrors")
    opened.complaints.clear()
    page.get_by_role("button", name="Try again").click()
    expect(page.locator(".recorded td[data-verdict=incorrect]").first).to_be_visible()
    assert violations(page, "") == []
    page.get_by_role("link", name="All assignments").click()
    expect(page.locator(".assignment").first).to_contain_text("3.33 of 10 points count")

    # Late, and closed.
    page.locator(".assignment").nth(1).get_by_role("link").click()
    expect(page.get_by_text("earn 50 % of their points")).to_be_visible()
    expect(page.get_by_role("button", name="Check")).to_be_visible()
    page.get_by_role("link", name="All assignments").click()
    page.locator(".assignment").nth(2).get_by_role("link").click()
    expect(page.get_by_text("Closed since")).to_be_visible()
    expect(page.locator(".bar").get_by_role("button", name="Hand in")).to_be_hidden()

    # What is still loading when the learner signs out does not appear afterwards.
    waiting: list[Route] = []
    page.route("**/v1/me", lambda route: waiting.append(route))
    with page.expect_request("**/v1/me"):
        page.get_by_role("link", name="All assignments").click()
    page.get_by_role("button", name="Sign out").click()
    with page.expect_response("**/v1/me"):
        waiting[0].continue_()
    page.wait_for_timeout(SHOWN)
    expect(page.get_by_role("heading", name="You are signed out")).to_be_visible()
    page.unroute_all(behavior="ignoreErrors")
    page.goto(f"{course.address}/learn#dhg_{'x' * 43}")
    expect(page.get_by_role("heading", name="This link is not valid any more")).to_be_visible()
    assert violations(page, "") == []
    opened.complaints.clear()


@pytest.mark.long
def test_a_learner_sees_the_own_variant(course: Course, visit: Opening) -> None:
    opened = visit()
    page = opened.page
    page.goto(course.link)
    page.locator(".assignment").last.get_by_role("link").click()
    expect(page.get_by_text("two links moves in the plane")).to_be_visible()
    drawing = page.locator("figure img")
    expect(drawing).to_have_attribute("src", re.compile("^blob:"))
    page.wait_for_function("each => each.naturalWidth > 100", arg=drawing.element_handle())
    # The numbers are not those of the exercise without a seed, whose id the page shows.
    plain = load_exercise(shipped_folder() / "planar-rr-numbers.toml")
    [own] = {re.sub(r"\s+", " ", text) for text in page.locator(".statement").all_inner_texts()}
    assert "length 0." in own
    assert not set(re.findall(r"length (0\.\d+)", own)) >= set(
        re.findall(r"length\s+(0\.\d+)", plain.statement)
    )
    assert not [url for url in opened.requests if "~" in url]


@pytest.mark.long
def test_the_element_hands_in_from_a_course_site(course: Course, visit: Opening) -> None:
    page = visit().page
    page.add_init_script(
        """window.heard = [];
        for (const name of ["changed", "submitted", "graded"])
          addEventListener(name, ({ detail }) => heard.push([name, detail]));"""
    )
    page.goto(course.site)
    element = page.locator("dh-exercise")
    expect(page.get_by_text("3 of 3 attempts left")).to_be_visible()
    expect(page.get_by_role("button", name="Check")).to_be_hidden()
    assert element.evaluate("each => each.answers") == {}

    rows = [RIGHT[i : i + 4] for i in range(0, 16, 4)]
    element.evaluate("(each, rows) => { each.answers = { table: { rows } }; }", rows)
    expect(cells(page).nth(5)).to_have_value("pi")
    expect(page.locator(".saved")).to_have_text("Saved in this browser")
    refused = (
        "each => { try { each.answers = { table: 7 }; } catch (error) { return error.name; } }"
    )
    assert element.evaluate(refused) == "TypeError"
    assert cells(page).nth(5).input_value() == "pi"
    element.evaluate("each => { each.submit(); }")
    expect(page.locator("#told")).to_contain_text("Handed in at 20")
    expect(page.get_by_text("Handed in. Attempt 1: 3.33 of 10 points.")).to_be_visible()
    expect(page.get_by_text("2 of 3 attempts left · 3.33 of 10 points count")).to_be_visible()
    expect(page.locator("td[data-verdict=correct]")).to_have_count(16)

    heard = dict(page.evaluate("heard"))
    assert set(heard) == {"changed", "submitted", "graded"}
    report = heard["graded"]
    assert (report["points"], report["max_points"]) == (8, 24)
    expected = [dict(zip(("a", "alpha", "d", "theta"), row, strict=True)) for row in rows]
    assert report["answers"]["table"]["rows"] == expected
    assert report["attempt"]["id"] == heard["submitted"]["id"]

    element.evaluate("each => { each.reset(); }")
    expect(cells(page).nth(5)).to_have_value("")
    assert element.evaluate("each => each.answers") == {}
