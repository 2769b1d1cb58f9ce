"""The 3D view animates the moves of a table row."""

import gzip
import re
from collections.abc import Callable

import pytest
from dh_grader.web.pages import FOLDER
from playwright.sync_api import Page, expect

from tests.browser.figures.pace import MOST_SCRIPT_MS, pace
from tests.browser.fixtures import Visit
from tests.browser.maths.reading import typed_names
from tests.browser.steps import cells, open_exercise
from tests.browser.test_pages import violations
from tests.browser.test_robot_view import open_view, picture

Opening = Callable[..., Visit]

TABLE = ["0.5", "0", "0", "theta1", "a2", "0", "0", "theta2"]
MOST = 60_000


def text(page: Page, name: str) -> str:
    return page.locator(f".row-player {name}").inner_text()


@pytest.mark.long
def test_a_row_is_played_by_keyboard(visit: Opening, service: str, axe: str) -> None:
    opened = visit(bypass_csp=True, viewport={"width": 1280, "height": 900})
    page = opened.page
    page.add_init_script(axe)
    open_exercise(page, service, "planar-rr")
    for i, written in enumerate(TABLE):
        cells(page).nth(i).fill(written)
    open_view(page)
    still = picture(page)
    assert [url for url in opened.requests if "row_player" in url or "row_shape" in url] == []

    # The cell in hand lights its length.
    cells(page).nth(0).focus()
    expect(page.locator("output.measure")).to_have_text("a₁ = 0.5 m")
    assert picture(page) != still
    page.get_by_role("button", name="Play a row").focus()
    expect(page.locator("output.measure")).to_be_hidden()
    page.keyboard.press("Enter")
    caption = page.locator(".row-player .caption")
    expect(caption).to_have_text("Row 1 begins on frame {0}.")
    live = page.locator("[role=status][aria-live]")
    # On the page the names are typeset, so that x₁ reads x1; screen readers get the text.
    for move, shown in [
        ("1 of 4: turn about z₀ by θ₁ = 0°, so nothing moves.", "turn about z0 by θ1 = 0°"),
        ("2 of 4", "2 of 4"),
        ("3 of 4: along x₁", "3 of 4: along x1"),
    ]:
        page.get_by_role("button", name="Next move").press("Enter")
        expect(caption).to_contain_text(shown)
        expect(live.filter(has_text=move)).to_have_count(1)
    expect(live.filter(has_text="The ghost frame is at (0.5, 0, 0).")).to_have_count(1)
    assert typed_names(page) == []
    # The cell of the move is marked.
    marked = page.locator("td.moving input")
    expect(marked).to_have_value("0.5")
    at_third = picture(page)
    bar = page.get_by_role("slider", name="Moves of the row")
    bar.press("Home")
    expect(caption).to_have_text("Row 1 begins on frame {0}.")
    assert picture(page) != at_third
    bar.press("End")
    # Link 1 of the robot has another length, so z₁ is beside the axis of joint 2.
    expect(bar).to_have_attribute(
        "aria-valuetext", "4 of 4: turn about x₁ by α₁ = 0°, so nothing moves."
    )
    expect(page.locator(".row-player .misses")).to_contain_text(
        re.compile(r"z1 misses the axis of joint 2: 0\.\d+ m (short|too far) along x0\.")
    )
    cells(page).nth(0).fill("a1")
    # The end of the length that is changed is shown, at once.
    expect(caption).to_contain_text("3 of 4: along x1 by a1")
    bar.press("End")
    expect(page.locator(".row-player .quiet")).to_contain_text("z1 lies on the axis of joint 2.")

    # People who want no motion see the end of each move.
    page.get_by_label("Row", exact=True).select_option("2")
    page.get_by_role("button", name="Play", exact=True).press("Enter")
    expect(caption).to_contain_text("1 of 4: turn about z1")
    assert bar.input_value() == "1"
    page.get_by_role("button", name="Pause", exact=True).press("Enter")
    page.get_by_role("button", name="Previous move").press("Enter")
    expect(caption).to_have_text("Row 2 begins on frame {1}.")
    page.set_viewport_size({"width": 320, "height": 700})
    assert violations(page, "") == []
    assert page.evaluate("document.documentElement.scrollWidth") <= 320
    page.get_by_role("button", name="Play a row").press("Enter")
    expect(caption).to_be_hidden()
    expect(page.locator("td.moving")).to_have_count(0)


@pytest.mark.long
def test_a_row_of_seven_joints_moves_smoothly(
    visit: Opening, service: str, figure: Callable[[str], None]
) -> None:
    small = {"width": 640, "height": 480}
    page = visit(viewport=small, reduced_motion="no-preference").page
    page.goto(f"{service}/play")
    page.get_by_label("Start from a robot").select_option("Redundant arm, 7R")
    expect(page.locator(".slider")).to_have_count(7)
    page.get_by_role("button", name="Play a row").click()
    page.get_by_label("Row", exact=True).select_option("3")
    picture(page)
    # A mouse would change the style of the button.
    page.get_by_role("button", name="Play", exact=True).evaluate("(button) => button.click()")
    measured = pace(page.get_by_role("slider", name="Moves of the row"))
    figure(f"a row: {measured}")
    # Each picture used to write texts and ask for a size, which took two passes over the page.
    assert measured.style_passes <= measured.pictures + 20
    assert measured.script_ms < MOST_SCRIPT_MS


def test_the_scripts_of_the_3d_view_are_small() -> None:
    # The limit is for the compressed scripts, because the service compresses them.
    files = (FOLDER / "robot").rglob("*.js")
    assert sum(len(gzip.compress(file.read_bytes())) for file in files) < MOST
