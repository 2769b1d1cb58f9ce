"""Test the layout of an exercise, on large and small screens."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Final

import pytest
from dh_grader.catalogue import Exercise, PartSpec
from playwright.sync_api import Locator, Page, expect

from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise, right_answers
from tests.browser.student.steps import PHONE, check, part
from tests.browser.test_pages import violations
from tests.shipped import one_of_each_kind, shipped_exercises

# --- No piece of an exercise's page is printed over another

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


# --- An area that scrolls sideways shows an arrow at each edge with hidden content


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


# --- A student fills in the form of an exercise on a phone

# A finger needs this many pixels.
FINGER = 44
NAMES = {
    "d2": "d₂",
    "d3": "d₃",
    "d6": "d₆",
    **{f"theta{i}": f"θ{chr(0x2080 + i)}" for i in range(7)},
}


@pytest.mark.long
def test_the_stanford_arm_is_tapped_from_an_empty_page_to_full_marks(
    visit: Opening, service: str, catalogue: Mapping[str, Exercise], axe: str
) -> None:
    page = visit(bypass_csp=True, **PHONE).page
    page.add_init_script(axe)
    open_exercise(page, service, "stanford-arm")
    answers = right_answers(catalogue["stanford-arm"])
    table, links, pose = (answers[spec.id] for spec in catalogue["stanford-arm"].parts)
    for i, text in enumerate(table):
        cells(page).nth(i).tap()
        write(page, cells(page).nth(i), text)
    expect(page.get_by_role("toolbar")).to_be_visible()
    assert violations(page, "") == []
    for place, texts in ((1, links), (2, pose)):
        box = part(page, place).locator(".paste-box")
        box.locator("summary").tap()
        box.locator("textarea").fill("\n\n".join(matrices(texts)))
        box.get_by_role("button", name="Fill in the cells").tap()
        expect(cells(page, place).first).to_have_value(texts[0])
    check(page, tap=True)
    expect(page.locator(".total")).to_have_text("32 / 32 points")
    page.get_by_role("tab", name="A3").tap()
    expect(page.get_by_role("tab", name="A3 correct", selected=True)).to_be_visible()
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["viewport"]["width"]
    buttons = page.locator("dh-exercise").get_by_role("button").all()
    small = [
        (each.inner_text(), size["height"])
        for each in [*buttons, *page.get_by_role("tab").all(), *cells(page).all()]
        if each.is_visible() and (size := each.bounding_box()) and size["height"] < FINGER
    ]
    assert small == []


def write(page: Page, cell: Locator, text: str) -> None:
    if text in NAMES:
        page.get_by_role("toolbar", name="Symbols").get_by_text(NAMES[text], exact=True).tap()
        expect(cell).to_be_focused()
    else:
        page.keyboard.insert_text(text)
    expect(cell).to_have_value(text)


def matrices(texts: list[str]) -> list[str]:
    rows = [", ".join(texts[i : i + 4]) for i in range(0, len(texts), 4)]
    return [f"A{i // 4 + 1} = [{'; '.join(rows[i : i + 4])}]" for i in range(0, len(rows), 4)]


@pytest.mark.long
@pytest.mark.parametrize("exercise", ["planar-rr", "dh-conditions"])
def test_unreadable_cells_do_not_make_the_page_wider(
    visit: Opening, service: str, exercise: str
) -> None:
    page = visit(**PHONE).page
    open_exercise(page, service, exercise)
    for cell in page.locator(".part input").all()[:24]:
        if cell.is_visible():
            cell.fill("no value (")
    check(page, tap=True)
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["viewport"]["width"]


@pytest.mark.long
def test_a_key_writes_at_the_caret_and_can_be_undone(visit: Opening, service: str) -> None:
    page = visit(**PHONE).page
    open_exercise(page, service, "planar-rr")
    cell = cells(page).nth(3)
    cell.fill("2*")
    cell.tap()
    cell.evaluate("input => input.setSelectionRange(0, 0)")
    keys = page.get_by_role("toolbar", name="Symbols")
    keys.get_by_text("π", exact=True).tap()
    expect(cell).to_have_value("π2*")
    keys.get_by_role("button", name="Undo").tap()
    expect(cell).not_to_have_value("π2*")
    for key in ["θ", "d", "π", "°", "α"]:
        expect(keys.get_by_text(key, exact=True)).to_have_count(1)


PLACED = [
    *["1", "+z", "0", "0", "0", "+x"],
    *["2", "-z", "l1", "0", "0", "+x"],
    *["3", "+z", "l1+l2", "0", "0", "+z"],
]
# How many pixels an element shows too little of what is in it.
CUT = "each => each.scrollWidth - each.clientWidth"


@pytest.mark.long
@pytest.mark.parametrize(
    ("exercise", "texts"),
    [("planar-rrr-frames", PLACED), ("planar-rr", ["a1", "0", "thta1", "thta1"])],
)
def test_nothing_is_cut_on_a_phone(
    visit: Opening, service: str, exercise: str, texts: list[str]
) -> None:
    page = visit(**PHONE).page
    open_exercise(page, service, exercise)
    for i, text in enumerate(texts):
        cells(page).nth(i).fill(text)
    check(page, tap=True)
    expect(page.locator(".repair")).to_have_count(4 if "thta1" in texts else 0)
    # The columns, the names of the parts below, and the texts that are proposed.
    for name in (".part .scroll", ".rail ol", ".repair"):
        shown = page.locator(name).filter(visible=True)
        assert [each.evaluate(CUT) for each in shown.all()] == [0] * shown.count(), name


@pytest.mark.long
def test_the_tools_fit_on_one_line_beside_the_3d_view(visit: Opening, service: str) -> None:
    page = visit(viewport={"width": 1280, "height": 800}).page
    open_exercise(page, service, "scara")
    cells(page).first.fill("a1")
    page.get_by_role("button", name="Move it in 3D").click()
    expect(page.locator(".saved")).to_have_text("Saved in this browser")
    expect(page.locator(".robot-view")).to_have_attribute("aria-busy", "false")
    helps = page.locator("dh-exercise .help-link").bounding_box()
    unit = page.locator("dh-exercise .tools select").bounding_box()
    assert helps is not None
    assert unit is not None
    assert abs(helps["y"] - unit["y"]) < unit["height"]


# --- After Check, the first message is in view together with its cell, for every kind of answer

# A phone, a laptop, and two desktops.
MESSAGES_IN_VIEW_SIZES: Final = ((390, 844), (1280, 720), (1440, 900), (1920, 1080))
# The columns of a matrix, a table or a list, as the form shows them.
WIDTHS: Final = {
    "transform": 4, "link_transforms": 4, "rotation": 3, "dh_table": 4, "find_slip": 4, "dh_row": 4,
    "frames": 7, "screw_axes": 6,
}  # fmt: skip
# A factor that makes the cell as wide as cells get, and the entry wrong.
WIDE: Final = "({}) (3 + sin({})^2 + cos({})^3)/7 + 0.37"
TABLE: Final = ("a", "alpha", "d", "theta")
OTHER_NAMES: Final = {"+x": "+y", "-x": "+y", "+y": "+z", "-y": "+z", "+z": "+x", "-z": "+x"}

# Answers one part, checks it, and returns why the first message or its cell is out of view; an
# empty list means that both are in view. A sign at the edge of a scrolling area covers what is
# below it, although it lets clicks through.
CHECKED: Final = """async ([part, cells, choice, unit]) => {
  const element = document.querySelector("dh-exercise");
  const root = element.shadowRoot;
  root.activeElement?.blur();
  scrollTo(0, 0);
  element.texts = { unit, parts: { [part]: { cells, choice } } };
  await new Promise((done, fail) => {
    element.addEventListener("graded", done, { once: true });
    setTimeout(() => fail(new Error("no report")), 50_000);
    element.check();
  });
  // Formulas are typeset and hints are offered later, and move the cell or the message.
  const frame = () => new Promise(requestAnimationFrame);
  const hints = () => root.querySelector('link[href*="hints"]')?.sheet;
  while (element.previewer.busy || !hints()) await frame();
  const at = root.querySelector(`[id="part-${part}-body"]`).closest(".part");
  const wrong = ["incorrect", "partial", "unreadable"].map((each) => `td[data-verdict=${each}]`);
  const marks = wrong.map((each) => each.replace("td", ".slip-marks") + " [aria-pressed=true]");
  const cell = at.querySelector(marks.join()) ?? at.querySelector(wrong.join());
  if (!cell) return ["no cell is marked"];
  const input = cell.querySelector("input") ?? cell;
  const tied = (input.getAttribute("aria-describedby") ?? "").split(" ");
  const told = tied.map((id) => root.getElementById(id)).find((each) => each?.matches("li"))
    ?? cell.closest("tr").nextElementSibling?.querySelector(".notes li")
    ?? at.querySelector(".messages li");
  if (!told) return ["there is no message"];
  for (const each of root.querySelectorAll(".more")) each.style.pointerEvents = "auto";
  const seen = (name, target, { left, top, right, bottom }) => [[left + 2, top + 3],
    [right - 3, bottom - 4]].flatMap(([x, y]) => {
      const where = `${name} at ${Math.round(x)}, ${Math.round(y)}`;
      if (x < 0 || y < 0 || x > innerWidth || y > innerHeight) return [`outside: ${where}`];
      const hit = root.elementFromPoint(x, y);
      if (target.contains(hit)) return [];
      return [`${hit?.contains(target) ? "clipped" : `covered by ${hit?.className}`}: ${where}`];
    });
  const text = told.querySelector("p");
  const range = document.createRange();
  range.selectNodeContents(text);
  let found;
  // The page follows changes of sizes within a few frames, which a busy machine draws late.
  for (let i = 0; i < 300; i += 1) {
    await frame();
    found = [
      ...seen("message", text, range.getClientRects()[0]),
      ...seen("badge", told, told.querySelector(".badge").getBoundingClientRect()),
      ...seen("cell", cell.querySelector(".entry") ?? cell, input.getBoundingClientRect()),
    ];
    if (!found.length) return [];
  }
  return found.map((each) => `${each}: ${told.textContent.slice(0, 60)}`);
}"""


def test_the_first_message_of_a_wide_matrix_is_in_view(visit: Opening, service: str) -> None:
    # The kind with the widest cells; all kinds and widths are in the next test.
    assert (
        list(
            out_of_view(
                visit().page, service, "stanford-arm", ["pose"], MESSAGES_IN_VIEW_SIZES[1:2]
            )
        )
        == []
    )


@pytest.mark.long
@pytest.mark.parametrize("name", one_of_each_kind())
def test_the_first_message_is_in_view_with_its_cell(
    visit: Opening, service: str, name: str
) -> None:
    assert list(out_of_view(visit().page, service, name)) == []


def out_of_view(
    page: Page,
    service: str,
    name: str,
    parts: Sequence[str] = (),
    sizes: Sequence[tuple[int, int]] = MESSAGES_IN_VIEW_SIZES,
) -> Iterator[str]:
    """Yield each wrong answer to an exercise whose first message or its cell is out of view."""
    exercise = shipped_exercises()[name]
    answers = right_answers(exercise)
    open_exercise(page, service, name)
    for width, height in sizes:
        page.set_viewport_size({"width": width, "height": height})
        for one in exercise.parts:
            if parts and one.id not in parts:
                continue
            right = answers.get(one.id, [])
            for place, texts, choice in spoiled(exercise, one, right):
                for each in page.evaluate(CHECKED, [one.id, texts, choice, "radians"]):
                    yield f"{name}/{one.id} ({one.kind}), entry {place}, {width} px: {each}"


def spoiled(
    exercise: Exercise, part: PartSpec, right: Sequence[str]
) -> Iterator[tuple[int, list[str], str]]:
    """Yield the right answer with a wrong entry in the last column, and with one in the first."""
    width = WIDTHS.get(part.kind, len(right))
    if not right:
        return
    rows = [row for row in range(len(right) // width) if row + 1 not in getattr(part, "given", ())]
    if part.kind in ("transform", "link_transforms"):
        # The form has filled in the last row.
        rows.pop()
    joint = next((each.name for each in exercise.variables if each.joint), "0.4")
    if getattr(part, "tool", "given") == "free":
        # The last row may then end in any frame, so that no entry in it is wrong.
        rows.pop()
    first, last = rows[0] * width, rows[-1] * width
    for place in dict.fromkeys([first + width - 1, last, last + width - 1]):
        entry = right[place]
        wrong = OTHER_NAMES.get(entry, WIDE.format(entry, joint, joint))
        if part.kind == "frames" and place % width == 0:
            wrong = "2" if entry == "1" else "1"
        marked = f"{place // width + 1}.{TABLE[place % width]}" if part.kind == "find_slip" else ""
        yield place, [*right[:place], wrong, *right[place + 1 :]], marked
