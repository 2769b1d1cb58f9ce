"""The course pages for lecturers are translatable, and longer texts fit on the screen."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.request import Request, urlopen

import pytest
from playwright.sync_api import expect

from tests.api.serving import served
from tests.browser.fixtures import Visit
from tests.browser.languages.test_pseudo_language import UNTOLD, fits
from tests.guards import ANSWER

# Names that others have given are not translated: titles of exercises, ids, learners.
NAMED = (
    ".statistics h3, tbody, option, bdi, .groups, .gradebook th, .exports, .exercises h2, "
    "textarea, #preview, #findings .verdict, .solution h2, .solution > .quiet, .aloud"
)
OWN = UNTOLD.replace('"math, code,', f'"math, code, time, {NAMED}, ')
# Ids, and the headings of a class list, which are those of the file.
GIVEN = {
    "robots",
    "homework-1",
    "Planar RR arm",
    "SCARA manipulator",
    "placeholder: id,name,email",
    "LaTeX",
}
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

        def post(path: str, body: object) -> Any:
            content = json.dumps(body).encode()
            headers = {"Content-Type": "application/json"}
            request = Request(f"{server.address}/v1/{path}", content, headers)
            with urlopen(request, timeout=ANSWER) as answer:
                assert answer.status in (200, 201)
                return json.load(answer)

        post("courses", {"id": "robots", "title": "Róbots", "zone": "Europe/Berlin"})
        post("courses/robots/learners", {"csv": "id,name\nu1,Ádá\n"})
        post("courses/robots/assignments", ASSIGNMENT)
        answers = {"table": "a1 0 0 θ1\na2 0 0 θ2\n0 0 d3 0\n0 0 d4 θ4"}
        body = {"learner": "u1", "answers": answers}
        attempt = post("exercises/planar-rr/attempts", body | {"answers": {"table": "7 0 0 θ1"}})
        post("exercises/scara/attempts", body)
        page = visit().page
        for path in (
            "tutor",
            "tutor/courses",
            "tutor/courses/robots",
            "tutor/courses/robots/assignments/homework-1",
            "tutor/courses/robots/gradebook",
            "tutor/courses/robots/learner?learner=u1",
            "tutor/class",
            "tutor/attempts",
            "tutor/attempts?course=robots&assignment=homework-1",
            f"tutor/attempts/{attempt['attempt']['id']}",
            "tutor/statistics/scara",
            "tutor/editor",
            "tutor/solutions/scara",
        ):
            page.goto(f"{server.address}/{path}{'&' if '?' in path else '?'}lang=qps")
            page.wait_for_load_state("networkidle")
            expect(page.locator("html")).to_have_attribute("lang", "qps-Ploc")
            for each in page.locator("details").all():
                each.evaluate("each => each.open = true")
            untold = page.evaluate(OWN)
            assert set(untold) <= GIVEN, f"{path}: {untold}"
            fits(page)
        page.goto(f"{server.address}/tutor/courses/robots/assignments/homework-1?lang=de")
        page.get_by_text("Löschen", exact=True).click()
        page.get_by_role("button", name="Übungsblatt homework-1 löschen").click()
        told = "Gelöscht wird: Übungsblatt homework-1 (1 Übungsblatt)"
        expect(page.get_by_text(told)).to_be_visible()
        page.get_by_role("button", name="Endgültig löschen").click()
        expect(page.get_by_text("Es gibt noch kein Übungsblatt.")).to_be_visible()
