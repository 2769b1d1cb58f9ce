"""A tutor works with recorded attempts in the browser."""

import csv
import json
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any
from urllib.request import Request, urlopen

import pytest
from dh_grader.access import Scope, Secret, new_key_text
from dh_grader.access.keys import add_key
from dh_grader.catalogue import shipped_folder
from dh_grader.store import AttemptStore
from dh_grader.store.database import in_transaction
from playwright.sync_api import Page, expect

from tests.api.serving import served
from tests.browser.fixtures import Visit
from tests.browser.hostile import PICTURE
from tests.browser.steps import cells
from tests.browser.test_pages import violations
from tests.browser.test_tutor import NARROW, wide
from tests.guards import ANSWER

Opening = Callable[..., Visit]

RIGHT = "a1 0 0 θ1\na2 180deg 0 θ2\n0 0 d3 0\n0 0 d4 θ4"
ROWS = [["a1", "0", "0", "theta1"], ["a2", "0", "0", "theta2 +"], ["0", "0", "d3", "0"]]
WRONG = {"rows": [*ROWS, ["0", "0", PICTURE, "theta4"]]}
ANSWERS: list[tuple[str, Any]] = [("ada", RIGHT), ("grace", WRONG), (PICTURE, WRONG)]


@dataclass
class Recording:
    """A service that records attempts, with its exercise folder and two keys."""

    # `key` is a key to record attempts, and a tutor's key for all exercises; `narrow_key` is a
    # tutor's key for one exercise.
    address: str
    exercises: Path
    key: str
    narrow_key: str

    def sign_in(self, page: Page, key: str = "") -> None:
        page.goto(f"{self.address}/tutor")
        page.get_by_label("Your key").fill(key or self.key)
        page.get_by_role("button", name="Sign in").click()
        expect(page.get_by_role("heading", level=1)).to_have_text("For tutors")

    def record(self, learner: str, table: Any) -> str:
        """Record an attempt and return its id."""
        body = json.dumps({"learner": learner, "answers": {"table": table}}).encode()
        headers = {"Content-Type": "application/json", "Authorization": f"Bearer {self.key}"}
        asked = Request(f"{self.address}/v1/exercises/scara/attempts", body, headers)
        with urlopen(asked, timeout=ANSWER) as answer:
            return str(json.load(answer)["attempt"]["id"])

    def correct(self) -> None:
        text = (shipped_folder() / "scara.toml").read_text(encoding="utf-8")
        changed = text.replace('["a2", "180deg",', '["a2", "0",').partition("[[checks]]")[0]
        assert "180deg" not in changed, "the exercise has changed"
        (self.exercises / "scara.toml").write_text(changed, encoding="utf-8")


@pytest.fixture
def recording(tmp_path: Path) -> Iterator[Recording]:
    folder = tmp_path / "exercises"
    folder.mkdir()
    text = (shipped_folder() / "scara.toml").read_text(encoding="utf-8")
    (folder / "scara.toml").write_text(text, encoding="utf-8")
    secret, now = "0123456789abcdef" * 4, datetime.now(UTC)
    database = str(tmp_path / "attempts.db")
    store = AttemptStore.open(database)
    until = now + timedelta(days=1)

    def key(*scopes: Scope, exercises: list[str] | None = None) -> str:
        text = new_key_text()
        digest = Secret(secret).key_digest(text)
        in_transaction(
            store.engine,
            lambda connection: add_key(connection, "", digest, scopes, exercises, now, until),
        )
        return text

    keys = key(Scope.RECORD, Scope.TUTOR), key(Scope.TUTOR, exercises=["scara"])
    store.close()
    variables = {
        "DH_GRADER_DATABASE": database,
        "DH_GRADER_SECRET": secret,
        "DH_GRADER_EXERCISES_DIR": str(folder),
        "DH_GRADER_RELOAD_EXERCISES": "true",
    }
    with served(tmp_path, **variables) as server:
        yield Recording(server.address, folder, *keys)


def rows(page: Page) -> Any:
    return page.locator("#list tbody tr")


@pytest.mark.long
def test_a_tutor_works_with_recorded_attempts(
    recording: Recording, visit: Opening, tmp_path: Path
) -> None:
    # Under the page's own policy, by keyboard where it matters, on a narrow screen.
    page = visit(viewport=NARROW).page
    page.add_init_script("window.taken = []; window.stolen = (what) => taken.push(what);")
    recording.sign_in(page)
    page.get_by_role("link", name="Recorded attempts").click()
    expect(page.get_by_text("Nobody has handed in yet")).to_be_visible()
    for learner, table in ANSWERS:
        recording.record(learner, table)

    # A tutor with a key for this exercise alone sees the same attempts.
    other = visit(viewport=NARROW).page
    recording.sign_in(other, recording.narrow_key)
    other.get_by_role("link", name="Recorded attempts").click()
    expect(rows(other)).to_have_count(3)
    other.close()

    # A student without a key is sent to the course page; headers are not mentioned.
    student = visit()
    student.page.goto(f"{recording.address}/exercises/scara")
    cells(student.page).first.fill("a1")
    student.page.get_by_role("button", name="Check").click()
    sentence = "Please open this exercise from your course page."
    expect(student.page.get_by_text(sentence).first).to_be_visible()
    expect(student.page.get_by_text("Authorization")).to_have_count(0)
    student.page.close()
    assert student.complaints
    assert all("401" in each for each in student.complaints)
    student.complaints.clear()

    # The address keeps the filters.
    page.get_by_label("Exercise").select_option("scara")
    expect(rows(page)).to_have_count(3)
    expect(rows(page).first).to_contain_text(PICTURE)
    page.get_by_label("Learner").first.fill(" grace ")
    page.keyboard.press("Enter")
    expect(rows(page)).to_have_count(1)
    page.reload()
    expect(rows(page)).to_have_count(1)
    page.get_by_label("To (inclusive)").fill("2020-01-01")
    expect(page.get_by_text("No attempt matches the filters")).to_be_visible()
    page.get_by_label("To (inclusive)").fill("")
    with page.expect_download() as downloading:
        page.get_by_role("link", name="CSV").click()
    assert downloading.value.suggested_filename == "attempts-scara.csv"
    downloading.value.save_as(tmp_path / "attempts.csv")
    with (tmp_path / "attempts.csv").open(encoding="utf-8", newline="") as file:
        assert [each["learner"] for each in csv.DictReader(file)] == ["grace"]

    # The page of an attempt shows the answers and the report.
    rows(page).get_by_role("link").click()
    entries = page.locator(".part").first.locator("tbody input")
    expect(entries.nth(4)).to_have_value("a2")
    assert [each.input_value() for each in entries.all()] == [
        text for row in WRONG["rows"] for text in row
    ]
    expect(page.locator("td[data-verdict=unreadable]")).to_have_count(2)
    expect(page.locator("td[data-verdict=incorrect]")).to_have_count(1)
    # It shows how each entry was read; the requests use the same key.
    expect(page.locator(".part").first.locator(".shown math")).to_have_count(14)
    # It is read-only: typing changes nothing, and there are no repairs.
    entries.nth(7).focus()
    page.keyboard.type("x")
    assert entries.nth(7).input_value() == "theta2 +"
    expect(page.locator(".repair")).to_have_count(0)
    assert wide(page) <= NARROW["width"]
    # The link to the list keeps the filters. Without an override, its field is empty.
    back = page.get_by_role("link", name="List of attempts")
    assert str(back.get_attribute("href")).endswith("?exercise=scara&learner=+grace+")
    expect(page.locator("#points")).to_have_value("")
    page.get_by_label("Reason").fill("A <b>misprint</b>.")
    page.locator("#points").fill("25")
    page.get_by_role("button", name="Save").click()
    assert page.locator("#points").evaluate("each => each.validity.rangeOverflow")
    page.locator("#points").fill("7.5")
    page.keyboard.press("Enter")
    expect(page.get_by_text("The attempt has 7.5 points.")).to_be_visible()
    expect(page.locator(".given")).to_contain_text("A <b>misprint</b>. key ")
    expect(page.locator(".facts")).to_contain_text("7.5 / 24")

    # The statistics, then the regrade: first a preview, then the new reports.
    page.goto(f"{recording.address}/tutor/statistics/scara")
    expect(page.get_by_text("3 attempts of 3 learners")).to_be_visible()
    shares = page.get_by_role("region", name="Shares: Denavit-Hartenberg table")
    second = shares.locator("tbody tr").nth(1).locator("td")
    expect(second.nth(1)).to_have_text("33 %")
    expect(second.last).to_have_text("3")
    expect(page.get_by_role("region", name="Misconceptions")).to_contain_text(
        "Something is missing after the + at the end."
    )
    expect(page.locator(".groups")).to_contain_text(f"2 learners: {PICTURE}, grace")
    # The text alternative of the chart: two attempts today.
    expect(page.get_by_role("img", name=re.compile(r"^\d+ \w+ 20\d\d: 2$")).first).to_be_visible()
    # Nobody has made a second attempt, so there is no learning curve yet.
    expect(page.locator(".curve")).to_have_count(0)
    assert wide(page) <= NARROW["width"]
    page.get_by_role("button", name="Preview regrade").click()
    expect(page.get_by_text("All attempts were graded by this version")).to_be_visible()
    recording.correct()
    changes = page.get_by_role("region", name="Changes")
    write = page.get_by_role("button", name="Write the new reports")

    def looked() -> None:
        page.get_by_role("button", name="Preview regrade").click()
        expect(page.get_by_role("button", name="Stop")).to_be_hidden()

    looked()
    while not changes.is_visible():  # until the service has seen the new file
        page.wait_for_timeout(100)
        looked()
    told = "3 would change; 1 of these would keep the overridden mark. Nothing is written yet."
    expect(page.get_by_text(told)).to_be_visible()
    expect(changes).to_contain_text("table correct → partial")
    expect(changes).to_contain_text("; the overridden mark 7.5 stays")
    write.click()
    expect(page.get_by_text("Regraded: 3 attempts. The earlier reports are kept.")).to_be_visible()
    expect(write).to_be_hidden()
    page.get_by_role("region", name="Changes").get_by_role("link", name="ada").click()
    expect(page.locator("td[data-verdict=incorrect]")).to_have_count(1)
    expect(page.locator("#which-report option").first).to_contain_text("Newest report: ")
    page.get_by_label("Report", exact=True).select_option("1")
    expect(page.locator("td[data-verdict=correct]")).to_have_count(16)

    # The deletion of a learner's data must be confirmed.
    page.get_by_role("link", name="List of attempts").click()
    expect(rows(page)).to_have_count(3)
    page.get_by_label("Learner").last.fill(PICTURE)
    page.keyboard.press("Enter")
    dialog = page.get_by_role("dialog", name=f"Forget {PICTURE}?")
    expect(dialog).to_contain_text("permanently deletes 1 attempt, 1 earlier report.")
    expect(dialog.get_by_role("button", name="Cancel")).to_be_focused()
    page.keyboard.press("Enter")
    expect(dialog).to_be_hidden()
    page.get_by_role("button", name="Look up").click()
    dialog.get_by_role("button", name=f"Delete all data of {PICTURE}").click()
    expect(page.get_by_text(f"Deleted for {PICTURE}: 1 attempt, 1 earlier report.")).to_be_visible()
    expect(rows(page)).to_have_count(2)
    expect(page.locator("#list")).not_to_contain_text(PICTURE)
    assert page.evaluate("taken") == []


@pytest.mark.campaign
def test_the_pages_of_attempts_are_accessible(
    recording: Recording, visit: Opening, service: str, axe: str
) -> None:
    [*_, attempt] = [recording.record(learner, table) for learner, table in ANSWERS]
    page = visit(bypass_csp=True, viewport=NARROW).page
    recording.sign_in(page)
    page.add_init_script(axe)

    def check() -> None:
        assert "\n".join(violations(page, "")) == ""
        assert wide(page) <= NARROW["width"]

    page.goto(f"{recording.address}/tutor/attempts?exercise=scara")
    expect(rows(page)).to_have_count(3)
    check()
    page.get_by_label("Learner").last.fill("ada")
    page.keyboard.press("Enter")
    expect(page.get_by_role("dialog")).to_be_visible()
    check()
    page.goto(f"{recording.address}/tutor/attempts/{attempt}")
    expect(page.locator("td[data-verdict=incorrect]")).to_have_count(1)
    page.get_by_text("As it was sent").click()
    check()
    recording.correct()
    page.goto(f"{recording.address}/tutor/statistics/scara")
    expect(page.locator(".share").first).to_be_visible()
    while not page.get_by_role("region", name="Changes").is_visible():
        page.get_by_role("button", name="Preview regrade").click()
        expect(page.get_by_role("button", name="Stop")).to_be_hidden()
        page.wait_for_timeout(100)
    check()
    # The mistake is gone in the second attempt.
    recording.record("grace", RIGHT)
    page.reload()
    curve = page.get_by_role("img", name="attempt 1: 67 % of 3, attempt 2: 0 % of 1")
    expect(curve.first).to_be_visible()
    check()
    # A service without a database explains how to add one.
    page.goto(f"{service}/tutor/attempts")
    expect(page.get_by_text("DH_GRADER_DATABASE=attempts.db")).to_be_visible()
    check()


@pytest.mark.long
def test_the_api_page_shows_recorded_answers_as_text(recording: Recording, visit: Opening) -> None:
    # Recorded answers are shown as text when a tutor tries an operation at /docs.
    attempt = recording.record(PICTURE, WRONG)
    page = visit(viewport=NARROW, bypass_csp=True).page
    recording.sign_in(page)
    page.goto(f"{recording.address}/docs")
    page.locator("#operations-attempts-getAttempt .opblock-summary-control").click()
    page.get_by_placeholder("attempt_id").fill(attempt)
    page.get_by_role("button", name="Execute").click()
    answer = page.locator(".live-responses-table")
    expect(answer).to_contain_text(PICTURE.replace('"', '\\"'))
    assert answer.locator("img, script").count() == 0
