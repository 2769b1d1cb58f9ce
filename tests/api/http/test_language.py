"""Choose the language of a response."""

import pytest
from dh_grader.api.http import LANGUAGE_COOKIE, keep_language, language_of
from dh_grader.translations import ENGLISH, LANGUAGES
from starlette.requests import Request
from starlette.responses import Response

from tests.translations.pseudo import PSEUDO


@pytest.fixture(autouse=True)
def _offered(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(LANGUAGES, PSEUDO.code, PSEUDO)


def request(query: str = "", cookie: str = "", accepted: str = "", root: str = "") -> Request:
    headers = [(b"host", b"service")]
    if cookie:
        headers.append((b"cookie", f"{LANGUAGE_COOKIE}={cookie}".encode()))
    if accepted:
        headers.append((b"accept-language", accepted.encode()))
    return Request({
        "type": "http", "method": "GET", "scheme": "http", "path": "/", "root_path": root,
        "query_string": query.encode(), "headers": headers, "server": ("service", 80),
    })  # fmt: skip


def test_the_query_decides_before_the_cookie_and_the_cookie_before_the_header() -> None:
    assert language_of(request("lang=qps", "en", "en")) is PSEUDO
    assert language_of(request("", "qps", "en")) is PSEUDO
    assert language_of(request("", "", "tlh, qps;q=0.5")) is PSEUDO
    assert language_of(request("lang=en", "qps", "qps")) is ENGLISH
    assert language_of(request("", "en", "qps")) is ENGLISH
    assert language_of(request()) is ENGLISH


def test_an_unknown_language_decides_nothing() -> None:
    assert language_of(request("lang=tlh", "qps")) is PSEUDO
    assert language_of(request("lang=", "%0d%0a", "qps")) is PSEUDO


def test_the_language_on_a_platform_comes_after_the_cookie() -> None:
    assert language_of(request(accepted="en"), "qps-Ploc") is PSEUDO
    assert language_of(request(cookie="en"), "qps") is ENGLISH
    assert language_of(request(accepted="qps"), "") is PSEUDO


def test_only_a_choice_by_the_query_is_kept() -> None:
    answer = Response()
    keep_language(request("", "qps", "qps"), answer)
    keep_language(request("lang=tlh"), answer)
    assert "set-cookie" not in answer.headers
    keep_language(request("lang=qps", root="/grader"), answer)
    [cookie] = answer.headers.getlist("set-cookie")
    assert cookie.startswith(f"{LANGUAGE_COOKIE}=qps;")
    for attribute in ("HttpOnly", "Max-Age=31536000", "Path=/grader", "SameSite=lax"):
        assert attribute in cookie
