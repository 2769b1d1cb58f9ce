"""Test the tutor's pages: solutions, editor, and the report on a class."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from tests.browser.fixtures import Visit
from tests.browser.hostile import PICTURE, SCRIPT
from tests.browser.test_pages import violations

Opening = Callable[..., Visit]

RIGHT = "a\talpha\td\ttheta\na1\t0\t0\ttheta1\na2\t0\t0\ttheta2\n"
NARROW = {"width": 320, "height": 700}


def wide(page: Page) -> int:
    return int(page.evaluate("document.documentElement.scrollWidth"))


@pytest.mark.long
def test_a_tutor_looks_at_a_solution_and_writes_an_exercise(
    visit: Opening, service: str, axe: str, tmp_path: Path
) -> None:
    page = visit(bypass_csp=True, viewport=NARROW).page
    page.add_init_script(axe)
    page.add_init_script("window.taken = []; window.stolen = (what) => taken.push(what);")
    page.goto(service)
    page.get_by_role("link", name="For tutors").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("For tutors")
    assert "\n".join(violations(page, "")) == ""
    page.get_by_role("link", name="Solution of SCARA manipulator", exact=True).click()
    expect(page.locator("math mtable").first).to_be_visible()
    drawn = "img => img.decode().then(() => img.naturalWidth > 0)"
    assert page.get_by_role("img", name="The robot with the frames").evaluate(drawn)
    assert "\n".join(violations(page, "")) == ""
    assert wide(page) <= NARROW["width"]

    page.get_by_role("link", name="Edit its file").click()
    text = page.get_by_label("Exercise file, TOML")
    findings = page.locator("#findings")
    expect(findings).to_contain_text("No problems found.")
    assert page.locator("#preview figure img").evaluate(drawn)
    assert "\n".join(violations(page, "")) == ""
    assert wide(page) <= NARROW["width"]
    written = text.input_value()
    broken = written.replace("points = ", "pionts = ", 1)
    text.fill(broken)
    expect(findings).to_contain_text("did you mean 'points'?")
    assert "\n".join(violations(page, "")) == ""
    findings.get_by_role("button", name="line").press("Enter")
    selected = "area => area.value.slice(area.selectionStart, area.selectionEnd)"
    assert str(text.evaluate(selected)).startswith("pionts = ")

    hostile = re.sub('^title = ".*"', f"title = '''{PICTURE}'''", written)
    text.fill(hostile.replace('statement = """', f'statement = """\n{SCRIPT} {PICTURE}\n\n'))
    expect(page.locator("#preview h3")).to_have_text(PICTURE)
    expect(page.locator("#preview .statement")).to_contain_text(SCRIPT)
    assert page.locator("main").locator("script, [onerror], img[src=x]").count() == 0
    assert page.evaluate("taken") == []
    # Without an editor folder, the file can only be downloaded.
    expect(page.get_by_role("button", name="Save")).to_have_count(0)
    text.fill(written + "\n# ü\n")
    with page.expect_download() as downloading:
        page.get_by_role("button", name="Download").click()
    assert downloading.value.suggested_filename == "scara-copy.toml"
    downloading.value.save_as(tmp_path / "scara.toml")
    assert (tmp_path / "scara.toml").read_text(encoding="utf-8") == written + "\n# ü\n"


@pytest.mark.long
def test_a_class_is_graded_in_the_browser(
    visit: Opening, service: str, axe: str, tmp_path: Path
) -> None:
    folder = tmp_path / "class"
    (folder / "bob").mkdir(parents=True)
    (folder / "alice.json").write_text(json.dumps({"answers": {"table": RIGHT}}), encoding="utf-8")
    (folder / "bob" / "table.csv").write_text(RIGHT.replace("a2\t0", "a2\tpi/2"), encoding="utf-8")
    (folder / "carol.json").write_text(json.dumps({"answers": {"table": PICTURE}}), "utf-8")
    (folder / "dave.json").write_bytes(b" " * 300_000)
    (folder / "eve.txt").write_bytes(b"\xff\xfe\x00")

    # Under the page's own policy, which allows the styles of the reports only in the frame.
    page = visit(viewport=NARROW).page
    page.goto(f"{service}/tutor/class")
    page.get_by_label("Exercise").select_option("planar-rr")
    expect(page.get_by_label("Part").locator("option")).not_to_have_count(1)
    page.get_by_label("Part").select_option("table")
    page.get_by_label("Folder").set_input_files(folder)
    expect(page.get_by_role("status")).to_have_text(
        "5 submissions. The service does not keep them."
    )
    report = page.frame_locator("#report")
    expect(report.get_by_role("heading", level=1)).to_contain_text("Planar RR arm")
    expect(report.locator("#ungraded")).to_contain_text("is larger than 256 KiB")
    assert report.locator(".card").first.evaluate("card => getComputedStyle(card).borderRadius")
    assert wide(page) <= NARROW["width"]
    report.get_by_role("link", name="bob", exact=True).first.click()
    expect(report.locator(".incorrect").first).to_be_visible()
    page.get_by_role("button", name="Back to the class").click()
    expect(report.get_by_role("heading", name="Submissions", exact=True)).to_be_visible()
    with page.expect_download() as downloading:
        page.get_by_role("button", name="Everything (zip)").click()
    assert downloading.value.suggested_filename == "planar-rr-class.zip"

    checked = visit(bypass_csp=True, viewport=NARROW).page
    checked.add_init_script(axe)
    checked.goto(f"{service}/tutor/class")
    checked.get_by_label("or files").set_input_files(folder / "alice.json")
    expect(checked.get_by_role("status")).to_contain_text("1 submission.")
    assert "\n".join(violations(checked, "")) == ""
