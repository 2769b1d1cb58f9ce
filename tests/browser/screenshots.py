"""Take screenshots of every view for the docs: ``make screenshots``."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import Final

from dh_grader.catalogue import load_catalogue, shipped_folder
from dh_grader.store.attempt_store import AttemptStore
from playwright.sync_api import Page, ViewportSize, expect, sync_playwright

from tests.api.serving import ROOT, announced_port
from tests.browser.chromium import ABSENT, OPTIONS, find_chromium
from tests.browser.fixtures import GUARD
from tests.browser.steps import cells, open_exercise
from tests.store.recorded import LAZY, NO_TWIST, RIGHT, new_attempt, recorded_all

FOLDER: Final = ROOT / "docs" / "screenshots"
SIZES: Final[Mapping[str, ViewportSize]] = {
    "wide": {"width": 1280, "height": 860},
    "narrow": {"width": 360, "height": 780},
}
# Two slips: the sign of an angle, and an unfinished formula.
ANSWERS: Final = [
    "0", "-90°", "0", "theta1", "0", "pi/2", "d2", "theta2", "0", "0", "d3", "0",
    "0", "pi/2", "0", "theta4", "0", "90°", "0", "theta5", "0", "0", "d6 +", "theta6",
]  # fmt: skip
# Learner, table and number of the attempt, the oldest first.
UNFINISHED: Final = RIGHT.replace("θ2", "θ2 +").replace("d4 θ4", "0 θ4")
CLASS: Final = [
    ("u4711", NO_TWIST, 1), ("u4712", LAZY, 1), ("u4713", NO_TWIST, 1), ("u4711", RIGHT, 2),
    ("u4714", NO_TWIST, 1), ("u4715", RIGHT, 1), ("u4712", NO_TWIST, 2), ("u4716", LAZY, 1),
    ("u4717", NO_TWIST, 1), ("u4714", RIGHT, 2), ("u4718", RIGHT, 1), ("u4713", UNFINISHED, 2),
]  # fmt: skip


def home(page: Page, service: str) -> None:
    """Open the catalogue."""
    page.goto(service)
    expect(page.get_by_label("Find an exercise")).to_be_visible()


def exercise(page: Page, service: str) -> None:
    """Open an exercise and fill in some cells."""
    open_exercise(page, service, "stanford-arm")
    for i, text in enumerate(ANSWERS[:14]):
        cells(page).nth(i).fill(text)
    expect(page.locator(".part").first.locator(".shown math")).to_have_count(14)
    cells(page).nth(13).focus()


def report(page: Page, service: str) -> None:
    """Open the report on a table with two slips."""
    open_exercise(page, service, "stanford-arm")
    for i, text in enumerate(ANSWERS):
        cells(page).nth(i).fill(text)
    page.get_by_role("button", name="Check").click()
    expect(page.locator("td[data-verdict=unreadable]")).to_have_count(1)
    page.locator(".part").first.evaluate("part => part.scrollIntoView()")


def robot_view(page: Page, service: str) -> None:
    """Open the 3D view with a student's table that has a slip."""
    exercise(page, service)
    for i, text in enumerate(ANSWERS[14:22], 14):
        cells(page).nth(i).fill(text)
    page.get_by_role("button", name="Move it in 3D").click()
    page.locator(".slider").first.scroll_into_view_if_needed()
    expect(page.locator(".robot-view")).to_have_attribute("aria-busy", "false")
    page.get_by_role("slider", name="theta2").fill("-0.6")
    expect(page.locator(".robot-view")).to_have_attribute("aria-busy", "false")
    page.get_by_role("heading", level=1).scroll_into_view_if_needed()


def free_play(page: Page, service: str) -> None:
    """Open an arm in free play."""
    page.goto(f"{service}/play")
    page.get_by_label("Start from a robot").select_option("Elbow arm with a wrist, 6R")
    expect(page.locator(".slider")).to_have_count(6)
    expect(page.locator(".robot-view")).to_have_attribute("aria-busy", "false")


def practice(page: Page, service: str) -> None:
    """Open a generated robot."""
    page.goto(f"{service}/practice#practice-1-standard~g9z1")
    expect(cells(page)).not_to_have_count(0)
    drawing = page.get_by_role("img", name="Drawing of the robot")
    drawing.evaluate("image => image.decode()")


def reading_help(page: Page, service: str) -> None:
    page.goto(f"{service}/help/expressions")


def ten_minutes(page: Page, service: str) -> None:
    page.goto(f"{service}/learn-dh#alpha")
    page.locator("#alpha input").fill("-90")
    page.locator("#alpha").get_by_role("button", name="Check").click()
    expect(page.locator("#alpha .told")).to_contain_text("The sign of α is wrong")
    page.evaluate("scrollTo(0, 0)")


def frames(page: Page, service: str) -> None:
    open_exercise(page, service, "planar-rrr-frames")
    placed = ("1,+z,0,0,0,+x", "2,-z,l1,0,0,+x", "3,+z,l1+l2,0,0,+z")
    for i, text in enumerate(",".join(placed).split(",")):
        cells(page).nth(i).fill(text)
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".part").first).to_contain_text("x must be perpendicular")
    page.locator(".part").first.evaluate("part => part.scrollIntoView()")


def slip(page: Page, service: str) -> None:
    open_exercise(page, service, "find-the-slip-scara")
    page.get_by_role("button", name="mark row 3").click()
    page.get_by_role("button", name="Check").click()
    expect(page.locator(".messages")).to_contain_text("The slip is not here")
    page.locator(".part").first.evaluate("part => part.scrollIntoView()")


def solution(page: Page, service: str) -> None:
    """Open a model solution."""
    page.goto(f"{service}/tutor/solutions/scara")
    expect(page.locator("math mtable").first).to_be_visible()


def editor(page: Page, service: str) -> None:
    """Open the editor with a mistake in the file."""
    page.goto(f"{service}/tutor/editor?exercise=scara")
    text = page.get_by_label("Exercise file, TOML")
    expect(page.locator("#findings")).to_contain_text("No problems found.")
    text.fill(text.input_value().replace("points = ", "pionts = ", 1))
    expect(page.locator("#findings")).to_contain_text("did you mean 'points'?")
    page.locator("#findings").get_by_role("button", name="line").click()
    page.evaluate("scrollTo(0, 0)")


def attempts(page: Page, service: str) -> None:
    """Open the list of recorded attempts."""
    page.goto(f"{service}/tutor/attempts?exercise=scara")
    expect(page.locator("#list tbody tr")).to_have_count(len(CLASS))


def attempt(page: Page, service: str) -> None:
    """Open a recorded attempt with its report."""
    attempts(page, service)
    page.locator("#list").get_by_role("link", name="u4713").first.click()
    expect(page.locator("td[data-verdict=unreadable]")).to_have_count(1)


def statistics(page: Page, service: str) -> None:
    """Open the statistics of an exercise."""
    page.goto(f"{service}/tutor/statistics/scara")
    expect(page.locator(".share").first).to_be_visible()


VIEWS: Final[Mapping[str, Callable[[Page, str], None]]] = {
    "catalogue": home,
    "exercise": exercise,
    "report": report,
    "robot-view": robot_view,
    "free-play": free_play,
    "practice": practice,
    "learn-dh": ten_minutes,
    "help": reading_help,
    "frames": frames,
    "find-the-slip": slip,
    "solution": solution,
    "editor": editor,
    "attempts": attempts,
    "attempt": attempt,
    "statistics": statistics,
}


def recorded_class(database: Path) -> None:
    store = AttemptStore.open(str(database))
    scara = load_catalogue(shipped_folder())["scara"]
    recorded_all(
        store,
        (
            new_attempt(scara, learner, table, ordinal, hours=31 * i)
            for i, (learner, table, ordinal) in enumerate(CLASS)
        ),
    )
    store.close()


def take_screenshots(service: str, names: Collection[str]) -> None:
    """Take screenshots of the named views, in light and dark, wide and narrow."""
    found = find_chromium()
    if found is None:
        raise SystemExit(ABSENT)
    FOLDER.mkdir(exist_ok=True)
    expect.set_options(timeout=GUARD)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=found.program, args=OPTIONS, env={**os.environ, **found.environment}
        )
        for size, viewport in SIZES.items():
            for scheme in ("light", "dark"):
                page = browser.new_page(viewport=viewport, reduced_motion="reduce")
                page.set_default_timeout(GUARD)
                page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
                for name in names:
                    # Start each view as on a first visit.
                    page.goto(service)
                    page.evaluate("localStorage.clear()")
                    VIEWS[name](page, service)
                    # Wait until the pictures have been loaded, too.
                    page.wait_for_load_state("networkidle")
                    page.screenshot(path=FOLDER / f"{name}-{size}-{scheme}.png")
                page.close()
        browser.close()


def main() -> None:
    names = sys.argv[1:] or VIEWS
    if unknown := set(names) - set(VIEWS):
        raise SystemExit(f"There is no view {', '.join(unknown)}; there are {', '.join(VIEWS)}.")
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log"
        command = [sys.executable, "-m", "dh_grader", "serve", "--port", "0"]
        database = Path(folder) / "attempts.db"
        recorded_class(database)
        environment = os.environ | {"NO_COLOR": "1", "DH_GRADER_DATABASE": str(database)}
        with (
            log.open("wb") as output,
            subprocess.Popen(
                command, cwd=ROOT, stdout=output, stderr=output, env=environment
            ) as process,
        ):
            try:
                take_screenshots(f"http://127.0.0.1:{announced_port(process, log)}", names)
            finally:
                process.terminate()


if __name__ == "__main__":
    main()
