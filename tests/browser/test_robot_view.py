"""Test the 3D view: sliders, and the student's table over the robot."""

import base64
import os
from collections.abc import Callable
from math import cos, sin

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browser.chromium import Chromium
from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise
from tests.browser.test_pages import violations

Opening = Callable[..., Visit]

TABLE = ["l2", "0", "l1", "q1", "l3", "pi", "0", "q2", "0", "0", "l4", "q3", "0", "0", "q4", "0"]


def open_view(page: Page) -> None:
    page.get_by_role("button", name="Move it in 3D").press("Enter")
    expect(page.locator(".slider")).not_to_have_count(0)
    # The button keeps the focus for keyboard users.
    expect(page.get_by_role("button", name="Back to the drawing")).to_be_in_viewport()


def picture(page: Page) -> bytes:
    expect(page.locator(".robot-view")).to_have_attribute("aria-busy", "false")
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 50)))")
    return page.locator(".stage canvas").screenshot()


# JavaScript: the number of colours along the edge of a picture.
EDGE = """async (data) => {
    const image = await createImageBitmap(await (await fetch(data)).blob())
    const {width, height} = image
    const canvas = new OffscreenCanvas(width, height)
    const context = canvas.getContext('2d', {willReadFrequently: true})
    context.drawImage(image, 0, 0)
    // The frame around the stage has round corners.
    const parts = [[20, 2, width - 40, 1], [2, 20, 1, height - 40], [width - 3, 20, 1, height - 40]]
    const buffers = parts.map(part => context.getImageData(...part).data.buffer)
    return new Set(buffers.flatMap(buffer => [...new Uint32Array(buffer)])).size
}"""


def is_cut(page: Page) -> bool:
    data = base64.b64encode(picture(page)).decode()
    return int(page.evaluate(EDGE, f"data:image/png;base64,{data}")) > 1


def tool(page: Page) -> str:
    return page.locator(".pose-numbers code").first.inner_text()


@pytest.mark.long
def test_a_joint_moves_the_robot_and_the_student_s_table(
    visit: Opening, service: str, axe: str
) -> None:
    opened = visit(bypass_csp=True, viewport={"width": 1280, "height": 900})
    page = opened.page
    page.add_init_script(axe)
    open_exercise(page, service, "rrrp")
    assert [url for url in opened.requests if "three" in url or "robot_view" in url] == []
    open_view(page)
    assert [url for url in opened.requests if "three-0" in url]
    expect(page.get_by_role("group", name="Frames shown").get_by_role("checkbox")).to_have_count(0)
    alone = picture(page)

    # The table appears while it is typed, up to the first row that cannot be drawn.
    for i, text in enumerate(TABLE[:6]):
        cells(page).nth(i).fill(text)
    expect(page.locator(".told")).to_contain_text("The view shows the frames before it.")
    for i, text in enumerate(TABLE):
        cells(page).nth(i).fill(text)
    expect(page.get_by_role("checkbox", name="Show frame 4")).to_be_checked()
    expect(page.locator(".told")).to_be_hidden()
    # The table is right: its last frame lies on the given tool frame.
    gap = page.locator(".pose-numbers code").nth(2)
    expect(gap).to_have_text("none")
    words = page.locator(f"#{page.locator('.stage canvas').get_attribute('aria-describedby')}")
    expect(words).to_contain_text("Given frame {4}: origin (1.2, 0, 0.05)")
    expect(words).to_contain_text("The last frame of your table lies on the tool frame.")
    expect(page.get_by_role("list", name="Legend")).to_contain_text("given frames")
    home, at_home = picture(page), tool(page)
    assert home != alone

    # Both robots follow the slider. The coordinates are those of the service.
    slider = page.get_by_role("slider", name="q1: joint 1 turns")
    slider.press("End")
    expect(page.locator(".slider output").first).not_to_have_text("0°")
    assert picture(page) != home
    robot, table, _ = page.locator(".pose-numbers code").all_inner_texts()
    x, y, z = map(float, at_home.split())
    angle = float(slider.input_value())
    turned = [x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle), z]
    assert list(map(float, robot.split())) == pytest.approx(turned, abs=0.002)
    assert table.split()[:2] == robot.split()[:2]
    # A slip in the table moves its frames away from the robot.
    cells(page).nth(4).fill("2 l3")
    astray = page.locator(".pose-numbers code").nth(1)
    expect(astray).not_to_have_text(table)
    # The forearm is 0.6 long, and twice as long in the table.
    expect(gap).to_have_text("0.6")
    expect(page.locator("output.gap")).to_have_text("0.6")
    expect(words).to_contain_text("misses the tool frame: 0.6 m short along x₀")
    moved = picture(page)
    assert tool(page) == robot
    page.get_by_role("checkbox", name="Show frame 1").uncheck()
    assert picture(page) != moved
    framed = picture(page)
    page.get_by_role("checkbox", name="Given frames").uncheck()
    assert picture(page) != framed
    page.get_by_role("checkbox", name="Side by side").check()
    expect(page.locator("output.gap")).to_be_hidden()
    page.get_by_role("button", name="View from higher").click()
    page.locator(".stage canvas").focus()
    page.keyboard.press("ArrowRight")

    page.get_by_role("button", name="Home configuration").click()
    expect(page.locator(".slider output").first).to_have_text("0°")
    expect(page.locator(".pose-numbers code").first).to_have_text(at_home)
    page.get_by_text("Lengths and other symbols").click()
    page.get_by_role("checkbox", name="Side by side").uncheck()
    assert not is_cut(page)
    page.get_by_role("spinbutton", name="l1").fill("3")
    expect(page.locator(".pose-numbers code").first).not_to_have_text(at_home)
    # The robot is three times as high, so the view moves away from it.
    assert not is_cut(page)
    page.set_viewport_size({"width": 320, "height": 700})
    assert violations(page, "") == []
    assert page.evaluate("document.documentElement.scrollWidth") <= 320
    page.get_by_role("button", name="Back to the drawing").click()
    expect(page.locator(".stage")).to_have_count(0)


# The tool frame is at the right of one robot, and above the other.
@pytest.mark.long
@pytest.mark.parametrize("robot", ["planar-rr", "stanford-arm"])
def test_a_phone_shows_the_given_frames_with_their_names(
    robot: str, visit: Opening, service: str
) -> None:
    page = visit(bypass_csp=True, viewport={"width": 390, "height": 844}).page
    open_exercise(page, service, robot)
    open_view(page)
    assert not is_cut(page)


@pytest.mark.long
def test_a_browser_without_webgl_shows_the_drawing(
    browser: Browser, chromium: Chromium, service: str
) -> None:
    options = ["--no-sandbox", "--disable-gpu", "--disable-3d-apis"]
    other = browser.browser_type.launch(
        executable_path=chromium.program, args=options, env={**os.environ, **chromium.environment}
    )
    page = other.new_page(reduced_motion="reduce")
    complaints: list[str] = []
    page.on("console", lambda line: complaints.append(line.text))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    loaded: list[str] = []
    page.on("request", lambda request: loaded.append(request.url))
    open_exercise(page, service, "rrrp")
    open_view(page)
    expect(page.locator(".stage")).to_contain_text("This browser has no WebGL")
    expect(page.locator(".stage").get_by_role("img", name="Drawing of the robot")).to_be_visible()
    before = tool(page)
    page.get_by_role("slider", name="q1: joint 1 turns").press("End")
    expect(page.locator(".pose-numbers code").first).not_to_have_text(before)
    assert [url for url in loaded if "three-0" in url] == []
    assert complaints == []
    other.close()
