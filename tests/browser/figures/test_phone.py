"""On a phone, the figures of exercises are shown large enough."""

from collections.abc import Callable

import pytest

from tests.browser.fixtures import Visit
from tests.browser.steps import open_exercise
from tests.figures.test_figure import PHONE


# A wide figure and a high one.
@pytest.mark.long
@pytest.mark.parametrize(("name", "side"), [("planar-rr", "width"), ("stanford-arm-d1", "height")])
def test_a_phone_shows_figures_large_enough(
    visit: Callable[..., Visit], service: str, name: str, side: str
) -> None:
    page = visit(viewport={"width": 390, "height": 844}).page
    open_exercise(page, service, name)
    drawing = page.get_by_role("img", name="Drawing of the robot")
    drawing.evaluate("image => image.decode()")
    box = drawing.bounding_box()
    assert box is not None
    assert box["width"] >= PHONE[0]
    # A wide figure is as high as its width allows.
    assert side == "width" or box["height"] >= PHONE[1]
    assert page.evaluate("document.documentElement.scrollWidth") == 390
