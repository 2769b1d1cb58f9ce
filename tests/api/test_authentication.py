"""Test keys and tokens in requests, and the sign-in."""

import asyncio
import base64
import math
import threading
from collections.abc import Iterator, Mapping
from contextlib import nullcontext
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any

import httpx
import jwt
import pytest
from dh_grader.access import NOBODY, OPEN_HERE, Caller, Scope, Secret, new_key_text
from dh_grader.access.key_ring import KeyRing, add_key, revoke_key
from dh_grader.access.rates import Rates
from dh_grader.api.application import application
from dh_grader.api.http import CLIENT, Client, ProblemError
from dh_grader.api.permissions import (
    IDENTITY,
    Access,
    AuthenticationMiddleware,
    Identity,
    count_submissions,
)
from dh_grader.catalogue import Exercise
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import in_transaction, open_database
from dh_grader.web import Tutoring, web_routes
from dh_grader.web.pages import own_path
from fastapi import Request
from starlette.routing import Route

from tests.access.kept_services import SECRET
from tests.together import together

# --- Test what the authentication tells the layers behind it, and which requests it counts


class Served:
    """A middleware with keys, before an application that notes the requests that it gets."""

    def __init__(self, database: Path) -> None:
        self.engine = open_database(str(database))
        self.credentials = {each.value: self._key(each) for each in Scope} | {"": ""}
        self.ring = KeyRing(self.engine, SECRET)
        self.scopes: list[Any] = []
        self.access = Access(solutions=None, read_attempts=None, keys=self.ring)

    def _key(self, scope: Scope) -> str:
        key, now = new_key_text(), datetime.now(UTC)
        digest, until = SECRET.key_digest(key), now + timedelta(days=1)
        in_transaction(self.engine, lambda it: add_key(it, "", digest, {scope}, None, now, until))
        return key

    def token(self) -> str:
        """Return a token of the key that may record."""
        [holder] = self.callers("record")
        learner = Caller(holder.scopes, None, "ada", holder.key_id)
        return self.ring.token(learner, datetime.now(UTC) + timedelta(hours=1))

    def callers(self, *names: str) -> list[Caller]:
        async def ask() -> list[Caller]:
            return [await self.ring.caller(self.credentials[each]) for each in names]

        return asyncio.run(ask())

    def ask(self, rates: Rates | None, path: str, credential: str = "", **more: Any) -> list[Any]:
        """Return what the client gets."""
        sent: list[Any] = []

        async def app(scope: Any, receive: Any, send: Any) -> None:
            self.scopes.append(scope)
            await send("answered")

        async def send(message: Any) -> None:
            sent.append(message)

        headers = [(b"authorization", f"Bearer {credential}".encode())] if credential else []
        scope = {
            "type": "http", "method": "GET", "scheme": "http", "path": path, "query_string": b"",
            "headers": headers, "client": ("10.0.0.1", 1), "server": ("127.0.0.1", 8000), **more,
        }  # fmt: skip
        asyncio.run(AuthenticationMiddleware(app, self.access, rates)(scope, None, send))  # type: ignore[arg-type]
        return sent

    def is_answered(self, *given: Any, **more: Any) -> bool:
        return self.ask(*given, **more) == ["answered"]


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    served = Served(tmp_path_factory.mktemp("authentication") / "keys.db")
    yield served
    served.ring.close()
    served.engine.dispose()


def test_students_share_less_of_the_processor_than_course_sites(served: Served) -> None:
    [grade, record, tutor] = served.callers("grade", "record", "tutor")
    expected = {
        # A key that may record is that of a course site, which acts for many students.
        served.credentials["grade"]: Client(grade.owner, 8.0),
        served.credentials["tutor"]: Client(tutor.owner, 8.0),
        served.credentials["record"]: Client(record.owner, math.inf),
        # Without a key, the client is the address.
        "": None,
    }
    for credential, client in expected.items():
        assert served.is_answered(None, "/v1/grade", credential)
        assert served.scopes[-1].get(CLIENT) == client
    assert served.is_answered(None, "/v1/grade", served.token())
    learner = served.scopes[-1][CLIENT]
    assert learner.most_shares == 1.0
    assert learner.name not in ("", record.owner)


def basic(password: str | bytes) -> str:
    given = password.encode() if isinstance(password, str) else password
    return "Basic " + base64.b64encode(b"anybody:" + given).decode()


def test_the_key_is_a_bearer_token_or_the_password_of_a_browser(served: Served) -> None:
    key = served.credentials["record"]
    [caller] = served.callers("record")
    known, in_browser = Identity(caller, by_key=True), Identity(caller, True, in_browser=True)
    nobody = Identity(NOBODY, by_key=True)
    expected = {
        "": nobody, f"Bearer {key}": known, f"bearer  {key} ": known, f"BEARER {key}": known,
        basic(key): in_browser, basic(key).replace("Basic", "basic"): in_browser,
        # These are not for this service.
        basic("secret"): nobody, basic(key).replace(" ", " !"): nobody,
        basic(b"\xff"): nobody, f"Basic {key}": nobody, "Basic": nobody,
        f"Digest {key}": nobody, key: nobody, "Bearer": nobody, "Bearer  ": nobody,
    }  # fmt: skip
    for header, identity in expected.items():
        assert served.is_answered(None, "/v1/grade", headers=[(b"authorization", header.encode())])
        assert served.scopes[-1][IDENTITY] == identity, header
        # Nobody has signed in, so no page shows a button to sign out.
        is_signed_in = served.access.is_signed_in(Request(served.scopes[-1]))
        assert is_signed_in is identity.in_browser, header


def test_until_the_first_key_everybody_may_record_and_nothing_is_shown(tmp_path: Path) -> None:
    engine = open_database(str(tmp_path / "keys.db"))
    ring = KeyRing(engine, SECRET)
    here = {"server": ("127.0.0.1", 8000), "client": ("127.0.0.1", 1), "http_version": "1.1"}
    headers = [(b"host", b"127.0.0.1"), (b"authorization", b"Bearer of a proxy")]
    scope = {"type": "http", "scheme": "http", "method": "GET", "headers": headers, **here}
    access = Access(keys=ring)
    everybody = Caller(frozenset({Scope.GRADE, Scope.RECORD}))
    identity = asyncio.run(access.identify(scope))
    assert identity == Identity(everybody)
    for path in ("/v1/attempts", "/tutor"):
        request = Request({**scope, IDENTITY: identity, "route": Route(path, print)})
        # The operator has to allow it, also on the machine itself.
        with pytest.raises(ProblemError, match="does not show them"):
            asyncio.run(access.permit(request))
        asyncio.run(Access(solutions=None, read_attempts=None, keys=ring).permit(request))
    ring.expect_keys()
    assert asyncio.run(access.identify(scope)).caller == NOBODY
    ring.close()
    engine.dispose()


def test_a_key_that_cannot_be_checked_gives_no_rights(
    served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    served.callers("record")

    def outcome(credential: str) -> tuple[Identity, str]:
        assert served.is_answered(None, "/v1/grade", credential)
        found: Identity = served.scopes[-1][IDENTITY]
        assert found.refusal is not None
        return replace(found, refusal=None), f"{found.refusal.status} {found.refusal.name}"

    nobody = Identity(NOBODY, by_key=True)
    assert outcome("dhg_x") == outcome(new_key_text()) == (nobody, "401 key-not-valid")
    monkeypatch.setattr("dh_grader.access.key_ring.MAX_WAITING", 0)
    assert outcome(new_key_text()) == (nobody, "503 busy")
    monkeypatch.undo()
    # The database does not answer.
    monkeypatch.setattr("dh_grader.access.key_ring.TIMEOUT", 0.0)
    assert outcome(new_key_text()) == (nobody, "503 store-down")


def test_only_a_session_or_a_password_is_a_browser_s(served: Served) -> None:
    [caller] = served.callers("tutor")
    now = datetime.now(UTC)
    valid, expired = (served.ring.session(caller, now + timedelta(hours=n)) for n in (1, -1))
    record = served.credentials["record"].encode()

    def identity(session: str, *more: tuple[bytes, bytes]) -> Identity:
        headers = [(b"cookie", f"dh-grader={session}".encode()), *more]
        assert served.is_answered(None, "/tutor", headers=headers)
        found: Identity = served.scopes[-1][IDENTITY]
        return found

    assert identity(valid) == Identity(caller, by_key=True, in_browser=True)
    # A session that has ended is that of nobody, and no error.
    assert identity(expired) == identity("x") == Identity(NOBODY, by_key=True)
    # A key comes first.
    [recorder] = served.callers("record")
    found = identity(valid, (b"authorization", b"Bearer " + record))
    assert found == Identity(recorder, by_key=True)


@together(
    ("credential", "route", "refused"),
    [
        ("", "GET /v1/exercises", ""),
        ("", "POST /v1/grade", "This needs a key."),
        ("", "POST /v1/tokens", "This needs a key."),
        ("", "GET /v1/attempts", "This needs a key."),
        ("grade", "POST /v1/grade", ""),
        ("grade", "POST /v1/exercises/{exercise_id}/attempts", "may not record attempts"),
        ("record", "POST /v1/exercises/{exercise_id}/attempts", ""),
        ("record", "POST /v1/tokens", ""),
        ("record", "GET /v1/attempts", "may not see what tutors see"),
        ("tutor", "GET /v1/attempts", ""),
        ("tutor", "GET /tutor", ""),
        # A learner with a token reads what is recorded of them, and nothing else.
        ("token", "POST /v1/exercises/{exercise_id}/attempts", ""),
        ("token", "GET /v1/attempts", ""),
        ("token", "GET /v1/courses", "may not see what tutors see"),
        ("token", "GET /tutor", "may not see what tutors see"),
        ("token", "POST /v1/tokens", "A token makes no tokens"),
    ],
)
def test_each_route_needs_its_right(
    served: Served, credential: str, route: str, refused: str
) -> None:
    method, path = route.split(" ")
    key = served.token() if credential == "token" else served.credentials[credential]
    assert served.is_answered(None, path, key)
    request = Request({**served.scopes[-1], "method": method, "route": Route(path, print)})

    def outcome(access: Access) -> tuple[int, str]:
        try:
            asyncio.run(access.permit(request))
        except ProblemError as error:
            return error.status, error.detail
        return 200, ""

    status, detail = outcome(served.access)
    assert status == (200 if not refused else 401 if "needs a key" in refused else 403)
    assert refused in detail
    if credential == "tutor":
        # Solutions and attempts may be hidden, also from tutors.
        status, detail = outcome(Access(solutions=False, read_attempts=False, keys=served.ring))
        assert status == 403
        assert "are for tutors, and this service does not show them" in detail


@pytest.mark.parametrize(
    ("credential", "in_browser", "passes"),
    [("record", False, True), ("record", True, False), ("", False, False)],
)
def test_a_program_with_a_key_records_from_any_origin(
    served: Served, credential: str, in_browser: bool, passes: bool
) -> None:
    key = served.credentials[credential]
    sent = (basic(key) if in_browser else f"Bearer {key}").encode()
    headers = [(b"authorization", sent), (b"origin", b"https://evil.example")]
    assert served.is_answered(None, "/v1/x/attempts", headers=headers, method="POST")
    request = Request(served.scopes[-1])
    with nullcontext() if passes else pytest.raises(ProblemError, match="may not record"):
        served.access.require_allowed_origin(request, ["https://course.example"])


def test_closing_ends_the_threads_of_the_keys(tmp_path: Path) -> None:
    served = Served(tmp_path / "keys.db")
    before = {each for each in threading.enumerate() if each.name.startswith("keys")}
    served.callers("record")
    served.access.close()
    after = {each for each in threading.enumerate() if each.name.startswith("keys")}
    assert after <= before
    Access().close()
    served.engine.dispose()


@pytest.mark.parametrize(
    ("path", "is_counted"),
    [
        ("/v1/grade", True), ("/grader/v1/grade", True), ("/tutor", True), ("/lti/login", True),
        ("/", False), ("/static/page.css", False), ("/exercises/scara", False),
        ("/healthz", False), ("/grader/readyz", False),
    ],
)  # fmt: skip
def test_pages_and_files_are_not_counted(served: Served, path: str, is_counted: bool) -> None:
    rates = Rates("", "1/day")
    assert served.is_answered(rates, path)
    assert served.is_answered(rates, path) is not is_counted
    # An address of its own.
    assert served.is_answered(rates, path, client=("10.0.0.2", 1))
    rates.close()


def test_requests_without_an_address_count_together(served: Served) -> None:
    rates = Rates("", "1/day")
    assert served.is_answered(rates, "/v1/grade", client=None)
    served.scopes.clear()
    start, body = served.ask(rates, "/v1/grade", client=None)
    assert start["status"] == 429
    assert b"too-often" in body["body"]
    assert served.scopes == []
    rates.close()


def test_other_connections_pass_as_they_are(served: Served) -> None:
    scope = {"type": "lifespan", "path": "/v1/grade"}
    assert served.is_answered(None, "/v1/grade", type="lifespan")
    assert served.scopes[-1].items() >= scope.items()
    assert "dh_grader.identity" not in served.scopes[-1]
    # Supervisors do not wait for the keys.
    assert served.is_answered(None, "/readyz", "not a key")
    assert "dh_grader.identity" not in served.scopes[-1]


def test_a_batch_counts_as_its_submissions(served: Served) -> None:
    rates = Rates("", "4/day")

    def outcome(number: int) -> str:
        assert served.is_answered(rates, "/v1/grade")
        try:
            asyncio.run(count_submissions(Request(served.scopes[-1]), number))
        except ProblemError as error:
            return f"{error.status} {error.name}"
        return "counted"

    assert outcome(5) == "422 batch-too-large"
    # One request has been counted, and another one is now.
    assert outcome(4) == "429 too-often"
    assert outcome(0) == "counted"
    assert outcome(1) == "counted"
    assert served.ask(rates, "/v1/grade")[0]["status"] == 429
    # Without limits, nothing is counted.
    assert served.is_answered(None, "/v1/grade")
    asyncio.run(count_submissions(Request(served.scopes[-1]), 1000))
    rates.close()


# --- Tutors sign in with their API key and get a cookie

SIGN_IN_SECRET = Secret("0123456789abcdef" * 4)
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
            lambda it: add_key(it, "", SIGN_IN_SECRET.key_digest(text), scopes, None, now, until),
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
def sign_in_browser(catalogue: Mapping[str, Exercise], tmp_path: Path) -> Iterator[Browser]:
    store = AttemptStore.open(str(tmp_path / "attempts.db"))
    ring = KeyRing(store.engine, SIGN_IN_SECRET, seconds=0.01)
    access = Access(OPEN_HERE, solutions=None, read_attempts=None, keys=ring)
    pages = web_routes(catalogue, Tutoring(access, records=True))
    app = application(catalogue, access=access, store=store, pages=pages)
    store.start()
    yield Browser(store, ring, app)
    ring.close()
    store.close()


def test_a_tutor_signs_in_once_and_out_again(sign_in_browser: Browser) -> None:
    key, _ = sign_in_browser.key(Scope.TUTOR)
    asked = sign_in_browser.ask("GET", "/tutor/attempts?exercise=scara", headers=READER)
    assert (asked.status_code, asked.headers.get("WWW-Authenticate")) == (303, None)
    form = asked.headers["Location"]
    assert form == "../tutor/sign-in?following=%2Ftutor%2Fattempts%3Fexercise%3Dscara"
    assert 'value="/tutor/attempts?exercise=scara"' in sign_in_browser.ask("GET", form[2:]).text
    assert sign_in_browser.sign_in("dhg_wrong").status_code == 403
    begun = sign_in_browser.sign_in(key, "/tutor/attempts?exercise=scara")
    assert (begun.status_code, begun.headers["Location"]) == (
        303,
        "../tutor/attempts?exercise=scara",
    )
    words = {each.strip() for each in begun.headers["Set-Cookie"].split(";")}
    assert {"HttpOnly", "Secure", "Path=/", "SameSite=lax", "Max-Age=36000"} <= words
    assert begun.headers["Set-Cookie"].startswith("__Host-dh-grader=")
    assert key not in begun.headers["Set-Cookie"]
    page = sign_in_browser.ask("GET", "/tutor", headers=READER)
    assert (page.status_code, "Sign out" in page.text) == (200, True)
    assert sign_in_browser.status("GET", "/v1/attempts") == 200
    assert sign_in_browser.status("POST", "/tutor/sign-out", **OWN) == 303
    assert sign_in_browser.status("GET", "/v1/attempts") == 401


def test_only_pages_of_the_service_use_a_session(sign_in_browser: Browser) -> None:
    key, _ = sign_in_browser.key(*Scope)
    path = "/v1/learners/forget"
    assert sign_in_browser.sign_in(key, **{"Sec-Fetch-Site": "cross-site"}).status_code == 403
    assert sign_in_browser.status() == 401
    sign_in_browser.sign_in(key)
    body = {"learner": "ada"}
    for headers, status in [
        (OWN, 200),
        ({"Origin": "https://evil.example", "Sec-Fetch-Site": "cross-site"}, 401),
        # Another service on the same host: browsers send it the cookie.
        ({"Origin": "https://course.example.edu", "Sec-Fetch-Site": "same-site"}, 401),
        ({"Origin": "https://course.example.edu"}, 401),
    ]:
        assert sign_in_browser.ask("POST", path, json=body, headers=headers).status_code == status
        minted = sign_in_browser.ask("POST", "/v1/tokens", json=body, headers=headers)
        assert minted.status_code == {200: 201}.get(status, status)
    # A link on another page opens a page, but no other page signs the tutor out.
    link = {"Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"}
    assert sign_in_browser.status(**{"Sec-Fetch-Site": "cross-site"}, **link) == 200
    assert sign_in_browser.status("POST", "/tutor/sign-out", Origin="https://evil.example") == 303
    assert sign_in_browser.status() == 200


def test_a_session_ends_with_its_key_and_in_time(
    sign_in_browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    key, key_id = sign_in_browser.key(Scope.TUTOR)
    sign_in_browser.sign_in(key)
    name, text = next(iter(sign_in_browser.cookies.items()))
    now = datetime.now(UTC)
    [early, late] = [session_of(key_id, now + timedelta(seconds=seconds)) for seconds in (-1, 1000)]
    forged = jwt.encode({"iss": "dh-grader session", "key": key_id, "exp": 9**12}, b"x" * 32)
    token = jwt.encode(
        {"iss": "dh-grader session", "key": key_id, "exp": 9**12}, SIGN_IN_SECRET.token_secret
    )
    for session, status in ((text, 200), (late, 200), (early, 401), (forged, 401), (token, 401)):
        sign_in_browser.cookies = httpx.Cookies({name: session})
        assert sign_in_browser.status() == status
        # Nobody is refused what is free, only because a session has ended.
        assert sign_in_browser.status("GET", "/") == 200
    in_transaction(sign_in_browser.store.engine, partial(revoke_key, key_id=key_id, now=now))
    sign_in_browser.cookies = httpx.Cookies({name: text})
    while sign_in_browser.status() == 200:  # the key is memoized for a moment
        continue
    assert sign_in_browser.status() == 401


def test_over_https_only_the_secure_cookie_counts(sign_in_browser: Browser) -> None:
    key, _ = sign_in_browser.key(Scope.TUTOR)
    sign_in_browser.sign_in(key)
    [(name, text)] = sign_in_browser.cookies.items()
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
        sign_in_browser.cookies = httpx.Cookies()
        answer = sign_in_browser.ask(
            "GET", "/tutor", address, headers={**headers, "Cookie": cookie}
        )
        assert answer.status_code == status, (address, cookies, headers)


def session_of(key_id: str, until: datetime) -> str:
    claims = {"iss": "dh-grader session", "key": key_id, "exp": int(until.timestamp())}
    return jwt.encode(claims, SIGN_IN_SECRET.session_secret)


def test_only_tutors_sign_in(sign_in_browser: Browser) -> None:
    for scopes, hours, said in [
        ((Scope.RECORD,), 1, "not a tutor"),
        ((Scope.TUTOR,), -1, "has expired"),
    ]:
        key, _ = sign_in_browser.key(*scopes, hours=hours)
        refused = sign_in_browser.sign_in(key)
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
