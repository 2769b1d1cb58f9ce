"""Every response that depends on the reader's language says so in its headers."""

import asyncio
import json

import httpx
import pytest
from dh_grader.api.permissions import RIGHTS

from tests.api.test_scopes import Guarded
from tests.api.test_scopes import guarded as guarded

_WORDS = (" ist ", " nicht ", " Sie ", " kein", " der ", " die ", "Aufgabe", "Gelenk")


def is_german(answer: httpx.Response) -> bool:
    text = answer.text
    if answer.headers.get("content-type", "").endswith("json"):
        text = json.dumps(answer.json(), ensure_ascii=False)
    return any(word in text for word in _WORDS)


def says_so(answer: httpx.Response) -> bool:
    vary = answer.headers.get("vary", "")
    return answer.headers.get("content-language") == "de" and "Accept-Language" in vary


def silent(guarded: Guarded, credential: str, routes: set[str]) -> tuple[list[str], set[str]]:
    async def answers() -> dict[str, httpx.Response]:
        async with guarded.client(credential) as client:
            return {route: await guarded.send(client, route, "de") for route in sorted(routes)}

    german = {route: each for route, each in asyncio.run(answers()).items() if is_german(each)}
    return [route for route, each in german.items() if not says_so(each)], set(german)


@pytest.mark.long
@pytest.mark.parametrize(
    "route",
    ["GET /v1/courses/{course_id}/scores", "POST /v1/exercises/{exercise_id}/regrade"],
)
def test_a_list_of_scores_and_a_regrade_say_their_language(guarded: Guarded, route: str) -> None:
    async def answer() -> httpx.Response:
        async with guarded.client(guarded.credentials["tutor"][0]) as client:
            return await guarded.send(client, route, "de")

    answered = asyncio.run(answer())
    assert answered.status_code == 200
    assert says_so(answered)
    assert answered.headers["cache-control"] == "no-store"


@pytest.mark.long
def test_every_answer_in_a_language_says_so(guarded: Guarded) -> None:
    told = set()
    # These are not translated: the style sheets and scripts, and the document of the interface.
    routes = RIGHTS.keys() - {"GET /static/{name}", "GET /docs/{name}"}
    for credential in ("", *guarded.credentials["tutor"], *guarded.credentials["learner"]):
        found, german = silent(guarded, credential, routes)
        assert found == []
        told |= german
    assert len(told) > 60
