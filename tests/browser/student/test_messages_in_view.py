"""After Check, the first message is in view together with its cell, for every kind of answer."""

from collections.abc import Callable, Iterator, Sequence
from typing import Final

import pytest
from dh_grader.catalogue import Exercise, PartSpec
from playwright.sync_api import Page

from tests.browser.fixtures import Visit
from tests.browser.steps import open_exercise, right_answers
from tests.shipped import one_of_each_kind, shipped_exercises

Opening = Callable[..., Visit]

# A phone, a laptop, and two desktops.
SIZES: Final = ((390, 844), (1280, 720), (1440, 900), (1920, 1080))
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
    assert list(out_of_view(visit().page, service, "stanford-arm", ["pose"], SIZES[1:2])) == []


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
    sizes: Sequence[tuple[int, int]] = SIZES,
) -> Iterator[str]:
    """Yield each wrong answer to an exercise whose first message or its cell is out of view."""
    exercise = shipped_exercises()[name]
    answers = right_answers(exercise)
    open_exercise(page, service, name)
    for width, height in sizes:
        page.set_viewport_size({"width": width, "height": height})
        for part in exercise.parts:
            if parts and part.id not in parts:
                continue
            right = answers.get(part.id, [])
            for place, cells, choice in spoiled(exercise, part, right):
                for each in page.evaluate(CHECKED, [part.id, cells, choice, "radians"]):
                    yield f"{name}/{part.id} ({part.kind}), entry {place}, {width} px: {each}"


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
