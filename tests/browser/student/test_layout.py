"""No piece of an exercise's page is printed over another."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.fixtures import Visit
from tests.browser.steps import open_exercise
from tests.shipped import one_of_each_kind

Opening = Callable[..., Visit]

SIZES = ((390, 844), (1280, 800), (1440, 900), (1920, 1080))
# The task, the parts, the bar, the source and the link below must not share a pixel at the end of
# the page, where the student finishes; each pair that does, by its names.
OVERLAPS = """async () => {
  scrollTo(0, document.documentElement.scrollHeight);
  const root = document.querySelector("dh-exercise").shadowRoot;
  await root.querySelector("figure img[src]")?.decode();
  const pieces = [...root.querySelectorAll(".about > *, .part, .bar, .source"),
    ...document.querySelectorAll("nav.next, footer.bottom")];
  const boxes = pieces.map((each) => [each.className || each.tagName, each.getBoundingClientRect()])
    .filter(([, box]) => box.width && box.height);
  return boxes.flatMap(([name, one], i) => boxes.slice(i + 1)
    .filter(([, two]) => one.left < two.right - 1 && two.left < one.right - 1
      && one.top < two.bottom - 1 && two.top < one.bottom - 1)
    .map(([other]) => `${name} over ${other}`));
}"""


def overlaps(page: Page, service: str, name: str) -> list[str]:
    open_exercise(page, service, name)
    found = []
    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        found += [f"{name}, {width} px: {each}" for each in page.evaluate(OVERLAPS)]
    return found


def test_nothing_is_printed_over_the_source(visit: Opening, service: str) -> None:
    # At 1280 pixels, the task of the first is higher than the window; at 1440, that of the second.
    page = visit().page
    assert [
        each for name in ("stanford-arm", "planar-rr") for each in overlaps(page, service, name)
    ] == []


@pytest.mark.long
@pytest.mark.parametrize("name", one_of_each_kind())
def test_nothing_is_printed_over_anything(visit: Opening, service: str, name: str) -> None:
    assert overlaps(visit().page, service, name) == []


@pytest.mark.long
def test_nothing_is_printed_over_the_source_beside_the_3d_view(
    visit: Opening, service: str
) -> None:
    page = visit(viewport={"width": 1440, "height": 900}).page
    open_exercise(page, service, "scara")
    page.get_by_role("button", name="Move it in 3D").click()
    expect(page.locator(".robot-view")).to_have_attribute("aria-busy", "false")
    assert page.evaluate(OVERLAPS.replace(".about > *", ".about")) == []
