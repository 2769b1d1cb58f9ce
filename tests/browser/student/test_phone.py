"""A student fills in the form of an exercise on a phone."""

from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from playwright.sync_api import Locator, Page, expect

from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise, right_answers
from tests.browser.student.steps import PHONE, check, part
from tests.browser.test_pages import violations

Opening = Callable[..., Visit]
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
