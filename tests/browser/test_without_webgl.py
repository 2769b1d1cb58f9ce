"""Without WebGL, the service draws the student's table."""

import os
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from tests.browser.chromium import Chromium
from tests.browser.hostile import PICTURE
from tests.browser.steps import cells, open_exercise

pytestmark = pytest.mark.campaign
TABLE = ["a1", "0", "0", "theta1", "a2", "0", "0", "theta2"]


@pytest.fixture
def page(browser: Browser, chromium: Chromium) -> Iterator[Page]:
    options = ["--no-sandbox", "--disable-gpu", "--disable-3d-apis"]
    other = browser.browser_type.launch(
        executable_path=chromium.program, args=options, env={**os.environ, **chromium.environment}
    )
    page = other.new_page(reduced_motion="reduce", viewport={"width": 320, "height": 700})
    complaints: list[str] = []
    page.on("console", lambda line: complaints.append(line.text))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    yield page
    assert complaints == []
    other.close()


def drawing(page: Page) -> Locator:
    image = page.get_by_role("img", name="Drawing of the robot at these joint values")
    expect(image).to_be_visible()
    expect(page.locator(".robot-view")).to_have_attribute("aria-busy", "false")
    assert image.evaluate("each => each.decode().then(() => each.naturalWidth > 100)")
    return image


def test_the_service_draws_the_student_s_table(page: Page, service: str) -> None:
    open_exercise(page, service, "planar-rr")
    page.get_by_role("button", name="Move it in 3D").click()
    alone = drawing(page).screenshot()
    for i, text in enumerate(TABLE):
        cells(page).nth(i).fill(text)
    expect(page.get_by_text("Origin of your frame {2}")).to_be_visible()
    home = drawing(page).screenshot()
    assert home != alone
    page.get_by_role("slider", name="theta1: joint 1 turns").press("End")
    expect(page.locator(".slider output").first).not_to_have_text("0°")
    moved = drawing(page).screenshot()
    assert moved != home
    cells(page).nth(0).fill(PICTURE)
    expect(page.locator(".told")).to_contain_text("Row 1, a")
    assert drawing(page).screenshot() != moved
    assert page.evaluate("document.documentElement.scrollWidth") <= 320


def test_free_play_is_drawn_too(page: Page, service: str) -> None:
    page.goto(f"{service}/play")
    page.get_by_label("Start from a robot").select_option("SCARA, RRPR")
    expect(page.locator(".slider")).to_have_count(4)
    home, source = drawing(page).screenshot(), drawing(page).get_attribute("src")
    page.emulate_media(color_scheme="dark")
    expect(drawing(page)).not_to_have_attribute("src", str(source))
    dark = drawing(page).screenshot()
    assert dark != home
    page.get_by_role("slider", name="theta2: joint 2 turns").press("End")
    expect(page.locator(".slider output").nth(1)).not_to_have_text("0°")
    assert drawing(page).screenshot() != dark
