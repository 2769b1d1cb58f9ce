"""Every text of the pages is translatable, and longer texts fit on the screen."""

from collections.abc import Callable, Iterator

import pytest
from dh_grader.web.pages import TOPICS
from playwright.sync_api import Page, expect

from tests.api.serving import served
from tests.browser.conftest import Origin
from tests.browser.fixtures import Visit
from tests.browser.steps import cells
from tests.browser.test_pages import violations

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
