"""Test the pages in languages other than English."""

import asyncio
import re
from collections.abc import Mapping
from dataclasses import replace

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.api.http import LANGUAGE_COOKIE
from dh_grader.catalogue import Exercise
from dh_grader.translations import LANGUAGES
from dh_grader.web import web_routes

from tests.translations.pseudo import PSEUDO, without_others

PAGES = (
    "/",
    "/exercises/scara",
    "/practice",
    "/play",
    "/learn",
    "/learn-dh",
    "/help/points",
    "/docs",
)
SWITCH = '<details class="languages">'


class Client:
    """Sends requests to an application in this process."""

    def __init__(self, catalogue: Mapping[str, Exercise]) -> None:
        self.app = application(catalogue, pages=web_routes(catalogue))

    def get(self, path: str, **headers: str) -> httpx.Response:
        return asyncio.run(self._get(path, headers))

    async def _get(self, path: str, headers: Mapping[str, str]) -> httpx.Response:
        transport = httpx.ASGITransport(self.app)
        async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
            return await client.get(path, headers=dict(headers))


@pytest.fixture
def client(catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch) -> Client:
    """Return a client of a service that offers a second language."""
    monkeypatch.setitem(LANGUAGES, PSEUDO.code, PSEUDO)
    return Client(catalogue)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("path", PAGES)
def test_with_one_language_there_is_no_switch(
    catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch, path: str
) -> None:
    without_others(monkeypatch)
    page = Client(catalogue).get(f"{path}?lang=qps")
    assert '<html lang="en">' in page.text
    assert SWITCH not in page.text
    assert "words-qps" not in page.text
    assert "set-cookie" not in page.headers


@pytest.mark.sampled(4)
@pytest.mark.parametrize("path", PAGES)
def test_a_page_is_told_in_the_language_of_its_reader(client: Client, path: str) -> None:
    page = client.get(path, **{"accept-language": "qps"})
    assert '<html lang="qps-Ploc">' in page.text
    assert page.headers["content-language"] == "qps-Ploc"
    assert {"Accept-Language", "Cookie"} <= set(page.headers["vary"].split(", "))
    assert "set-cookie" not in page.headers
    assert '<a href="?lang=en" lang="en" hreflang="en">English</a>' in page.text
    assert 'hreflang="qps-Ploc" aria-current="true"' in page.text
    assert "Éxéŕćíśéś" in page.text or "Éxérćíśéś" in page.text


def test_a_choice_is_kept_in_a_cookie(client: Client) -> None:
    chosen = client.get("/practice?lang=qps")
    assert '<html lang="qps-Ploc">' in chosen.text
    assert chosen.headers["set-cookie"].startswith(f"{LANGUAGE_COOKIE}=qps;")
    later = client.get("/", cookie=f"{LANGUAGE_COOKIE}=qps")
    assert '<html lang="qps-Ploc">' in later.text
    assert "set-cookie" not in later.headers
    back = client.get("/?lang=en", cookie=f"{LANGUAGE_COOKIE}=qps")
    assert '<html lang="en">' in back.text
    led = client.get("/?exercise=scara&lang=qps")
    assert led.headers["set-cookie"].startswith(f"{LANGUAGE_COOKIE}=qps;")


def test_a_problem_is_told_in_the_language_of_its_reader(client: Client) -> None:
    page = client.get("/nowhere?lang=qps", accept="text/html")
    assert page.status_code == 404
    assert '<html lang="qps-Ploc">' in page.text
    assert "Page not found" not in page.text
    assert {"Accept", "Accept-Language"} <= set(page.headers["vary"].split(", "))


def test_a_generated_robot_is_told_on_its_page_and_over_http(client: Client) -> None:
    name = "practice-2-standard~5"
    page = client.get(f"/exercises/{name}?lang=de").text
    shown = client.get(f"/v1/exercises/{name}?lang=de").json()
    for text in (
        "Übungsroboter 5, Stufe 2",
        "Von DH Grader erzeugt",
        "sind alle Gelenkvariablen 0",
    ):
        assert text in page
        assert text in shown["title"] + shown["source"] + shown["statement"]
    assert shown["parts"][0]["prompt"].startswith("Geben Sie die DH-Tabelle in der Standardkonv")
    assert "At home" not in page + shown["statement"]


def test_the_dictionary_of_the_scripts_is_preloaded(client: Client) -> None:
    page = client.get("/exercises/scara?lang=qps")
    [name] = re.findall(r'rel="modulepreload" href="\.\./static/(words-qps-\w+\.js)"', page.text)
    file = client.get(f"/static/{name}")
    assert file.headers["access-control-allow-origin"] == "*"
    assert "immutable" in file.headers["cache-control"]
    assert file.text.startswith("export default {")
    assert "words-qps" not in client.get("/exercises/scara").text


def test_values_in_sentences_of_templates_are_escaped(
    catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(LANGUAGES, PSEUDO.code, PSEUDO)
    hostile = replace(catalogue["scara"], title='<b>"T', source="<script>x</script>")
    client = Client({"scara": hostile})
    for language in ("en", "qps"):
        text = client.get(f"/exercises/scara?lang={language}").text
        assert "<b>" not in text.split("<main")[1].split("<div>")[0]
        assert "<script>" not in text
        assert "&lt;script&gt;" in text
