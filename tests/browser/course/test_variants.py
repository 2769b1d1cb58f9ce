"""A tutor gives each learner a personal variant of an exercise."""

from collections.abc import Callable
from pathlib import Path

import pytest
from dh_grader.client import GraderClient
from dh_grader.contract.courses import LearnersRequest, LinksRequest, NewAssignment, NewCourse
from playwright.sync_api import expect

from tests.api.serving import served
from tests.browser.course.test_lecturer import SECRET, administrator
from tests.browser.fixtures import Visit
from tests.browser.test_pages import violations

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
