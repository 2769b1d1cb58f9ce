"""On a phone, a finger drags the sliders and turns the robot."""

from collections.abc import Callable

import pytest
from playwright.sync_api import CDPSession, expect

from tests.browser.fixtures import Visit
from tests.browser.test_robot_view import picture

Opening = Callable[..., Visit]


def swipe(session: CDPSession, start: tuple[float, float], end: tuple[float, float]) -> None:
    points = [
        {"x": start[0] + (end[0] - start[0]) * i / 8, "y": start[1] + (end[1] - start[1]) * i / 8}
        for i in range(9)
    ]
    for kind, touched in [
        ("touchStart", points[:1]), *(("touchMove", [each]) for each in points[1:]),
        ("touchEnd", []),
    ]:  # fmt: skip
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touched})


@pytest.mark.campaign
def test_a_finger_moves_joints_and_view(visit: Opening, service: str) -> None:
    phone = {"width": 320, "height": 700}
    page = visit(viewport=phone, has_touch=True, is_mobile=True).page
    page.goto(f"{service}/play")
    page.get_by_label("Start from a robot").select_option("SCARA, RRPR")
    expect(page.locator(".slider")).to_have_count(4)
    home = picture(page)
    session = page.context.new_cdp_session(page)
    slider = page.get_by_role("slider", name="theta1: joint 1 turns")
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    assert box is not None
    # Wide enough for a finger.
    assert box["height"] >= 24
    middle = box["y"] + box["height"] / 2
    swipe(session, (box["x"] + box["width"] / 2, middle), (box["x"] + box["width"] * 0.8, middle))
    expect(page.locator(".slider output").first).not_to_have_text("0°")
    moved = picture(page)
    assert moved != home
    stage = page.locator(".stage canvas")
    stage.scroll_into_view_if_needed()
    box = stage.bounding_box()
    assert box is not None
    x, y = box["x"] + 40, box["y"] + box["height"] / 2
    swipe(session, (x, y), (x + 150, y + 20))
    assert picture(page) != moved
    assert page.evaluate("document.documentElement.scrollWidth") <= phone["width"]
