"""Test a whole course in the browser, from the class list to the gradebook."""

import csv
from collections.abc import Callable
from datetime import datetime, timedelta
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest
from dh_grader.catalogue import shipped_folder
from playwright.sync_api import Page, expect

from tests.api.serving import served
from tests.browser.course.test_lecturer import SECRET, administrator
from tests.browser.fixtures import Visit
from tests.browser.learner.test_learner import WRONG, fill, hand_in

CLASS = "name,email\nAda Lovelace,ada@example.edu\nGrace Hopper,grace@example.edu\n"
# A table without the half turn earns 6.25 of the 8 points of the table (docs/attempts.md).
BEFORE, AFTER = "6.25", "8"
LATE_BEFORE, LATE_AFTER = "3.13", "4"


def day(days: int) -> str:
    return f"{datetime.now(ZoneInfo('Europe/Berlin')) + timedelta(days=days):%Y-%m-%dT%H:%M}"


def correct(folder: Path) -> None:
    text = (shipped_folder() / "scara.toml").read_text(encoding="utf-8")
    changed = text.replace('["a2", "180deg",', '["a2", "0",')
    (folder / "scara.toml").write_text(changed, encoding="utf-8")


def set_up(tutor: Page, address: str, key: str) -> None:
    """Sign in, and create a course with an assignment that is due tomorrow."""
    tutor.goto(f"{address}/tutor/courses")
    tutor.get_by_label("Your key").fill(key)
    tutor.get_by_role("button", name="Sign in").click()
    tutor.get_by_label("Title").fill("Robots")
    tutor.get_by_label("Id").fill("robots")
    tutor.get_by_label("Time zone").fill("Europe/Berlin")
    tutor.get_by_role("button", name="Create").click()
    tutor.get_by_label("or paste it").fill(CLASS)
    tutor.get_by_role("button", name="Add learners").click()
    expect(tutor.get_by_role("link", name="Ada Lovelace")).to_be_visible()
    tutor.get_by_label("Id").fill("homework")
    tutor.get_by_label("Title").first.fill("Homework")
    tutor.get_by_label("Exercise", exact=True).select_option("scara")
    tutor.get_by_label("Due").fill(day(1))
    tutor.get_by_role("button", name="Add assignment").click()
    expect(tutor.get_by_role("cell", name="0 of 2")).to_be_visible()


def links(tutor: Page, file: Path) -> dict[str, str]:
    """Download the personal links; return them by the learners' names."""
    with tutor.expect_download() as downloading:
        tutor.get_by_role("button", name="Download links").click()
    downloading.value.save_as(file)
    rows = csv.DictReader(file.read_text("utf-8-sig").splitlines())
    return {row["name"]: row["link"] for row in rows}


def open_homework(page: Page, link: str) -> None:
    page.goto(link)
    page.locator(".assignment").get_by_role("link").click()


@pytest.mark.long
def test_the_whole_way(visit: Callable[..., Visit], tmp_path: Path) -> None:
    database, folder = str(tmp_path / "attempts.db"), tmp_path / "exercises"
    folder.mkdir()
    (folder / "scara.toml").write_bytes((shipped_folder() / "scara.toml").read_bytes())
    key = administrator(database)
    settings = {
        "DH_GRADER_DATABASE": database,
        "DH_GRADER_SECRET": SECRET,
        "DH_GRADER_EXERCISES_DIR": str(folder),
        "DH_GRADER_RELOAD_EXERCISES": "true",
    }
    with served(tmp_path, **settings) as server:
        tutor, ada, grace = (visit().page for _ in range(3))
        set_up(tutor, server.address, key)
        link_of = links(tutor, tmp_path / "links.csv")

        # Ada types a table, hands it in, and reads the report.
        open_homework(ada, link_of["Ada Lovelace"])
        fill(ada, WRONG)
        hand_in(ada)
        expect(ada.get_by_text(f"Handed in. Attempt 1: {BEFORE} of 24 points.")).to_be_visible()
        expect(ada.locator("td[data-verdict=incorrect]")).to_have_count(1)

        # The tutor sets an earlier due date, and accepts Grace's attempt after it.
        tutor.get_by_role("link", name="Homework").click()
        tutor.get_by_text("Change the assignment").click()
        tutor.get_by_label("Due").nth(1).fill(day(-1))
        tutor.get_by_role("button", name="Save", exact=True).click()
        expect(tutor.get_by_text("Not complete: 1 of 2")).to_be_visible()
        open_homework(grace, link_of["Grace Hopper"])
        expect(grace.get_by_text("Closed since")).to_be_visible()
        chosen = tutor.get_by_label("Learner", exact=True)
        chosen.select_option(
            chosen.locator("option", has_text="Grace Hopper").get_attribute("value")
        )
        tutor.get_by_label("Closes").nth(0).fill(day(1))
        tutor.get_by_role("button", name="Save extension").click()
        expect(tutor.get_by_role("link", name="Grace Hopper").first).to_be_attached()
        open_homework(grace, link_of["Grace Hopper"])
        expect(grace.get_by_text("earn 50 % of their points")).to_be_visible()
        fill(grace, WRONG)
        hand_in(grace)
        expect(grace.get_by_text(f"{LATE_BEFORE} of 24 points").first).to_be_visible()

        # The gradebook shows both. The exercise is corrected and regraded.
        book = tutor.locator("#book tbody tr")

        def shows(ada_s: str, grace_s: str) -> None:
            tutor.goto(f"{server.address}/tutor/courses/robots/gradebook")
            for name, points in (("Ada", ada_s), ("Grace", grace_s)):
                row = book.filter(has_text=name).locator("td")
                expect(row).to_have_text([points, points])

        shows(BEFORE, LATE_BEFORE)
        correct(folder)
        tutor.goto(f"{server.address}/tutor/statistics/scara")
        write = tutor.get_by_role("button", name="Write the new reports")
        while not write.is_visible():  # until the service has seen the new file
            tutor.get_by_role("button", name="Preview regrade").click()
            expect(tutor.get_by_role("button", name="Stop")).to_be_hidden()
            tutor.wait_for_timeout(100)
        # The check still says what was right before.
        expect(tutor.get_by_text("The exercise fails its check.")).to_be_visible()
        expect(write).to_be_disabled()
        tutor.get_by_label("Regrade with it as it is").check()
        write.click()
        expect(tutor.get_by_text("Regraded: 2 attempts.")).to_be_visible()
        shows(AFTER, LATE_AFTER)

        for page, name, points in ((ada, "Ada", AFTER), (grace, "Grace", LATE_AFTER)):
            page.goto(next(link for each, link in link_of.items() if name in each))
            expect(page.locator(".assignment")).to_contain_text(f"{points} of 24 points count")
            page.locator(".assignment").get_by_role("link").click()
            page.locator(".handed-in li").get_by_role("link").click()
            expect(page.locator(".recorded td[data-verdict=correct]")).to_have_count(16)
            # The page may still load a style sheet, which would fail when the server has ended.
            page.close()
