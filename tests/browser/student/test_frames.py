"""The form in which a student places frames: names are offered, every step works by keyboard."""

from collections import Counter
from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.fixtures import Visit
from tests.browser.maths.reading import typed_names
from tests.browser.steps import cells, open_exercise
from tests.browser.student.steps import PHONE, check, part
from tests.browser.test_pages import violations

# The table of the frames RIGHT.
TABLE = [
    "0", "0", "0", "q1", "l1", "180deg", "0", "-q2",
    "l2", "180deg", "0", "q3 + pi", "-l3", "0", "0", "pi",
]  # fmt: skip
Opening = Callable[..., Visit]
RIGHT = [
    "1", "+z", "0", "0", "0", "+x", "2", "-z", "l1", "0", "0", "+x",
    "3", "+z", "l1 + l2", "0", "0", "-x",
]  # fmt: skip


@pytest.mark.long
def test_frames_are_placed_by_keyboard_and_a_broken_rule_is_shown(
    visit: Opening, service: str, axe: str
) -> None:
    page = visit(bypass_csp=True).page
    page.add_init_script(axe)
    open_exercise(page, service, "planar-rrr-frames")
    first = page.get_by_label("joint axis along which z lies, frame 1")
    assert first.evaluate("input => [...input.list.options].map((each) => each.value)") == [*"123"]
    for i, text in enumerate([*RIGHT[:-1], "+z"]):
        cells(page).nth(i).press_sequentially(text)
        expect(cells(page).nth(i)).to_have_value(text)
        page.keyboard.press("Tab")
    check(page)
    x = page.get_by_label("direction of x, frame 3")
    expect(x).to_have_attribute("aria-invalid", "true")
    expect(part(page, 0)).to_contain_text("x must be perpendicular to z of its own frame.")
    assert typed_names(page) == []
    assert violations(page, "") == []
    x.fill("-x")
    check(page)
    expect(part(page, 0).locator(".badge").first).to_have_text("correct")


def test_a_table_of_frames_is_pasted(visit: Opening, service: str) -> None:
    page = visit().page
    open_exercise(page, service, "planar-rrr-frames")
    box = part(page, 0).locator(".paste-box")
    box.locator("summary").click()
    rows = [RIGHT[i : i + 6] for i in (0, 6, 12)]
    lines = [" | ".join([str(i + 1), *row]) for i, row in enumerate(rows)]
    box.locator("textarea").fill("\n".join(["frame | axis | z | ox | oy | oz | x", *lines]))
    box.get_by_role("button").click()
    expect(cells(page).nth(17)).to_have_value(RIGHT[17])
    assert [each.input_value() for each in cells(page).all()[:18]] == RIGHT


def test_a_phone_shows_all_cells_of_a_frame_without_sideways_scrolling(
    visit: Opening, service: str
) -> None:
    page = visit(**PHONE).page
    open_exercise(page, service, "planar-rrr-frames")
    for box, text in zip(cells(page).all(), [*RIGHT, "0"], strict=False):
        box.fill(text)
    form = part(page, 0)
    expect(form.locator(".reading")).to_contain_text("the number of a joint")
    expect(form.locator(".cell-head").first).to_be_visible()
    [inner, outer] = form.locator(".scroll").evaluate("it => [it.scrollWidth, it.clientWidth]")
    assert inner == outer
    # Screen readers still get a table: the tree of Chromium itself has its heads and cells.
    tree = page.context.new_cdp_session(page).send("Accessibility.getFullAXTree")["nodes"]
    roles = Counter(each["role"]["value"] for each in tree if "role" in each)
    assert roles["columnheader"] >= 6
    assert roles["gridcell"] + roles["cell"] >= 18


@pytest.mark.long
def test_placed_frames_are_in_the_view_and_lead_to_full_marks_on_a_phone(
    visit: Opening, service: str, axe: str
) -> None:
    page = visit(bypass_csp=True, **PHONE).page
    page.add_init_script(axe)
    loaded: list[str] = []
    page.on("request", lambda request: loaded.append(request.url))
    open_exercise(page, service, "planar-rrr-frames")
    assert not [url for url in loaded if "/robot/" in url]
    page.get_by_role("button", name="Move it in 3D").tap()
    told = page.locator("#where-frames-are")
    expect(told).to_contain_text("Given frame {0}")
    boxes = [*cells(page).all(), *cells(page, 1).all()]
    texts = [*RIGHT, *TABLE]
    for box, text in zip(boxes[:8], texts[:8], strict=True):
        box.tap()
        box.fill(text)
    expect(told).to_contain_text(
        "Your frame {1}: origin (0, 0, 0), x along the base's x, z along the base's z."
    )
    expect(page.locator(".told")).to_contain_text("Frame 2, origin x: Nothing is written here")
    expect(page.locator(".told")).to_contain_text("The view leaves this frame out.")
    for box, text in zip(boxes[8:], texts[8:], strict=True):
        box.fill(text)
    # The middle of the range of l1 is 0.6.
    expect(told).to_contain_text(
        "Your frame {2}: origin (0.6, 0, 0), x along the base's x, z opposite to the base's z."
    )
    expect(told).to_contain_text("Your frame {3}: origin (1.2, 0, 0), x opposite to the base's x")
    expect(page.locator(".told")).to_be_hidden()
    expect(page.get_by_role("checkbox", name="Your frames")).to_be_checked()
    assert typed_names(page) == []
    assert violations(page, "") == []
    check(page, tap=True)
    expect(page.locator(".total")).to_contain_text("16 / 16 points")
    assert page.evaluate("document.documentElement.scrollWidth") == 390


@pytest.mark.long
def test_a_click_on_a_joint_axis_puts_z_there_and_a_second_turns_it_over(
    visit: Opening, service: str
) -> None:
    page = visit().page
    open_exercise(page, service, "planar-rrr-frames")
    page.get_by_role("button", name="Move it in 3D").click()
    expect(page.locator(".axis-hint")).to_contain_text("Click a joint axis")
    expect(page.locator("#where-frames-are")).to_contain_text("Given frame {0}")
    axis = page.get_by_label("joint axis along which z lies, frame 2")
    z = page.get_by_label("direction of z, frame 2")
    axis.focus()
    box = page.locator(".stage canvas").bounding_box()
    assert box is not None
    found: list[str] = []
    # From left to right, all the three axes are crossed.
    for across in range(10, int(box["width"]), 15):
        page.mouse.click(box["x"] + across, box["y"] + box["height"] / 2)
        # The first click on an axis waits for the directions of the axes.
        page.wait_for_timeout(100)
        found.append(axis.input_value())
        if found[-1] == "2":
            break
    assert found[-1] == "2"
    assert set(found) <= {"", "1", "2"}
    expect(z).to_have_value("+z")
    page.mouse.click(box["x"] + across, box["y"] + box["height"] / 2)
    expect(z).to_have_value("-z")
    expect(axis).to_have_value("2")
    told = page.locator("dh-exercise p.aloud[role=status]")
    expect(told).to_have_text("Frame 2: z along the axis of joint 2, -z")
    # A drag turns the view and chooses nothing.
    page.mouse.move(box["x"] + across, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + across + 40, box["y"] + box["height"] / 2, steps=3)
    page.mouse.up()
    expect(z).to_have_value("-z")
