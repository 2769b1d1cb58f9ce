"""Test a course from its lecturer to its students."""

import csv
import json
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path
from urllib.request import Request, urlopen
from zoneinfo import ZoneInfo

import pytest
from dh_grader.access import Scope, Secret, new_key_text
from dh_grader.access.key_ring import add_key
from dh_grader.catalogue import shipped_folder
from dh_grader.client import GraderClient
from dh_grader.contract.courses import LearnersRequest, LinksRequest, NewAssignment, NewCourse
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import in_transaction
from playwright.sync_api import Page, expect

from tests.api.serving import served
from tests.browser.fixtures import Visit
from tests.browser.hostile import PICTURE
from tests.browser.learner.test_learner import WRONG, fill, hand_in
from tests.browser.test_pages import violations
from tests.browser.test_tutor import NARROW, wide
from tests.guards import ANSWER

# --- A lecturer runs a whole course in the browser

SECRET = "0123456789abcdef" * 4
RIGHT = "a1 0 0 θ1\na2 180deg 0 θ2\n0 0 d3 0\n0 0 d4 θ4"
QUOTED = PICTURE.replace('"', '""')
CLASS = f"""id,name,email
u1,Ada Lovelace,ada@example.edu
u2,"{QUOTED}",
u3,Alan Turing,
u4,Alan Turing,alan@example.edu
"""


def administrator(database: str) -> str:
    store, text, now = AttemptStore.open(database), new_key_text(), datetime.now(UTC)
    digest, until = Secret(SECRET).key_digest(text), now + timedelta(days=1)
    in_transaction(
        store.engine, lambda it: add_key(it, "", digest, [Scope.TUTOR], None, now, until)
    )
    store.close()
    return text


def hand_in_as_student(link: str, address: str) -> None:
    body = json.dumps({"exercise": "scara", "answers": {"table": RIGHT}}).encode()
    headers = {"Authorization": f"Bearer {link.partition('#')[2]}", "Idempotency-Key": "1"}
    path = f"{address}/v1/courses/robots/assignments/homework-1/attempts"
    with urlopen(Request(path, body, headers), timeout=ANSWER) as answer:
        assert answer.status == 201


@pytest.mark.long
def test_a_lecturer_runs_a_course(visit: Callable[..., Visit], axe: str, tmp_path: Path) -> None:
    database = str(tmp_path / "attempts.db")
    key = administrator(database)
    with served(tmp_path, DH_GRADER_DATABASE=database, DH_GRADER_SECRET=SECRET) as server:
        made = visit(bypass_csp=True, viewport=NARROW)
        page = made.page
        page.add_init_script(axe)
        page.goto(f"{server.address}/tutor/courses")

        def check() -> None:
            assert "\n".join(violations(page, "")) == ""
            assert wide(page) <= NARROW["width"]

        # The page asks for the key once, and leads back.
        page.get_by_label("Your key").fill("dhg_nonsense")
        page.get_by_role("button", name="Sign in").click()
        expect(page.get_by_role("alert")).to_contain_text("misspelt")
        check()
        page.get_by_label("Your key").fill(key)
        page.get_by_role("button", name="Sign in").click()
        expect(page.get_by_role("heading", level=1)).to_have_text("Courses")
        page.get_by_label("Title").fill("Robots 2026")
        page.get_by_label("Id").fill("robots")
        page.get_by_label("Time zone").fill("Europe/Nowhere")
        page.get_by_role("button", name="Create").click()
        expect(page.get_by_role("status")).to_contain_text("no time zone Europe/Nowhere")
        check()
        # The browser complains of both refusals.
        assert len(made.complaints) == 2
        made.complaints.clear()
        page.get_by_label("Time zone").fill("Europe/Berlin")
        page.get_by_role("button", name="Create").click()
        expect(page.get_by_role("heading", level=1)).to_have_text("Robots 2026")

        (tmp_path / "class.csv").write_text(CLASS, encoding="utf-8")
        page.get_by_label("File").set_input_files(tmp_path / "class.csv")
        expect(page.get_by_label("or paste it")).to_have_value(CLASS)
        page.get_by_role("button", name="Add learners").click()
        expect(page.get_by_role("link", name=PICTURE)).to_be_visible()
        expect(page.get_by_text("4 learners, 4 of them new.")).to_be_visible()
        rows = page.locator("#learner-rows tr:visible")
        expect(page.locator("#learner-count")).to_have_text("4 learners")
        page.get_by_label("Find a learner").fill("TURÍNG")
        expect(page.locator("#learner-count")).to_have_text("2 of 4 learners")
        expect(rows).to_have_count(2)
        check()
        page.get_by_label("Find a learner").fill("")
        expect(rows).to_have_count(4)
        _refused_homework(page)
        _set_homework(page)
        expect(page.get_by_role("cell", name="0 of 4")).to_be_visible()
        expect(page.get_by_role("cell", name="2030-10-15 23:59")).to_be_visible()
        said = "Saved: Homework 1. No late attempts are accepted, because Closes is empty."
        expect(page.get_by_text(said)).to_be_visible()
        expect(page.get_by_role("cell", name="no late attempts")).to_be_visible()
        check()
        with page.expect_download() as downloading:
            page.get_by_role("button", name="Download links").click()
        downloading.value.save_as(tmp_path / "links.csv")
        links = csv.DictReader((tmp_path / "links.csv").read_text("utf-8-sig").splitlines())
        hand_in_as_student({row["learner"]: row["link"] for row in links}["u1"], server.address)

        page.get_by_role("link", name="Homework 1").click()
        page.get_by_text("Not complete: 3 of 4 learners").click()
        # Two learners have one name.
        chosen = page.get_by_label("Learner", exact=True)
        for told in ("Alan Turing (u3)", "Alan Turing (u4)", "Ada Lovelace (u1)"):
            chosen.select_option(label=told)
        chosen.select_option("u2")
        page.get_by_label("Due").nth(0).fill("2030-10-20T12:00")
        check()
        page.get_by_role("button", name="Save extension").click()
        expect(page.get_by_text(f"{PICTURE}: due 2030-10-20 12:00, closes –")).to_be_visible()
        # A later change keeps the values that the learner has already.
        chosen.select_option("u2")
        expect(page.get_by_label("Due").nth(0)).to_have_value("2030-10-20T12:00")
        page.get_by_label("Closes").nth(0).fill("2030-10-19T12:00")
        page.get_by_label("Attempts", exact=True).fill("7")
        page.get_by_role("button", name="Save extension").click()
        # Late attempts are accepted at least until the due date.
        told = f"{PICTURE}: due 2030-10-20 12:00, closes 2030-10-20 12:00, at most 7 attempts"
        expect(page.get_by_text(told)).to_be_visible()
        chosen.select_option("u2")
        expect(page.get_by_label("Closes").nth(0)).to_have_value("2030-10-19T12:00")
        chosen.select_option("u1")
        expect(page.get_by_label("Due").nth(0)).to_have_value("")
        expect(page.get_by_label("Attempts", exact=True)).to_have_value("")
        page.get_by_role("link", name="Gradebook").click()
        # The table is worth 8 of 24 points, here of 20.
        row = page.locator("#book tbody tr").filter(has_text="Ada Lovelace")
        expect(row.locator("td")).to_have_text(["6.67", "6.67"])
        heads = page.locator("#book tbody th").filter(has_text="Alan")
        expect(heads).to_have_text(["Alan Turing u3", "Alan Turing alan@example.edu"])
        first = page.locator("#book tbody tr").first
        page.get_by_role("button", name="Total").click()
        expect(first).to_contain_text("Ada Lovelace")
        page.get_by_role("button", name="Total").press("Enter")
        expect(first).to_contain_text(PICTURE)
        check()
        page.get_by_label("Learner").fill("lovelace")
        expect(page.get_by_role("status")).to_have_text("1 learner")
        row.get_by_role("link", name="6.67").click()
        # The list shows only attempts of this course, exercise and learner; override the mark.
        page.locator("#list tbody a").click()
        page.get_by_label("Points").fill("12")
        page.get_by_label("Reason").fill("A misprint.")
        page.get_by_role("button", name="Save").click()
        expect(page.get_by_text("The attempt has 12 points.")).to_be_visible()
        page.goto(f"{server.address}/tutor/courses/robots/learner?learner=u1")
        expect(page.get_by_role("cell", name="10 / 20")).to_be_visible()
        check()
        page.goto(f"{server.address}/tutor/courses/robots/assignments/homework-1")
        _delete(page, "1 assignment, 1 extension, 1 attempt with answers and reports", check)
        expect(page.get_by_text("There is no assignment yet.")).to_be_visible()
        page.goto(f"{server.address}/tutor/courses/robots/learner?learner=u1")
        page.get_by_text("Remove from the course").click()
        page.get_by_role("button", name="Delete the learner").click()
        expect(page.get_by_text("0 attempts of this learner will stay.")).to_be_visible()
        page.get_by_role("button", name="Delete permanently").click()
        expect(page.get_by_role("link", name="Ada Lovelace")).to_have_count(0)
        _delete(page, "the place of 3 learners, 3 links", check)
        expect(page).to_have_url(f"{server.address}/tutor/courses")
        expect(page.get_by_role("link", name="Robots 2026")).to_have_count(0)


def _delete(page: Page, said: str, check: Callable[[], None]) -> None:
    page.get_by_text("Delete", exact=True).click()
    page.get_by_role("button", name="Delete the").click()
    expect(page.get_by_text(said)).to_be_visible()
    check()
    page.get_by_role("button", name="Cancel").click()
    page.get_by_role("button", name="Delete the").click()
    page.get_by_role("button", name="Delete permanently").click()


def _refused_homework(page: Page) -> None:
    expect(page.get_by_text("only if Closes is after Due")).to_be_visible()
    page.get_by_label("Id").fill("HW 9")
    page.get_by_label("Title").first.fill("Homework 9")
    page.get_by_role("button", name="Add assignment").click()
    said = "The id has small letters, digits and hyphens, such as homework-1."
    expect(page.get_by_text(f"{said} Choose at least one exercise.")).to_be_visible()


def _set_homework(page: Page) -> None:
    page.get_by_label("Id").fill("homework-1")
    page.get_by_label("Title").first.fill("Homework 1")
    page.get_by_label("Exercise", exact=True).select_option("scara")
    points = page.get_by_label("Points", exact=True)
    expect(points).to_have_value("24")
    points.fill("20")
    page.get_by_label("Due").fill("2030-10-15T23:59")
    page.get_by_role("button", name="Add assignment").click()


# --- A tutor gives each learner a personal variant of an exercise

EXERCISE = "planar-rr-numbers"


@pytest.mark.long
def test_a_tutor_sees_and_deals_variants(
    visit: Callable[..., Visit], axe: str, tmp_path: Path
) -> None:
    database = str(tmp_path / "attempts.db")
    key = administrator(database)
    options = {"DH_GRADER_DATABASE": database, "DH_GRADER_SECRET": SECRET}
    with served(tmp_path, **options) as server, GraderClient(server.address, key) as tutor:
        tutor.create_course(NewCourse(id="robots", title="Robots", zone="Europe/Berlin"))
        tutor.add_learners("robots", LearnersRequest(csv="id,name\nu1,Ada\n"))
        chosen = [{"exercise": EXERCISE, "points": 8}]
        new = {"id": "hw", "title": "Homework", "exercises": chosen}
        tutor.create_assignment("robots", NewAssignment.model_validate(new))
        page = visit(bypass_csp=True).page
        page.add_init_script(axe)
        page.goto(f"{server.address}/tutor/courses/robots/assignments/hw")
        page.get_by_label("Your key").fill(key)
        page.get_by_role("button", name="Sign in").click()
        page.get_by_text("Change the assignment").click()
        own = page.get_by_label("Each learner gets numbers of their own")
        expect(own).not_to_be_checked()
        own.check()
        with page.expect_navigation():
            page.get_by_role("button", name="Save", exact=True).click()
        assert tutor.assignment("robots", "hw").variants
        expect(own).to_be_checked()

        [first] = tutor.variants("robots", "hw", "u1").variants
        page.goto(f"{server.address}/tutor/courses/robots/learner?learner=u1")
        expect(page.get_by_role("link", name=first.seed, exact=True)).to_be_visible()
        assert "\n".join(violations(page, "")) == ""
        page.get_by_role("button", name="Deal a new one").click()
        expect(page.get_by_text("(deal 2)")).to_be_visible()
        [second] = tutor.variants("robots", "hw", "u1").variants
        assert second.seed != first.seed

        [link] = tutor.links("robots", LinksRequest()).links
        with GraderClient(server.address, link.link.partition("#")[2]) as ada:
            answers = {"table": "0 0 0 theta1"}
            attempt = ada.hand_in("robots", "hw", EXERCISE, answers).attempt.id
        page.goto(f"{server.address}/tutor/attempts/{attempt}")
        expect(page.get_by_role("link", name=second.seed)).to_be_visible()
        # The page shows the exercise with the learner's numbers, which has this version.
        expect(page.get_by_text("Graded by")).to_be_visible()
        expect(page.get_by_text("not the current version")).to_have_count(0)
        title = tutor.exercise(second.variant).title
        expect(page.get_by_role("heading", level=1)).to_have_text(title)


# --- Test a whole course in the browser, from the class list to the gradebook

WHOLE_WAY_CLASS = "name,email\nAda Lovelace,ada@example.edu\nGrace Hopper,grace@example.edu\n"
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
    tutor.get_by_label("or paste it").fill(WHOLE_WAY_CLASS)
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
