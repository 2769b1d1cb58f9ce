"""Test what the authentication tells the layers behind it, and which requests it counts."""

import asyncio
import base64
import math
import threading
from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from dh_grader.access import NOBODY, Caller, Scope, new_key_text
from dh_grader.access.keys import KeyRing, Rates, add_key
from dh_grader.api.http import CLIENT, Client, ProblemError
from dh_grader.api.permissions import (
    IDENTITY,
    Access,
    AuthenticationMiddleware,
    Identity,
    count_submissions,
)
from dh_grader.store.database import in_transaction, open_database
from fastapi import Request
from starlette.routing import Route

from tests.access.kept_services import SECRET
from tests.together import together


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
    monkeypatch.setattr("dh_grader.access.keys.MAX_WAITING", 0)
    assert outcome(new_key_text()) == (nobody, "503 busy")
    monkeypatch.undo()
    # The database does not answer.
    monkeypatch.setattr("dh_grader.access.keys.TIMEOUT", 0.0)
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
