"""Only a request from the server's own machine has a tutor's rights."""

import asyncio
from typing import Any

import httpx
import pytest
from fastapi import FastAPI, Request

from service.api.permissions.access import Access

PROGRAM = {"host": "127.0.0.1:8000"}


def answered(
    solutions: bool | None,
    headers: dict[str, str],
    *,
    client: str = "127.0.0.1",
    server: str = "127.0.0.1",
    http_version: str = "1.1",
) -> bool:
    app = FastAPI()
    access = Access(solutions=solutions)

    async def as_spoken(scope: Any, receive: Any, send: Any) -> None:
        await app({**scope, "http_version": http_version}, receive, send)

    @app.get("/")
    def asked(request: Request) -> bool:
        return access.shows_solutions(request)

    async def ask() -> bool:
        transport = httpx.ASGITransport(as_spoken, client=(client, 40000))
        host = f"[{server}]" if ":" in server else server
        async with httpx.AsyncClient(transport=transport, base_url=f"http://{host}:8000") as asking:
            return bool((await asking.get("/", headers=headers)).json())

    return asyncio.run(ask())


@pytest.mark.parametrize("host", ["127.0.0.1:8000", "localhost:8000", "[::1]:8000", "LOCALHOST"])
def test_a_browser_at_the_machine_is_a_tutor_s(host: str) -> None:
    assert answered(None, {"host": host})
    assert answered(None, {"host": host, "origin": f"http://{host}"})
    assert answered(None, {"host": host}, client="::1", server="::1")
    # A browser that shows a page of the service, or whose user has typed the address.
    for site in ("same-origin", "none"):
        assert answered(None, {"host": host, "sec-fetch-site": site})
    own = {"origin": f"http://{host}", "sec-fetch-site": "same-origin", "sec-fetch-mode": "cors"}
    assert answered(None, {"host": host, **own})
    # A link on another page, which does not see the answer.
    link = {"sec-fetch-mode": "navigate", "sec-fetch-dest": "document"}
    for site in ("cross-site", "same-site"):
        assert answered(None, {"host": host, "sec-fetch-site": site, **link})


@pytest.mark.parametrize(
    ("headers", "ends"),
    [
        ({"host": "10.0.0.7:8000"}, {"client": "10.0.0.9", "server": "10.0.0.7"}),
        (PROGRAM, {"client": "10.0.0.9"}),  # a proxy that the server trusts
        (PROGRAM, {"server": "10.0.0.7"}),  # from the machine to an address that others can reach
        ({"host": "grader.example.edu"}, {}),  # nginx as in docs/deployment.md, or DNS rebinding
        ({"host": "localhost.example.edu"}, {}),
        ({"host": "[::1"}, {}),
        ({"host": ""}, {}),
        ({**PROGRAM, "x-forwarded-for": "127.0.0.1"}, {}),
        ({**PROGRAM, "forwarded": "for=127.0.0.1"}, {}),
        ({**PROGRAM, "via": "1.1 proxy"}, {}),
        ({**PROGRAM, "x-forwarded-proto": "https"}, {}),
        ({**PROGRAM, "cf-connecting-ip": "10.0.0.7"}, {}),
        (PROGRAM, {"http_version": "1.0"}),  # an unconfigured nginx
        ({**PROGRAM, "origin": "https://course.example.edu"}, {}),
        ({**PROGRAM, "origin": "http://127.0.0.1:9000"}, {}),
        ({**PROGRAM, "origin": "null"}, {}),
        # The same name with another scheme is another origin.
        ({**PROGRAM, "origin": "https://127.0.0.1:8000"}, {}),
        ({**PROGRAM, "origin": "chrome-extension://127.0.0.1:8000"}, {}),
        # A picture, script, frame or form of another page or of another port of this machine.
        *(
            ({**PROGRAM, "sec-fetch-site": site, **how}, {})
            for site in ("cross-site", "same-site", "unheard-of", "")
            for how in (
                {},
                {"sec-fetch-mode": "no-cors", "sec-fetch-dest": "image"},
                {"sec-fetch-mode": "no-cors", "sec-fetch-dest": "script"},
                {"sec-fetch-mode": "navigate", "sec-fetch-dest": "iframe"},
                {"sec-fetch-mode": "cors", "origin": "http://127.0.0.1:8000"},
            )
        ),
    ],
)
def test_no_other_request_is_a_tutor_s(headers: dict[str, str], ends: dict[str, str]) -> None:
    assert not answered(None, headers, **ends)


def test_the_setting_decides_if_it_is_set() -> None:
    far = {"client": "10.0.0.9", "server": "10.0.0.7"}
    assert answered(True, {"host": "grader.example.edu"}, **far)
    assert not answered(False, PROGRAM)
    # A page of another origin cannot use a tutor's browser.
    assert not answered(True, {**PROGRAM, "origin": "https://course.example.edu"})
    assert not answered(True, {**PROGRAM, "sec-fetch-site": "cross-site"})
    # A proxy ends TLS and does not say so, but the browser does.
    name = {"host": "grader.example.edu", "origin": "https://grader.example.edu"}
    assert answered(True, {**name, "sec-fetch-site": "same-origin"}, **far)
    assert not answered(True, name, **far)
