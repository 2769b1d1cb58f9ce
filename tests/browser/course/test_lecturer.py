"""A lecturer runs a whole course in the browser."""

import csv
import json
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path
from urllib.request import Request, urlopen

import pytest
from dh_grader.access import Scope, Secret, new_key_text
from dh_grader.access.keys import add_key
from dh_grader.store import AttemptStore
from dh_grader.store.database import in_transaction
from playwright.sync_api import Page, expect

from tests.api.serving import served
from tests.browser.fixtures import Visit
from tests.browser.hostile import PICTURE
from tests.browser.test_pages import violations
from tests.browser.test_tutor import NARROW, wide
from tests.guards import ANSWER

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


def hand_in(link: str, address: str) -> None:
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
        hand_in({row["learner"]: row["link"] for row in links}["u1"], server.address)

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
