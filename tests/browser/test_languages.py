"""Test the pages in other languages."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from urllib.request import Request, urlopen

import pytest
from dh_grader.web.pages import TOPICS
from playwright.sync_api import Page, expect

from tests.api.serving import served
from tests.browser.conftest import Origin
from tests.browser.fixtures import Visit
from tests.browser.steps import cells
from tests.browser.test_pages import violations
from tests.guards import ANSWER

# --- Every text of the pages is translatable, and longer texts fit on the screen

Opening = Callable[..., Visit]
# JavaScript: the visible texts, labels and titles with an English word and without an accent.
# Texts of exercise files and of reports, formulas and names are not translated here.
UNTOLD = """() => {
    const NAMES = "math, code, script, style, svg, noscript, .brand, .languages, " +
        "[part=statement], [part=title], [part=source], .prompt, .about header, .symbols dl, " +
        ".summary, .exercises h3, .words, .joints, .fold, caption, .messages p, .notes p, " +
        ".rail, [role=tablist]"
    const isUntold = (text) => /[A-Za-z]{3}/.test(text) && !/[áćéíñóśúýźÁĆÉÍÑÓŚÚÝŹ]/.test(text)
    const found = []
    const look = (root) => {
        for (const element of root.querySelectorAll("*")) {
            if (element.shadowRoot) look(element.shadowRoot)
            if (element.closest(NAMES) || !element.checkVisibility()) continue
            for (const node of element.childNodes) {
                if (node.nodeType === Node.TEXT_NODE && isUntold(node.data)) found.push(node.data)
            }
            for (const name of ["aria-label", "title", "placeholder", "alt"]) {
                const text = element.getAttribute(name)
                if (text && isUntold(text)) found.push(`${name}: ${text}`)
            }
        }
    }
    look(document.body)
    return found
}"""
OVERFLOW = "document.documentElement.scrollWidth - document.documentElement.clientWidth"


@pytest.fixture(scope="module")
def pseudo(tmp_path_factory: pytest.TempPathFactory, other_origin: Origin) -> Iterator[str]:
    folder = tmp_path_factory.mktemp("pseudo")
    variables = {"DH_GRADER_CORS_ORIGINS": other_origin.address}
    with served(folder, module="tests.translations.pseudo", **variables) as server:
        yield server.address


def fits(page: Page) -> None:
    for width in (390, 1280):
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate(OVERFLOW) <= 0, f"the page scrolls sideways at {width} px"


@pytest.mark.long
@pytest.mark.parametrize(
    "path",
    ["", "practice", "play", "learn", "learn-dh", "tutor/sign-in"]
    + [f"help/{topic}" for topic in TOPICS],
)
def test_a_page_is_told_and_fits(pseudo: str, visit: Opening, path: str) -> None:
    page = visit().page
    page.goto(f"{pseudo}/{path}?lang=qps")
    page.wait_for_load_state("networkidle")
    untold = page.evaluate(UNTOLD)
    assert untold == [], "\n".join(untold)
    fits(page)


@pytest.mark.long
def test_an_exercise_is_told_and_fits(pseudo: str, visit: Opening) -> None:
    page = visit().page
    page.goto(f"{pseudo}/exercises/planar-rr?lang=qps")
    cells(page).first.fill("7")
    page.locator("dh-exercise").locator(".check").click()
    expect(page.locator("dh-exercise .messages li").first).to_be_visible()
    untold = page.evaluate(UNTOLD)
    assert untold == [], "\n".join(untold)
    fits(page)


@pytest.mark.long
def test_the_switch_keeps_the_place_and_the_choice(pseudo: str, visit: Opening, axe: str) -> None:
    page = visit(bypass_csp=True).page
    page.add_init_script(axe)
    page.goto(f"{pseudo}/learn-dh?convention=modified#theta")
    page.locator(".languages summary").click()
    # There is no such language.
    assert [each for each in violations(page, "") if "valid-lang" not in each] == []
    page.get_by_role("link", name="Þśéúđó").click()
    expect(page.locator("html")).to_have_attribute("lang", "qps-Ploc")
    assert page.url.endswith("/learn-dh?convention=modified&lang=qps#theta")
    page.goto(f"{pseudo}/play")
    expect(page.locator("html")).to_have_attribute("lang", "qps-Ploc")


@pytest.mark.long
def test_an_element_on_another_site_takes_the_language_of_its_attribute(
    pseudo: str, visit: Opening, other_origin: Origin
) -> None:
    other_origin.pages["/course"] = (
        f'<html lang="en"><title>Course</title><script type="module" src="{pseudo}/embed.js">'
        '</script><dh-exercise exercise="planar-rr" locale="qps"></dh-exercise>'
    )
    page = visit().page
    with page.expect_request(f"{pseudo}/v1/exercises/planar-rr") as asked:
        page.goto(f"{other_origin.address}/course")
    expect(page.locator("dh-exercise .check")).to_contain_text("Ćhéćk")
    assert asked.value.headers["accept-language"] == "qps-Ploc"


# --- The course pages for lecturers are translatable, and longer texts fit on the screen

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
