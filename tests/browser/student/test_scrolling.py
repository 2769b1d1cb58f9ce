"""An area that scrolls sideways shows an arrow at each edge with hidden content."""

from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise
from tests.browser.student.steps import PHONE, part
from tests.browser.test_pages import violations

Opening = Callable[..., Visit]


@pytest.mark.long
def test_a_wide_matrix_has_an_arrow_at_the_hidden_edge(
    visit: Opening, service: str, axe: str
) -> None:
    page = visit(bypass_csp=True, **PHONE).page
    page.add_init_script(axe)
    open_exercise(page, service, "planar-rr")
    pose = part(page, 2)
    before, after = pose.locator(".more.before"), pose.locator(".more.after")
    expect(after).to_be_hidden()
    for i in range(4):
        cells(page, 2).nth(i).fill("cos(theta1) cos(theta2) - sin(theta1) sin(theta2)")
    scroller = pose.locator(".scroll")
    scroller.evaluate("each => each.scrollTo(0, 0)")
    expect(after).to_be_visible()
    expect(before).to_be_hidden()
    assert violations(page, "") == []
    box, sign = scroller.bounding_box(), after.bounding_box()
    assert box is not None
    assert sign is not None
    assert abs(box["x"] + box["width"] - sign["x"] - sign["width"]) < 8
    scroller.evaluate("each => each.scrollTo(each.scrollWidth, 0)")
    expect(before).to_be_visible()
    expect(after).to_be_hidden()


@pytest.mark.long
def test_the_cells_of_frames_fit_beside_the_3d_view(visit: Opening, service: str) -> None:
    page = visit(viewport={"width": 1280, "height": 800}).page
    open_exercise(page, service, "planar-rrr-frames")
    page.get_by_role("button", name="Move it in 3D").click()
    expect(page.locator(".robot-view")).to_have_attribute("aria-busy", "false")
    for i, text in enumerate(["1", "+z", "0", "0", "0", "+z"]):
        cells(page).nth(i).fill(text)
    page.get_by_role("button", name="Check").click()
    expect(part(page, 0).locator("td.worth").first).to_contain_text("/")
    expect(part(page, 0).locator(".more.after")).to_be_hidden()
