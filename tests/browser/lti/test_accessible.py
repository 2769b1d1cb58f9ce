"""The LTI pages are accessible in light, dark and forced colours."""

import time
from datetime import UTC, datetime, timedelta
from typing import Any

import httpx
import pytest
from dh_grader.access import Scope, Secret, new_key_text
from dh_grader.access.keys import add_key
from dh_grader.store.database import in_transaction, open_database
from playwright.sync_api import Frame, Page, expect

from tests.browser.lti.conftest import SECRET, Course
from tests.browser.test_pages import violations
from tests.guards import ANSWER
from tests.lti.platform import LTI, deep_linking

NOW = datetime.now(UTC)
# The styles that axe-core sets for a moment are against the policy of the pages.
checked = pytest.mark.parametrize("course", ["bypass_csp"], indirect=True)


def without_exercises(claims: dict[str, Any]) -> None:
    claims[f"{LTI}custom"] = {}


def framed(page: Page, text: str) -> Frame:
    """Return the frame of the service as soon as it shows this text."""
    # The frame moves to another process while it opens. A locator that began in the old process may
    # wait for ever, so this function polls the frames.
    while True:
        for each in page.frames:
            if each.name == "tool" and each.get_by_text(text).first.is_visible():
                return each
        page.wait_for_timeout(100)


@pytest.mark.long
@checked
def test_the_pages_in_frames_are_accessible(course: Course, axe: str) -> None:
    course.context.add_init_script(axe)
    platform, return_address = course.platform, f"{course.platform.address}/return"
    found = []
    for user, link, habits, text in (
        ("ada", "link-1", [], "Planar RR arm"),
        ("turing", "link-1", [], "What your students get"),
        ("preview", "link-1", [], "This is a preview"),
        ("parent", "link-1", [], "Only the students and teachers"),
        ("ada", "link-2", [without_exercises], "has not chosen exercises"),
        ("turing", "link-2", [without_exercises], "Your students see these exercises"),
        ("turing", "link-1", [deep_linking(return_address)], "Your course gets a link"),
        ("ada", "link-1", [lambda claims: claims.update(aud="x")], "could not be opened"),
    ):
        platform.habits[:] = habits
        page = course.opened(user, link)
        found += [f"{user} {link}: {each}" for each in violations(framed(page, text), "")]
        page.close()
    platform.storage = False
    page = course.opened("ada")
    found += violations(framed(page, "In a window of its own"), "")
    assert found == []
    # The refused launch was answered with 403.
    [complaint] = course.complaints
    assert "403" in complaint
    course.complaints.clear()


@pytest.mark.long
@checked
def test_the_report_on_a_file_is_accessible(course: Course, axe: str) -> None:
    course.context.add_init_script(axe)
    platform = course.platform
    platform.gradebook.own_keys = lambda: httpx.get(f"{platform.tool}/lti/jwks.json").json()
    platform.files.files["table.csv"] = b"a,alpha,d,theta\na1,0,0,q1\na1,0,0,q2\n"
    notice = platform.signed(platform.files.notice("table.csv"))
    sent = httpx.post(f"{platform.tool}/lti/notices", json={"notices": [{"jwt": notice}]})
    assert sent.status_code == 200
    until = time.monotonic() + ANSWER
    while not platform.files.reports:
        assert time.monotonic() < until, "no report arrives"
        time.sleep(0.05)

    def report(claims: dict[str, Any]) -> None:
        claims[f"{LTI}message_type"] = "LtiReportReviewRequest"
        claims[f"{LTI}submission"] = {"id": "submission of ada"}
        claims[f"{LTI}asset"] = {"id": "id of table.csv"}

    def settings(claims: dict[str, Any]) -> None:
        claims[f"{LTI}message_type"] = "LtiAssetProcessorSettingsRequest"

    for user, habit, text in (
        ("ada", report, "table.csv"),
        ("turing", report, "table.csv"),
        ("turing", settings, "Files of students"),
    ):
        platform.habits[:] = [habit]
        page = course.opened(user)
        frame = framed(page, text)
        # The page has its own styles: its policy allows them.
        assert frame.evaluate("getComputedStyle(document.body).margin") != "8px"
        # axe-core does not see that a header in MathML has a content.
        found = [x for x in violations(frame, "") if "empty-table-header" not in x]
        assert found == []
        page.close()


@pytest.mark.long
@checked
def test_the_pages_of_admins_are_accessible(course: Course, axe: str) -> None:
    text, until = new_key_text(), NOW + timedelta(days=1)
    digest = Secret(SECRET).key_digest(text)
    engine = open_database(course.database)
    in_transaction(engine, lambda it: add_key(it, "", digest, [Scope.TUTOR], None, NOW, until))
    engine.dispose()
    course.context.add_init_script(axe)
    tool = course.platform.tool
    page = course.context.new_page()
    # The service may not have noticed yet that it has a key: then none is needed.
    page.set_extra_http_headers({"authorization": f"Bearer {text}"})
    page.goto(f"{tool}/tutor")
    page.get_by_role("link", name="Learning platforms").click()
    expect(page.get_by_role("heading", name="Moodle of the university")).to_be_visible()
    assert violations(page, "") == []
    page.get_by_role("button", name="Test").click()
    expect(page.get_by_text("Keys of the platform: 1 of 1")).to_be_visible()
    assert violations(page, "") == []
    page.set_viewport_size({"width": 320, "height": 700})
    assert violations(page, "") == []
    assert page.evaluate("document.documentElement.scrollWidth") <= 320
