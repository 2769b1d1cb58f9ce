"""The pages on which lecturers run a course, in the pseudo-language: told, and narrow enough."""

import json
from collections.abc import Callable
from pathlib import Path
from urllib.request import Request, urlopen

import pytest
from playwright.sync_api import expect

from tests.api.serving import served
from tests.browser.fixtures import Visit
from tests.browser.languages.test_pseudo_language import UNTOLD, fits
from tests.guards import ANSWER

# Names that others have given are not translated: titles of exercises, ids, learners.
OWN = UNTOLD.replace(
    '"math, code,',
    '"math, code, tbody, option, bdi, .groups, .gradebook th, .exports, .exercises h2, ',
)
ASSIGNMENT = {
    "id": "homework-1",
    "title": "Hómework",
    "exercises": [{"exercise": "scara", "points": 8}],
    "due": "2030-01-01T00:00",
    "closes": "2030-02-01T00:00",
}


@pytest.mark.long
def test_the_pages_of_a_course_are_told(visit: Callable[..., Visit], tmp_path: Path) -> None:
    database = {"DH_GRADER_DATABASE": str(tmp_path / "attempts.db")}
    with served(tmp_path, module="tests.translations.pseudo", **database) as server:

        def post(path: str, body: object) -> None:
            content = json.dumps(body).encode()
            headers = {"Content-Type": "application/json"}
            request = Request(f"{server.address}/v1/{path}", content, headers)
            with urlopen(request, timeout=ANSWER) as answer:
                assert answer.status in (200, 201)

        post("courses", {"id": "robots", "title": "Róbots", "zone": "Europe/Berlin"})
        post("courses/robots/learners", {"csv": "id,name\nu1,Ádá\n"})
        post("courses/robots/assignments", ASSIGNMENT)
        page = visit().page
        for path in (
            "tutor",
            "tutor/courses",
            "tutor/courses/robots",
            "tutor/courses/robots/assignments/homework-1",
            "tutor/courses/robots/gradebook",
            "tutor/courses/robots/learner?learner=u1",
            "tutor/class",
        ):
            page.goto(f"{server.address}/{path}{'&' if '?' in path else '?'}lang=qps")
            page.wait_for_load_state("networkidle")
            expect(page.locator("html")).to_have_attribute("lang", "qps-Ploc")
            for each in page.locator("details").all():
                each.evaluate("each => each.open = true")
            untold = page.evaluate(OWN)
            # The headings of a class list are those of the file.
            assert set(untold) <= {"placeholder: id,name,email"}, f"{path}: {untold}"
            fits(page)
        page.goto(f"{server.address}/tutor/courses/robots/assignments/homework-1?lang=de")
        page.get_by_text("Löschen", exact=True).click()
        page.get_by_role("button", name="Übungsblatt homework-1 löschen").click()
        told = "Gelöscht wird: Übungsblatt homework-1 (1 Übungsblatt)"
        expect(page.get_by_text(told)).to_be_visible()
        page.get_by_role("button", name="Endgültig löschen").click()
        expect(page.get_by_text("Es gibt noch kein Übungsblatt.")).to_be_visible()
