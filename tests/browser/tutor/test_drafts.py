"""Test how tutors write exercises."""

import re
from collections.abc import Callable
from pathlib import Path
from time import monotonic
from typing import Final

import pytest
from dh_grader.authoring import Level, examine
from dh_grader.catalogue import load_exercise
from playwright.sync_api import Page, Route, expect

from tests.api.serving import served
from tests.browser.fixtures import Visit
from tests.browser.steps import cells, open_exercise
from tests.browser.test_pages import violations
from tests.browser.test_tutor import NARROW, wide
from tests.importing.test_urdf import file_of

# --- The page uses files that a tutor chose before the page's scripts had arrived


def choose_before_scripts(
    page: Page, address: str, field: str, chosen: Path, *pressed: str
) -> None:
    """Choose a file and press buttons before the page's scripts arrive."""
    # A button has no effect before the scripts arrive.
    held: list[Route] = []
    is_chosen = False

    def hold(route: Route) -> None:
        if is_chosen:
            route.continue_()
        else:
            held.append(route)

    page.route("**/*.js*", hold)
    page.goto(address, wait_until="commit")
    page.get_by_label(field, exact=True).set_input_files(chosen)
    for text in pressed:
        page.get_by_text(text, exact=True).click()
    is_chosen = True
    assert held
    for route in held:
        route.continue_()


@pytest.mark.long
def test_a_robot_chosen_before_the_scripts_is_read(
    visit: Callable[..., Visit], service: str, tmp_path: Path
) -> None:
    chosen = tmp_path / "Our Arm.urdf"
    chosen.write_text('<robot name="arm"/>', "utf-8")
    page = visit().page
    address = f"{service}/tutor/editor"
    opened = "New exercise from a URDF file or a DH table …"
    choose_before_scripts(page, address, "File", chosen, opened, "Make the exercise")
    assert page.url == address
    expect(page.get_by_label("Exercise id")).to_have_value("our-arm")
    expect(page.get_by_label("or paste it")).to_have_value('<robot name="arm"/>')


@pytest.mark.long
def test_a_submission_chosen_before_the_scripts_is_graded(
    visit: Callable[..., Visit], service: str, tmp_path: Path
) -> None:
    chosen = tmp_path / "alice.json"
    chosen.write_text("{}", "utf-8")
    page = visit().page
    choose_before_scripts(page, f"{service}/tutor/class", "or files", chosen)
    expect(page.locator("#state")).to_contain_text("1 submission.")


# --- The editor shows the student's form before anything is saved


@pytest.mark.long
def test_the_unsaved_text_is_tried_in_the_real_form(
    visit: Callable[..., Visit], service: str, axe: str
) -> None:
    page = visit(bypass_csp=True).page
    page.add_init_script(axe)
    page.goto(f"{service}/tutor/editor?exercise=planar-rr")
    expect(page.get_by_label("Exercise id")).to_have_value("planar-rr-copy")
    expect(page.get_by_text("This is a copy of planar-rr")).to_be_visible()
    text = page.get_by_label("Exercise file, TOML")
    text.fill(text.input_value().replace('title = "', 'title = "Unsaved: ', 1))
    page.get_by_role("button", name="Open the form").click()
    form = page.locator("dh-exercise")
    expect(form.get_by_role("heading", name="Unsaved: ")).to_be_visible()
    for i, entry in enumerate(["a1", "0", "0", "theta1", "a2", "0", "0", "theta2"]):
        cells(page).nth(i).fill(entry)
    form.get_by_role("button", name="Move it in 3D").click()
    expect(form.locator(".robot-view")).to_have_attribute("aria-busy", "false")
    form.get_by_role("button", name="Check").click()
    expect(form.locator("td[data-verdict=correct]")).to_have_count(8)
    assert "\n".join(violations(page, "")) == ""
    text.fill(text.input_value().replace("Unsaved: ", "Changed: ", 1))
    page.get_by_role("button", name="Update the form").click()
    expect(form.get_by_role("heading", name="Changed: ")).to_be_visible()
    # The answers are still there.
    expect(cells(page).first).to_have_value("a1")


# --- A lecturer imports the URDF file of a UR5e in the editor


@pytest.mark.long
def test_a_urdf_becomes_a_checked_exercise_in_the_browser(
    visit: Callable[..., Visit], axe: str, tmp_path: Path, figure: Callable[[str], None]
) -> None:
    arm = file_of("ur5e")
    upload = tmp_path / "Our UR5e.urdf"
    camera = '<link name="camera"/></robot>'
    upload.write_text(arm.read_text("utf-8").replace("</robot>", camera), "utf-8")
    folder = tmp_path / "written"
    folder.mkdir()
    with served(tmp_path, DH_GRADER_EDITOR_DIR=str(folder)) as server:
        opened = visit(bypass_csp=True, viewport=NARROW, color_scheme="dark")
        page = opened.page
        page.add_init_script(axe)
        began = monotonic()
        page.goto(f"{server.address}/tutor")
        page.get_by_role("link", name="New exercise from a robot").click()
        page.get_by_label("File", exact=True).set_input_files(upload)
        expect(page.get_by_label("Exercise id")).to_have_value("our-ur5e")
        page.get_by_label("Title").fill("The UR5e")
        colour = "each => getComputedStyle(each).backgroundColor"
        box = page.get_by_label("or paste it").evaluate(colour)
        assert page.get_by_label("Title").evaluate(colour) == box
        make = page.get_by_role("button", name="Make the exercise")
        make.click()
        told = page.locator("#imported")
        expect(told).to_contain_text("Name the tool's link; the tree ends at: tool0, camera.")
        assert "\n".join(violations(page, "")) == ""
        # The browser complains of the refusal.
        opened.complaints.clear()
        page.get_by_label("Link of the tool").fill("tool0")
        page.get_by_label("Letters for lengths").check()
        make.click()
        expect(told).to_contain_text("Largest difference to the URDF at 100 poses: 0.0000 mm")
        expect(page.locator("#findings")).to_contain_text("1 right, 1 equivalent, 0 wrong")
        preview = page.locator("#preview")
        expect(preview).to_contain_text("The UR5e")
        expect(preview).to_contain_text("Joint 6 turns about the axis through")
        drawn = "img => img.decode().then(() => img.naturalWidth > 0)"
        assert preview.locator("figure img").evaluate(drawn)
        assert "\n".join(violations(page, "")) == ""
        assert wide(page) <= NARROW["width"]
        page.get_by_role("button", name="Save").click()
        expect(page.get_by_text("our-ur5e.toml is saved")).to_be_visible()
        figure(f"UR5e in the browser: {monotonic() - began:.1f} s from the start page to the file")
    exercise = load_exercise(folder / "our-ur5e.toml")
    assert exercise.structure == "RRRRRR"
    assert not [remark for remark in examine(exercise) if remark.level is Level.FAILED]


@pytest.mark.long
def test_the_page_asks_for_what_a_table_leaves_open(
    visit: Callable[..., Visit], axe: str, tmp_path: Path
) -> None:
    with served(tmp_path) as server:
        page = visit(bypass_csp=True, viewport=NARROW).page
        page.add_init_script(axe)
        page.goto(f"{server.address}/tutor/editor")
        page.get_by_text("New exercise from a URDF file or a DH table …").click()
        page.locator("#kind").select_option("table")
        page.get_by_label("or paste it").fill("131.2 90 0 q1\n100 0 0 q2\n")
        make = page.get_by_role("button", name="Make the exercise")
        make.click()
        page.get_by_label("The columns have no headers. What is their order?").select_option(
            "a alpha d theta"
        )
        make.click()
        # An open question keeps the form from being sent.
        unit = page.get_by_label("The table has no unit of length.")
        expect(unit).to_have_value("")
        make.click()
        assert unit.evaluate("field => !field.validity.valid")
        unit.select_option("mm")
        page.get_by_label("The table has no unit of angles.").select_option("degrees")
        assert "\n".join(violations(page, "")) == ""
        assert wide(page) <= NARROW["width"]
        make.click()
        expect(page.locator("#imported")).to_contain_text("The numbers of column a are in mm.")
        expect(page.locator("#text")).to_have_value(re.compile(r'"0\.1312",\s+"90deg"'))
        # The server must not end before the check of the new text.
        expect(page.locator("#findings")).to_contain_text("1 right, 1 equivalent, 0 wrong")


# --- An exercise is printed on paper without bars and buttons

# The width of the text on A4 with the margins of the style sheet.
PAPER = {"width": 688, "height": 975}


def shown(page: Page, selector: str) -> int:
    return len([each for each in page.locator(selector).all() if each.is_visible()])


@pytest.mark.long
def test_an_exercise_is_printed_with_its_report(visit: Callable[..., Visit], service: str) -> None:
    page = visit(color_scheme="dark").page
    open_exercise(page, service, "planar-rr")
    # An empty form has no points to print.
    page.emulate_media(media="print")
    expect(page.locator(".bar")).to_be_hidden()
    page.emulate_media(media="screen")
    for i, text in enumerate(["a1", "0", "0", "theta1", "a2", "0", "sin(", "theta2"]):
        cells(page).nth(i).fill(text)
    page.get_by_role("button", name="Check").click()
    expect(page.locator("td[data-verdict=unreadable]")).to_have_count(1)
    page.get_by_role("button", name="Move it in 3D").click()
    expect(page.locator(".robot-view")).to_have_attribute("aria-busy", "false")

    page.set_viewport_size({"width": PAPER["width"], "height": PAPER["height"]})
    page.emulate_media(media="print")
    assert shown(page, "button:not(.fold), meter, .rail, .tools, .robot-view, nav, footer") == 0
    expect(page.locator(".total")).to_be_visible()
    expect(page.locator(".total")).to_contain_text("/ 17 points")
    # The drawing replaces the 3D view.
    expect(page.get_by_role("img", name="Drawing of the robot")).to_be_visible()
    expect(cells(page).nth(6)).to_be_visible()
    expect(page.locator(".notes li").first).to_be_visible()
    assert page.evaluate("document.documentElement.scrollWidth") <= PAPER["width"]
    colours = "getComputedStyle(document.body).backgroundColor"
    assert page.evaluate(colours) == "rgb(255, 255, 255)"
    cell = "each => getComputedStyle(each).color"
    channels = cells(page).first.evaluate(cell).removeprefix("rgb(").removesuffix(")").split(",")
    assert max(map(int, channels)) < 80


# --- The page /docs is accessible, and has the same colours as all pages of the service

REFERENCE_NARROW: Final = {"width": 390, "height": 844}
BACKGROUND: Final = "getComputedStyle(document.body).backgroundColor"


@pytest.mark.long
def test_the_reference_is_accessible_light_and_dark(
    visit: Callable[..., Visit], service: str, axe: str
) -> None:
    page = visit(bypass_csp=True, viewport=REFERENCE_NARROW).page
    page.add_init_script(axe)
    page.goto(f"{service}/tutor")
    expected = page.evaluate(BACKGROUND)
    page.get_by_role("link", name="API documentation").click()
    many = page.locator("#operations-grading-gradeMany")
    many.locator(".opblock-summary-control").click()
    many.locator(".execute").click()
    expect(many.locator(".live-responses-table .response")).to_contain_text("200")
    assert page.evaluate(BACKGROUND) == expected
    # Swagger UI colours the lines of examples only after it has drawn them.
    expect(many.locator("pre.microlight span").first).to_be_visible()
    assert "\n".join(violations(page, "")) == ""
    assert page.evaluate("document.documentElement.scrollWidth") <= REFERENCE_NARROW["width"]


@pytest.mark.long
def test_the_reference_follows_the_choice_of_colours(
    visit: Callable[..., Visit], service: str
) -> None:
    page = visit(color_scheme="light").page
    page.goto(f"{service}/docs")
    method = page.locator(".opblock-summary-method").first
    colour = "each => getComputedStyle(each).backgroundColor"
    light = method.evaluate(colour)
    page.get_by_label("Colours").select_option("dark")
    expect(page.locator("html.dark-mode")).to_be_attached()
    assert method.evaluate(colour) != light
