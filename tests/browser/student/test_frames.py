"""Test the form in which a student places frames."""

from collections import Counter
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

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


@pytest.mark.long
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


@pytest.mark.long
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
    # A frame that is still being placed is not complained of.
    expect(page.locator(".told")).to_be_hidden()
    boxes[8].fill("sin(")
    expect(page.locator(".told")).to_contain_text("Frame 2, origin x:")
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


# Waits until the view is at rest, and returns the place of the mark that writes a value, in pixels
# of the page. Joint axes are clicked beside their middles.
PLACE = """async (svg, value) => {
  const view = svg.getRootNode().querySelector(".robot-view");
  const place = () => {
    const mark = svg.querySelector(`[data-value="${value}"]`);
    if (!mark || view.getAttribute("aria-busy") !== "false") return null;
    const { x, y } = svg.getBoundingClientRect();
    const end = mark.querySelector("circle");
    const at = (name) => Number((end ?? mark).getAttribute(name));
    const between = (from, to) => at(from) + 0.75 * (at(to) - at(from));
    return end ? [x + at("cx"), y + at("cy")] : [x + between("x1", "x2"), y + between("y1", "y2")];
  };
  let before = null;
  for (const from = performance.now(); performance.now() < from + 60_000;) {
    const now = place();
    if (now && String(now) === String(before)) return now;
    before = now;
    for (const _ of "12") await new Promise(requestAnimationFrame);
  }
  const shown = [...svg.querySelectorAll("[data-value]")].map((mark) => mark.dataset.value);
  throw new Error(`${value} is not one of ${shown.join("; ")}`);
}"""


def place_of(page: Page, value: str) -> tuple[float, float]:
    x, y = page.locator(".place-marks").evaluate(PLACE, value)
    return x, y


def click_mark(page: Page, value: str, *, tap: bool = False) -> None:
    page.locator(".stage").scroll_into_view_if_needed()
    click = page.touchscreen.tap if tap else page.mouse.click
    click(*place_of(page, value))


def place_by_clicks(page: Page, row: int, frame: tuple[str, ...], *, tap: bool = False) -> None:
    joint, z, *origin, x = frame
    boxes = [cells(page).nth(6 * row + i) for i in range(6)]
    told = page.locator("dh-exercise p.aloud[role=status]")
    click_mark(page, joint, tap=tap)
    expect(boxes[0]).to_have_value(joint)
    if boxes[1].input_value() != z:
        click_mark(page, z, tap=tap)
    expect(boxes[1]).to_have_value(z)
    click_mark(page, ", ".join(origin), tap=tap)
    expect(told).to_have_text(f"Frame {row + 1}: origin at ({', '.join(origin)})")
    click_mark(page, x, tap=tap)
    expect(told).to_have_text(f"Frame {row + 1}: x along {x}")
    assert [box.input_value() for box in boxes] == list(frame)


def open_view(page: Page, service: str, exercise: str, *, tap: bool = False) -> None:
    open_exercise(page, service, exercise)
    button = page.get_by_role("button", name="Move it in 3D")
    (button.tap if tap else button.click)()
    expect(page.locator(".frame-hint")).to_have_text(
        "Frame 1: click a joint axis, so that z lies along it."
    )


@pytest.mark.long
def test_a_click_on_a_joint_axis_puts_z_there_and_a_second_turns_it_over(
    visit: Opening, service: str
) -> None:
    page = visit().page
    open_view(page, service, "planar-rrr-frames")
    second = place_of(page, "2")
    # A frame that was typed to its end is not changed by the next click on an axis.
    for i, text in enumerate(RIGHT[:6]):
        cells(page).nth(i).fill(text)
    axis = page.get_by_label("joint axis along which z lies, frame 2")
    z = page.get_by_label("direction of z, frame 2")
    page.mouse.click(*second)
    expect(z).to_have_value("+z")
    click_mark(page, "2")
    expect(z).to_have_value("-z")
    expect(axis).to_have_value("2")
    expect(cells(page).first).to_have_value("1")
    told = page.locator("dh-exercise p.aloud[role=status]")
    expect(told).to_have_text("Frame 2: z along the axis of joint 2, -z")
    # A drag turns the view and chooses nothing.
    across, down = second
    page.mouse.move(across, down)
    page.mouse.down()
    page.mouse.move(across + 40, down, steps=3)
    page.mouse.up()
    expect(z).to_have_value("-z")


PLACES = {
    "planar-rrr-frames": [
        ("1", "+z", "0", "0", "0", "+x"),
        ("2", "-z", "l1", "0", "0", "-x"),
        # The origin may be anywhere on the last of parallel axes; the tip is not on it.
        ("3", "+z", "l1 + l2", "0", "0", "+x"),
    ],
    "spatial-rrr-frames": [
        ("2", "+y", "R", "0", "0", "+x"),
        ("3", "-y", "R + L1", "0", "0", "-x"),
    ],
}


@pytest.mark.long
@pytest.mark.parametrize("exercise", PLACES)
def test_frames_are_placed_by_clicks_alone_right_or_wrong(
    visit: Opening, service: str, exercise: str
) -> None:
    page = visit().page
    open_view(page, service, exercise)
    for row, frame in enumerate(PLACES[exercise]):
        place_by_clicks(page, row, frame)
    expect(page.locator(".frame-hint")).to_contain_text("All frames are placed.")
    check(page)
    badge = part(page, 0).locator(".badge").first
    expect(badge).to_have_text("correct")
    # Across the link, and along the axis itself.
    x = page.get_by_label("direction of x, frame 2")
    x.focus()
    click_mark(page, "+y")
    expect(x).to_have_value("+y")
    check(page)
    expect(x).to_have_attribute("aria-invalid", "true")
    expect(badge).not_to_have_text("correct")


@pytest.mark.long
def test_frames_are_placed_by_touch_and_an_origin_is_chosen_again(
    visit: Opening, service: str
) -> None:
    page = visit(**PHONE).page
    open_view(page, service, "planar-rrr-frames", tap=True)
    place_by_clicks(page, 0, ("1", "+z", "0", "0", "0", "+x"), tap=True)
    click_mark(page, "2", tap=True)
    click_mark(page, "l1 + l2 + l3, 0, 0", tap=True)
    hint = page.locator(".frame-hint")
    expect(hint).to_contain_text("Frame 2: click the end of an arrow")
    origin = cells(page).nth(8)
    # A click on the chosen dot changes no cell.
    click_mark(page, "l1 + l2 + l3, 0, 0", tap=True)
    expect(hint).to_contain_text("Frame 2: click a dot")
    expect(origin).to_have_value("l1 + l2 + l3")
    click_mark(page, "l1, 0, 0", tap=True)
    expect(origin).to_have_value("l1")
    assert page.evaluate("document.documentElement.scrollWidth") == 390


@pytest.mark.long
def test_dots_move_with_the_link_of_their_frame(visit: Opening, service: str) -> None:
    page = visit().page
    open_view(page, service, "stanford-arm-frames")
    stage = page.locator(".stage")

    def height() -> float:
        # The page may scroll.
        box = stage.bounding_box()
        assert box is not None
        return box["y"] - place_of(page, "0, d2, 0")[1]

    # The boom is drawn out, and carries frame 3.
    heights = []
    for row, axis in ((1, "3"), (2, "4")):
        cells(page).nth(6 * row).fill(axis)
        cells(page).nth(6 * row + 2).focus()
        expect(page.locator(".frame-hint")).to_contain_text(f"Frame {row + 1}: click a dot")
        heights.append(height())
    low, high = heights
    assert high - low > 60
    # Draw the boom in as far as its slider goes.
    page.locator(".slider input").nth(2).press("Home")
    assert low + 20 < height() < high - 20
