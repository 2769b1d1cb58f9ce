"""Photographs every view for the docs: ``make screenshots``."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

from playwright.sync_api import Page, ViewportSize, expect, sync_playwright

from tests.api.serving import ROOT, announced_port
from tests.browser.chromium import ABSENT, OPTIONS, find_chromium
from tests.browser.steps import cells, open_exercise

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


def home(page: Page, service: str) -> None:
    """The catalogue."""
    page.goto(service)
    expect(page.get_by_label("Find an exercise")).to_be_visible()


def exercise(page: Page, service: str) -> None:
    """An exercise while it is filled in."""
    open_exercise(page, service, "stanford-arm")
    for i, text in enumerate(ANSWERS[:14]):
        cells(page).nth(i).fill(text)
    expect(page.locator(".part").first.locator(".shown math")).to_have_count(14)
    cells(page).nth(13).focus()


def report(page: Page, service: str) -> None:
    """The report on a table with two slips."""
    open_exercise(page, service, "stanford-arm")
    for i, text in enumerate(ANSWERS):
        cells(page).nth(i).fill(text)
    page.get_by_role("button", name="Check").click()
    expect(page.locator("td[data-verdict=unreadable]")).to_have_count(1)
    page.locator(".part").first.evaluate("part => part.scrollIntoView()")


def robot_view(page: Page, service: str) -> None:
    """The robot in 3D, with a student's table that has a slip over it."""
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
    """An arm in free play."""
    page.goto(f"{service}/play")
    page.get_by_label("Start from a robot").select_option("Elbow arm with a wrist, 6R")
    expect(page.locator(".slider")).to_have_count(6)
    expect(page.locator(".robot-view")).to_have_attribute("aria-busy", "false")


VIEWS: Final[Mapping[str, Callable[[Page, str], None]]] = {
    "catalogue": home,
    "exercise": exercise,
    "report": report,
    "robot-view": robot_view,
    "free-play": free_play,
}


def photograph(service: str) -> None:
    """Every view, in light and dark, wide and narrow."""
    found = find_chromium()
    if found is None:
        raise SystemExit(ABSENT)
    FOLDER.mkdir(exist_ok=True)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=found.program, args=OPTIONS, env={**os.environ, **found.environment}
        )
        for size, viewport in SIZES.items():
            for scheme in ("light", "dark"):
                page = browser.new_page(viewport=viewport, reduced_motion="reduce")
                page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
                for name, view in VIEWS.items():
                    view(page, service)
                    # The pictures, too.
                    page.wait_for_load_state("networkidle")
                    page.screenshot(path=FOLDER / f"{name}-{size}-{scheme}.png")
                page.close()
        browser.close()


def main() -> None:
    """Start the service and photograph it."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log"
        command = [sys.executable, "-m", "service", "serve", "--port", "0"]
        environment = os.environ | {"NO_COLOR": "1"}
        with (
            log.open("wb") as output,
            subprocess.Popen(
                command, cwd=ROOT, stdout=output, stderr=output, env=environment
            ) as process,
        ):
            try:
                photograph(f"http://127.0.0.1:{announced_port(process, log)}")
            finally:
                process.terminate()


if __name__ == "__main__":
    main()
