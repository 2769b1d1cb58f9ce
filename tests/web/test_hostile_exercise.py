"""Pages show the texts of a hostile exercise as plain text."""

import json
import re
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path

import pytest
from dh_grader.catalogue import load_catalogue

from tests.browser.hostile import BREAKOUT, HOSTILE_EXERCISE, PICTURE
from tests.web.tutor.test_tutor_routes import Tutor

PLAIN = re.sub(r"'''.*?'''", "'''plain'''", HOSTILE_EXERCISE, flags=re.DOTALL)
# The pages that show the title, and pages that should not show it.
SHOWN = ("/", "/exercises/hostile", "/tutor", "/tutor/solutions/hostile", "/tutor/class")
OTHERS = ("/tutor/editor?exercise=hostile", "/tutor/class/report", "/play")
FIGURES = ("/v1/exercises/hostile/figure.svg", "/tutor/solutions/hostile/frames.svg")
# Elements that statements (Markdown and MathML) may add, and elements that contain titles.
TEXT = {
    "p", "code", "span", "div", "math", "mrow", "mi", "mn", "mo", "mtext", "em", "strong", "br",
}  # fmt: skip
# Attributes whose text the browser neither loads nor runs.
WORDS = {"alt", "title", "aria-label", "content", "placeholder", "value", "data-mark"}


class Markup(HTMLParser):
    """The elements and the text of a page."""

    def __init__(self, page: str) -> None:
        super().__init__(convert_charrefs=True)
        self.elements: Counter[tuple[str, tuple[tuple[str, str | None], ...]]] = Counter()
        self.text = ""
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            assert not name.startswith("on")
            assert name in WORDS or not re.search(
                r"(?:javascript|data):", value or "", re.IGNORECASE
            )
        if tag not in TEXT:
            kept = ((name, value) for name, value in attrs if name not in WORDS)
            self.elements[tag, tuple(kept)] += 1

    def handle_data(self, data: str) -> None:
        self.text += data

    def handle_comment(self, data: str) -> None:
        pytest.fail(f"a comment: {data}")


def tutor_of(text: str, folder: Path) -> Tutor:
    folder.mkdir()
    (folder / "hostile.toml").write_text(text, encoding="utf-8")
    return Tutor(load_catalogue(folder), folder)


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> tuple[Tutor, Tutor]:
    # A service with the hostile exercise, and one with the same exercise in harmless words.
    folder = tmp_path_factory.mktemp("exercises")
    assert "stolen" not in PLAIN
    return tutor_of(HOSTILE_EXERCISE, folder / "hostile"), tutor_of(PLAIN, folder / "plain")


def bare(markup: Markup) -> Counter[str]:
    return Counter({f"{tag} {attributes}": n for (tag, attributes), n in markup.elements.items()})


@pytest.mark.parametrize("path", [*SHOWN, *OTHERS])
def test_a_page_has_the_same_elements_as_for_a_plain_exercise(
    both: tuple[Tutor, Tutor], path: str
) -> None:
    answers = [each.ask("GET", path) for each in both]
    assert [each.status_code for each in answers] == [200, 200]
    hostile, plain = (Markup(each.text) for each in answers)
    assert bare(hostile) == bare(plain)
    assert "script-src" in answers[0].headers["content-security-policy"]
    if path in SHOWN:
        assert f"Hostile {PICTURE} {BREAKOUT}" in hostile.text


@pytest.mark.long
def test_the_api_reference_does_not_contain_the_exercise(both: tuple[Tutor, Tutor]) -> None:
    for path in ("/docs", "/openapi.json"):
        hostile, plain = (each.ask("GET", path).content for each in both)
        assert hostile == plain


@pytest.mark.parametrize("path", FIGURES)
def test_a_figure_has_the_same_elements_as_a_plain_one(
    both: tuple[Tutor, Tutor], path: str
) -> None:
    hostile, plain = (ET.fromstring(each.ask("GET", path).content) for each in both)
    assert Counter(each.tag for each in hostile.iter()) == Counter(
        each.tag for each in plain.iter()
    )
    assert {name for each in hostile.iter() for name in each.attrib} == {
        name for each in plain.iter() for name in each.attrib
    }
    assert PICTURE in "".join(hostile.itertext())


def texts(value: object) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        yield from (text for each in value.values() for text in texts(each))
    elif isinstance(value, list):
        yield from (text for each in value for text in texts(each))


@pytest.mark.long
def test_the_html_in_json_has_no_hostile_elements(both: tuple[Tutor, Tutor]) -> None:
    check = {"id": "h", "text": HOSTILE_EXERCISE}
    for answer in (
        both[0].ask("GET", "/v1/exercises/hostile"),
        both[0].ask("GET", "/v1/exercises/hostile/solution"),
        both[0].ask("POST", "/tutor/check", json=check),
    ):
        assert answer.headers["content-type"] == "application/json"
        assert answer.headers["x-content-type-options"] == "nosniff"
        html = [text for text in texts(answer.json()) if text.startswith(("<p>", "<math", "<div"))]
        for text in html:
            assert Markup(text).elements == Counter()
    shown = json.dumps(both[0].ask("GET", "/v1/exercises/hostile").json())
    assert "<p>Read &lt;script&gt;" in shown
