"""The program reads the examples on the help pages as the pages say."""

import asyncio
import html
import re
from collections.abc import Mapping
from functools import cache

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.api.http import LANGUAGE_COOKIE
from dh_grader.catalogue import Exercise
from dh_grader.expressions import ExpressionError, read
from dh_grader.translations import ENGLISH, LANGUAGES, Language
from dh_grader.web import web_routes
from dh_grader.web.pages import TOPICS, help_page, load_assets

from tests.expressions.corpus_files import ROBOT
from tests.grading.support.submitting import full_marks, handed_in, part

# The exercise and the part for which the blocks of the page on pasting are.
PARTS = {
    "table": ("rrrp", "table"),
    "matrix": ("planar-rrr", "pose"),
    "links": ("planar-rrr-standard", "links"),
}


assets = cache(load_assets)


@cache
def shown(topic: str, language: Language = ENGLISH) -> str:
    return help_page(topic, assets(), language).decode()


def examples(kind: str) -> list[list[str]]:
    bodies = re.findall(
        rf'data-examples="{kind}">.*?<tbody>(.*?)</tbody>', shown("expressions"), re.DOTALL
    )
    return [
        [html.unescape(re.sub("<[^>]+>", "", cell)) for cell in re.findall("<td>(.*?)</td>", row)]
        for body in bodies
        for row in re.findall("<tr>(.*?)</tr>", body)
    ]


def test_a_text_is_read_as_the_page_says() -> None:
    rows = examples("read")
    assert len(rows) > 30
    for text, meaning in rows:
        expression = read(text, ROBOT)
        assert expression.text() == meaning
        assert {note.code for note in expression.notes} <= {"joint_marker"}, text


def test_a_text_is_read_with_a_note() -> None:
    rows = examples("noted")
    assert len(rows) > 5
    for text, meaning, _ in rows:
        expression = read(text, ROBOT)
        assert expression.text() == meaning
        assert expression.notes


def test_a_text_is_refused_with_the_shown_repair() -> None:
    rows = examples("refused")
    assert len(rows) > 10
    for text, _, repaired in rows:
        with pytest.raises(ExpressionError) as caught:
            read(text, ROBOT)
        assert (caught.value.suggestion or "") == repaired, text


def test_a_pasted_example_gets_full_marks(catalogue: Mapping[str, Exercise]) -> None:
    blocks = re.findall(r'<pre data-reads="(\w+)"><code>(.*?)</code>', shown("pasting"), re.DOTALL)
    assert len(blocks) == shown("pasting").count("<pre") > 5
    for kind, text in blocks:
        exercise, part_id = PARTS[kind]
        report = part(handed_in(catalogue[exercise], {part_id: html.unescape(text)}), part_id)
        assert full_marks(report), text


def test_the_worked_points_are_those_of_the_grader(catalogue: Mapping[str, Exercise]) -> None:
    page = re.sub("<[^>]+>", " ", shown("points"))
    rows = [
        {"a": "a1", "alpha": 0, "d": 0, "theta": "theta1"},
        {"a": "a2", "alpha": 0, "d": 0, "theta": "theta2"},
        {"a": 0, "alpha": 0, "d": "d3", "theta": 0},
        {"a": 0, "alpha": 0, "d": "a1", "theta": "theta4"},
    ]
    report = part(handed_in(catalogue["scara"], {"table": {"rows": rows}}), "table")
    assert f"8 − 2 · 1.75 = {report.points:g} points" in page
    most = [row.max_points for row in report.rows]
    assert most == [2, 3.75, 0.25, 2]
    for points in most:
        assert f"{points:g} " in page


@pytest.mark.parametrize("code", list(LANGUAGES))
@pytest.mark.parametrize("topic", TOPICS)
def test_a_page_in_each_language_has_the_same_examples(topic: str, code: str) -> None:
    page = shown(topic, LANGUAGES[code])
    blocks = r"<code>.*?</code>|<pre.*?</pre>"
    english, other = (
        sorted(set(re.findall(blocks, text, re.DOTALL))) for text in (shown(topic), page)
    )
    assert other == english
    assert page.count("<h2>") == shown(topic).count("<h2>")


def test_pages_lead_to_the_help(catalogue: Mapping[str, Exercise]) -> None:
    app = application(catalogue, pages=web_routes(catalogue))

    async def get(path: str) -> httpx.Response:
        transport = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
            return await client.get(path)

    first = asyncio.run(get("/help?lang=de"))
    assert first.headers["location"] == "help/expressions"
    assert f"{LANGUAGE_COOKIE}=de;" in first.headers["set-cookie"]
    assert 'href="../help/expressions">Help' in asyncio.run(get("/help/points")).text
    for topic, title in TOPICS.items():
        answer = asyncio.run(get(f"/help/{topic}"))
        assert f"<h1>{title}</h1>" in answer.text
