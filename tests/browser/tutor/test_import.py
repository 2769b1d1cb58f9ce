"""A lecturer imports the URDF file of a UR5e in the editor."""

import re
from collections.abc import Callable
from pathlib import Path
from time import monotonic

import pytest
from dh_grader.authoring import Level, examine
from dh_grader.catalogue import load_exercise
from playwright.sync_api import expect

from tests.api.serving import served
from tests.browser.fixtures import Visit
from tests.browser.test_pages import violations
from tests.browser.test_tutor import NARROW, wide
from tests.importing.test_urdf import file_of


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
