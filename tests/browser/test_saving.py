"""The tutor's editor saves files if the service has an editor folder."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import expect

from tests.api.serving import ROOT, announced_port
from tests.browser.fixtures import Visit
from tests.guards import ANSWER

Opening = Callable[..., Visit]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "written"
    made.mkdir()
    return made


@pytest.fixture
def writing(folder: Path) -> Iterator[str]:
    log = folder.parent / "log"
    command = [sys.executable, "-m", "dh_grader", "serve", "--port", "0"]
    variables = {"NO_COLOR": "1", "DH_GRADER_EDITOR_DIR": str(folder)}
    with (
        log.open("wb") as output,
        subprocess.Popen(
            command, cwd=ROOT, stdout=output, stderr=output, env=os.environ | variables
        ) as process,
    ):
        try:
            yield f"http://127.0.0.1:{announced_port(process, log)}"
        finally:
            process.terminate()
            process.wait(timeout=ANSWER)


# The service is the first fixture, so that it ends last: the page sends requests until its end.
@pytest.mark.long
def test_a_tutor_saves_an_exercise(writing: str, visit: Opening, folder: Path) -> None:
    opened = visit()
    page = opened.page
    page.goto(f"{writing}/tutor/editor?exercise=scara")
    text = page.get_by_label("Exercise file, TOML")
    written = text.input_value()
    # The editor saves a copy in its own folder, and opens the copy from now on.
    text.fill(written.replace("SCARA manipulator", "A robot", 1))
    save = page.get_by_role("button", name="Save")
    save.click()
    told = page.get_by_role("status")
    expect(told.filter(has_text="scara-copy.toml is saved")).to_be_visible()
    file = folder / "scara-copy.toml"
    assert file.read_text(encoding="utf-8") == text.input_value() != written
    page.goto(f"{writing}/tutor/editor?exercise=scara-copy")
    expect(text).to_have_value(file.read_text(encoding="utf-8"))

    # If somebody else has changed the file meanwhile, it is not overwritten.
    file.write_text(written, encoding="utf-8")
    text.fill(f"{written}\n# mine\n")
    save.click()
    expect(told.filter(has_text="has changed")).to_be_visible()
    assert file.read_text(encoding="utf-8") == written
    # A text that is not an exercise is not saved.
    text.fill("title = 1")
    page.get_by_label("Exercise id").fill("../escaped")
    save.click()
    expect(told.filter(has_text="is saved")).to_have_count(0)
    expect(page.locator("#findings li").first).to_be_visible()
    assert [each.name for each in folder.iterdir()] == ["scara-copy.toml"]
    assert all("409" in each for each in opened.complaints)
    opened.complaints.clear()
