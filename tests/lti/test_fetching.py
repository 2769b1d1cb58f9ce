"""The service fetches only data of limited size from public addresses."""

import gzip
import json
from collections.abc import Iterator
from http import HTTPStatus
from ipaddress import ip_address
from typing import Any

import pytest
from fastapi import FastAPI, Response

from service.lti.fetching import FetchError, fetch_json, is_public
from service.lti.registrations import unusable
from tests.lti.platform import running

PRIVATE = (
    "0.0.0.0", "10.0.0.1", "100.64.0.1", "127.0.0.1", "169.254.169.254", "172.16.0.1",
    "192.168.1.1", "224.0.0.1", "255.255.255.255", "::", "::1", "fe80::1", "fc00::1", "ff02::1",
    "::ffff:10.0.0.1", "64:ff9b::a00:1", "2002:a00:1::", "2001:0:a00:1::",
)  # fmt: skip


@pytest.fixture(scope="module")
def site() -> Iterator[str]:
    app = FastAPI()
    app.state.asked = []

    @app.get("/{name}")
    async def answer(name: str) -> Response:
        there = {"location": "/right"}
        away = {"location": "http://localhost:1/right"}
        answers: dict[str, Any] = {
            "right": Response('{"keys": []}'),
            "near": Response(None, HTTPStatus.FOUND, there),
            "away": Response(None, HTTPStatus.FOUND, away),
            "circle": Response(None, HTTPStatus.FOUND, {"location": "/circle"}),
            "large": Response(json.dumps("x" * 65_536)),
            "compressed": Response(gzip.compress(b"{}"), headers={"content-encoding": "gzip"}),
            "failed": Response("{}", HTTPStatus.INTERNAL_SERVER_ERROR),
            "nested": Response("[" * 60_000),
            "words": Response("no JSON"),
        }
        return answers[name]  # type: ignore[no-any-return]

    with running(app) as port:
        yield f"http://127.0.0.1:{port}"


def reason(url: str, *, local: bool = True) -> str:
    with pytest.raises(FetchError) as refused:
        fetch_json(url, local=local)
    return str(refused.value)


def test_only_public_addresses_are_fetched() -> None:
    assert [each for each in PRIVATE if is_public(ip_address(each))] == []
    assert is_public(ip_address("193.0.6.139"))
    for host in ("127.0.0.1", "localhost", "[::1]", "10.0.0.1", "169.254.169.254", "2130706433"):
        said = reason(f"https://{host}/jwks.json", local=False)
        assert said == "the host has a private address", host


def test_plain_http_is_for_this_machine_in_development(site: str) -> None:
    assert fetch_json(f"{site}/right", local=True) == {"keys": []}
    assert reason(f"{site}/right", local=False) == "the address must begin with https://"
    assert reason("http://10.0.0.1/right") == "the address must begin with https://"


def test_answers_are_bounded(site: str) -> None:
    assert fetch_json(f"{site}/near", local=True) == {"keys": []}
    told = {
        name: reason(f"{site}/{name}")
        for name in ("away", "circle", "large", "compressed", "failed", "nested", "words")
    }
    assert told == {
        "away": "the answer is a redirect to another host",
        "circle": "the answers are too many redirects",
        "large": "the answer is larger than 64 KiB",
        "compressed": "the answer is compressed",
        "failed": "the status is 500",
        "nested": "the answer is not JSON",
        "words": "the answer is not JSON",
    }


def test_unusable_addresses_are_refused() -> None:
    for address in (
        "javascript:alert(1)", "ftp://a.example/", "https://", "https://a b.example/",
        "https://user@a.example/", "https://a.example/#x", "https://a.example;script-src *",
        "https://a.example:port/", "http://a.example/", "http://localhost/",
    ):  # fmt: skip
        assert unusable(address), address
    assert not unusable("https://moodle.example.edu:8443/mod/lti/certs.php?x=1")
