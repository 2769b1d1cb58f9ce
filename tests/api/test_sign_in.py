"""Tutors sign in with their API key and get a cookie."""

import asyncio
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any

import httpx
import jwt
import pytest
from dh_grader.access import OPEN_HERE, Scope, Secret, new_key_text
from dh_grader.access.keys import KeyRing, add_key, revoke_key
from dh_grader.api.application import application
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise
from dh_grader.store import AttemptStore
from dh_grader.store.database import in_transaction
from dh_grader.web import Tutoring, web_routes
from dh_grader.web.pages import own_path

SECRET = Secret("0123456789abcdef" * 4)
ADDRESS = "https://grader.example.edu"
READER = {"Accept": "text/html"}
OWN = {"Origin": ADDRESS, "Sec-Fetch-Site": "same-origin"}


class Browser:
    """A service with a tutor's key, and a client that keeps cookies as a browser does."""

    def __init__(self, store: AttemptStore, ring: KeyRing, app: Any) -> None:
        self.store, self.ring, self._app = store, ring, app
        self.cookies = httpx.Cookies()

    def key(self, *scopes: Scope, hours: float = 100) -> tuple[str, str]:
        text, now = new_key_text(), datetime.now(UTC)
        until = now + timedelta(hours=hours)
        made = in_transaction(
            self.store.engine,
            lambda it: add_key(it, "", SECRET.key_digest(text), scopes, None, now, until),
        )
        return text, made.id

    def ask(self, method: str, path: str, address: str = ADDRESS, **more: Any) -> httpx.Response:
        async def asked() -> httpx.Response:
            transport = httpx.ASGITransport(self._app)
            async with httpx.AsyncClient(
                transport=transport, base_url=address, cookies=self.cookies
            ) as client:
                answer = await client.request(method, path, **more)
                self.cookies = client.cookies
                return answer

        return asyncio.run(asked())

    def sign_in(self, key: str, following: str = "/tutor", **headers: str) -> httpx.Response:
        fields = {"key": key, "following": following}
        return self.ask("POST", "/tutor/sign-in", data=fields, headers={**OWN, **headers})

    def status(self, method: str = "GET", path: str = "/tutor", **headers: str) -> int:
        return self.ask(method, path, headers=headers).status_code


@pytest.fixture
def browser(catalogue: Mapping[str, Exercise], tmp_path: Path) -> Iterator[Browser]:
    store = AttemptStore.open(str(tmp_path / "attempts.db"))
    ring = KeyRing(store.engine, SECRET, seconds=0.01)
    access = Access(OPEN_HERE, solutions=None, read_attempts=None, keys=ring)
    pages = web_routes(catalogue, Tutoring(access, records=True))
    app = application(catalogue, access=access, store=store, pages=pages)
    store.start()
    yield Browser(store, ring, app)
    ring.close()
    store.close()


def test_a_tutor_signs_in_once_and_out_again(browser: Browser) -> None:
    key, _ = browser.key(Scope.TUTOR)
    asked = browser.ask("GET", "/tutor/attempts?exercise=scara", headers=READER)
    assert (asked.status_code, asked.headers.get("WWW-Authenticate")) == (303, None)
    form = asked.headers["Location"]
    assert form == "../tutor/sign-in?following=%2Ftutor%2Fattempts%3Fexercise%3Dscara"
    assert 'value="/tutor/attempts?exercise=scara"' in browser.ask("GET", form[2:]).text
    assert browser.sign_in("dhg_wrong").status_code == 403
    begun = browser.sign_in(key, "/tutor/attempts?exercise=scara")
    assert (begun.status_code, begun.headers["Location"]) == (
        303,
        "../tutor/attempts?exercise=scara",
    )
    words = {each.strip() for each in begun.headers["Set-Cookie"].split(";")}
    assert {"HttpOnly", "Secure", "Path=/", "SameSite=lax", "Max-Age=36000"} <= words
    assert begun.headers["Set-Cookie"].startswith("__Host-dh-grader=")
    assert key not in begun.headers["Set-Cookie"]
    page = browser.ask("GET", "/tutor", headers=READER)
    assert (page.status_code, "Sign out" in page.text) == (200, True)
    assert browser.status("GET", "/v1/attempts") == 200
    assert browser.status("POST", "/tutor/sign-out", **OWN) == 303
    assert browser.status("GET", "/v1/attempts") == 401


def test_only_pages_of_the_service_use_a_session(browser: Browser) -> None:
    key, _ = browser.key(*Scope)
    path = "/v1/learners/forget"
    assert browser.sign_in(key, **{"Sec-Fetch-Site": "cross-site"}).status_code == 403
    assert browser.status() == 401
    browser.sign_in(key)
    body = {"learner": "ada"}
    for headers, status in [
        (OWN, 200),
        ({"Origin": "https://evil.example", "Sec-Fetch-Site": "cross-site"}, 401),
        # Another service on the same host: browsers send it the cookie.
        ({"Origin": "https://course.example.edu", "Sec-Fetch-Site": "same-site"}, 401),
        ({"Origin": "https://course.example.edu"}, 401),
    ]:
        assert browser.ask("POST", path, json=body, headers=headers).status_code == status
        minted = browser.ask("POST", "/v1/tokens", json=body, headers=headers)
        assert minted.status_code == {200: 201}.get(status, status)
    # A link on another page opens a page, but no other page signs the tutor out.
    link = {"Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"}
    assert browser.status(**{"Sec-Fetch-Site": "cross-site"}, **link) == 200
    assert browser.status("POST", "/tutor/sign-out", Origin="https://evil.example") == 303
    assert browser.status() == 200


def test_a_session_ends_with_its_key_and_in_time(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    key, key_id = browser.key(Scope.TUTOR)
    browser.sign_in(key)
    name, text = next(iter(browser.cookies.items()))
    now = datetime.now(UTC)
    [early, late] = [session_of(key_id, now + timedelta(seconds=seconds)) for seconds in (-1, 1000)]
    forged = jwt.encode({"iss": "dh-grader session", "key": key_id, "exp": 9**12}, b"x" * 32)
    token = jwt.encode(
        {"iss": "dh-grader session", "key": key_id, "exp": 9**12}, SECRET.token_secret
    )
    for session, status in ((text, 200), (late, 200), (early, 401), (forged, 401), (token, 401)):
        browser.cookies = httpx.Cookies({name: session})
        assert browser.status() == status
        # Nobody is refused what is free, only because a session has ended.
        assert browser.status("GET", "/") == 200
    in_transaction(browser.store.engine, partial(revoke_key, key_id=key_id, now=now))
    browser.cookies = httpx.Cookies({name: text})
    while browser.status() == 200:  # the key is memoized for a moment
        continue
    assert browser.status() == 401


def test_over_https_only_the_secure_cookie_counts(browser: Browser) -> None:
    key, _ = browser.key(Scope.TUTOR)
    browser.sign_in(key)
    [(name, text)] = browser.cookies.items()
    plain, secure = {"dh-grader": text}, {name: text}
    http = ADDRESS.replace("https:", "http:")
    for address, cookies, headers, status in [
        (ADDRESS, secure, {}, 200),
        (ADDRESS, plain, {}, 401),
        (ADDRESS, {**plain, "__Host-dh-grader": "x"}, {}, 401),
        (http, plain, {}, 200),
        # The proxy has not said that the browser uses HTTPS, but the browser has.
        (http, secure, {}, 200),
        (http, plain, {"Origin": ADDRESS, "Sec-Fetch-Site": "same-origin"}, 401),
        (http, secure, {"Origin": ADDRESS, "Sec-Fetch-Site": "same-origin"}, 200),
    ]:
        cookie = "; ".join(f"{name}={value}" for name, value in cookies.items())
        browser.cookies = httpx.Cookies()
        answer = browser.ask("GET", "/tutor", address, headers={**headers, "Cookie": cookie})
        assert answer.status_code == status, (address, cookies, headers)


def session_of(key_id: str, until: datetime) -> str:
    claims = {"iss": "dh-grader session", "key": key_id, "exp": int(until.timestamp())}
    return jwt.encode(claims, SECRET.session_secret)


def test_only_tutors_sign_in(browser: Browser) -> None:
    for scopes, hours, said in [
        ((Scope.RECORD,), 1, "not a tutor"),
        ((Scope.TUTOR,), -1, "has expired"),
    ]:
        key, _ = browser.key(*scopes, hours=hours)
        refused = browser.sign_in(key)
        assert (refused.status_code, said in refused.text) == (403, True)
        assert "Set-Cookie" not in refused.headers
        assert key not in refused.text


@pytest.mark.parametrize(
    "path",
    [
        "//evil.example", "https://evil.example", "/\\evil.example", "/tutor\\..\\..\\x",
        "/tutor@evil.example", "/tutor/../../x", "/tutorials", "/", "", "/tutor/\r\nX: y",
        "/tutor/" + "x" * 5000, "javascript:alert(1)",
    ],
)  # fmt: skip
def test_the_way_back_is_to_a_page_of_tutors(path: str) -> None:
    assert own_path(path) == "/tutor"
    assert own_path("/tutor/%2e%2e/x") == "/tutor"
    assert own_path("/tutor/courses/robots?x=1") == "/tutor/courses/robots?x=1"
