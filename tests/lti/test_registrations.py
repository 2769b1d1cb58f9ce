"""Test registered platforms, and the keys of both sides."""

import asyncio
import threading
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from dh_grader import lti as platform_threads
from dh_grader.access import Secret
from dh_grader.lti import PlatformThreads
from dh_grader.lti.fetching import (
    FetchError,
    PlatformKeys,
    ensure_key,
    published_keys,
    rotate,
    signing_key,
)
from dh_grader.lti.registrations import LTI_PROBLEMS, LtiError, Registration, cause_without_values
from dh_grader.store.tables import own_keys
from dh_grader.translations import LANGUAGES, say, told

from tests.access.kept_services import SECRET
from tests.guards import ANSWER
from tests.lti.conftest import Journey, Tool, hidden
from tests.lti.conftest import journey as journey
from tests.lti.platform import Platform, public_jwk

# --- The operators' page of registered platforms

PAGE = "/tutor/platforms"
CHECK = f"{PAGE}/moodle/check"


def test_the_page_lists_registrations_and_keys(journey: Journey) -> None:
    tool, tutor = journey.tool, journey.tutor()

    def shown() -> str:
        page = tool.send("GET", PAGE, headers=tutor)
        assert page.status_code == 200, page.text
        return page.text

    assert "<td>never</td>" in shown()
    assert "Last refusal" not in shown()
    journey.launch("ada")
    tool.platform.habits.append(lambda claims: claims.update(aud="somebody else"))
    assert tool.launch("ada").status_code == 403
    page = shown()
    assert "<td>never</td>" not in page
    assert "Last refusal" in page
    for value in (tool.platform.address, "client-1", "deployment-1", "/lti/jwks.json", "/token"):
        assert value in page
    [key] = tool.send("GET", "/lti/jwks.json").json()["keys"]
    assert key["kid"] in page
    home = tool.send("GET", "/tutor", headers=tutor).text
    assert 'href="tutor/platforms"' in home


def test_a_registration_is_tested_by_page(journey: Journey) -> None:
    tool, tutor = journey.tool, journey.tutor()
    page = tool.send("POST", CHECK, headers=tutor).text
    assert "OK: Access token: the platform gives one for scores" in page
    assert "OK: Keys of the platform: 1 of 1 can be used" in page
    assert "Wrong" not in page
    tool.platform.keys.clear()
    journey.gradebook.token_trouble = (400, {})
    page = tool.send("POST", CHECK, headers=tutor).text
    assert page.count("Wrong:") == 2
    assert "the status is 400" in page
    for name in ("another", "A%00"):
        unknown = tool.send("POST", f"{PAGE}/{name}/check", headers=tutor)
        assert unknown.status_code in (404, 422)


def test_the_page_and_the_test_are_in_the_readers_language(journey: Journey) -> None:
    tool, tutor = journey.tool, journey.tutor() | {"accept-language": "de"}
    page = tool.send("POST", CHECK, headers=tutor)
    assert page.headers["content-language"] == "de"
    assert "Zugriffstoken: Die Plattform gibt eines für Punkte" in page.text
    assert "Öffentliche Schlüssel" in page.text
    assert "Letzter Start: nie" in page.text
    tool.platform.habits.append(lambda claims: claims.update(iss="https://else.example"))
    assert tool.launch("ada").status_code == 403
    page = tool.send("GET", PAGE, headers=tutor)
    assert "UTC: Das id_token ist von einem anderen Aussteller." in page.text


def test_a_tutor_of_one_course_sees_no_registrations(journey: Journey) -> None:
    tool = journey.tool
    ticket = hidden(tool.launch("turing").text, "ticket")
    opened = tool.send("POST", "/lti/session", data={"ticket": ticket})
    session = {"cookie": opened.headers["set-cookie"].partition(";")[0]}
    for method, path in (("GET", PAGE), ("POST", CHECK)):
        assert tool.send(method, path, headers=session).status_code == 403
    assert "tutor/platforms" not in tool.send("GET", "/tutor", headers=session).text


def test_every_cause_is_in_each_language() -> None:
    for code in LANGUAGES.keys() - {"en"}:
        translation = LANGUAGES[code].translation
        for cause in map(cause_without_values, LTI_PROBLEMS):
            assert told(cause, translation) != cause, (code, cause)


def test_a_cause_has_its_values_and_their_translation() -> None:
    refused = LtiError("keys-unreachable", reason=say("the answer is not JSON"))
    assert str(refused) == "The keys of the platform cannot be read: the answer is not JSON"
    expected = "Die Schlüssel der Plattform sind nicht lesbar: die Antwort ist kein JSON"
    assert told(refused.args[0], LANGUAGES["de"].translation) == expected
    long = LtiError("platform-error", error="x" * 1000)
    assert str(long) == f"The platform answered with the error {'x' * 200}."


def test_a_cause_without_its_values_is_a_sentence() -> None:
    cause = cause_without_values("unknown-platform")
    assert cause == "No registration has the issuer … and this client id."
    assert (
        told(cause, LANGUAGES["de"].translation)
        == "Keine Registrierung hat den Aussteller … und diese Client-ID."
    )
    assert cause_without_values("of-an-older-version") == "of-an-older-version"


# --- Own keys

NOW = datetime.now(UTC)
DAY = timedelta(days=1)
KINDS = pytest.mark.parametrize("tool", ["sqlite", "postgresql"], indirect=True)


@pytest.mark.long
@KINDS
def test_a_new_key_is_published_for_a_day_before_it_signs(tool: Tool) -> None:
    def ids() -> list[str]:
        return [each["kid"] for each in tool.do(published_keys)["keys"]]

    def signing(now: datetime) -> Any:
        return tool.do(lambda it: signing_key(it, SECRET, now)).id

    tool.do(lambda it: it.execute(own_keys.delete()))
    tool.do(lambda it: ensure_key(it, SECRET, NOW))
    [first] = ids()
    assert tool.do(lambda it: rotate(it, SECRET, NOW)) == NOW + DAY
    assert tool.do(lambda it: rotate(it, SECRET, NOW)) == NOW + DAY
    first_again, second = ids()
    assert (first_again, signing(NOW + DAY / 2)) == (first, first)
    assert signing(NOW + DAY) == second
    tool.do(lambda it: rotate(it, SECRET, NOW + 2 * DAY))
    assert ids()[0] == second
    assert len(ids()) == 2
    # Only public parts are published, and the private ones need the secret.
    assert not {"d", "p", "q"} & set(tool.do(published_keys)["keys"][0])
    other = Secret("another secret of thirty-two chars")
    with pytest.raises(LtiError):
        tool.do(lambda it: signing_key(it, other, NOW + DAY))
    shown = tool.send("GET", "/lti/jwks.json").json()["keys"]
    assert [each["kid"] for each in shown] == ids()


# --- Platform keys


class Clock:
    """A clock that tests set, and a platform that counts the requests for its keys."""

    def __init__(self, platform: Platform) -> None:
        self.now, self.count = 1000.0, 0
        self.answer: Any = {"keys": platform.keys}
        values = platform.registration | {"any_deployment": True, "audience": None}
        del values["deployments"]
        times: Any = dict.fromkeys(("launched_at", "refused_at", "refusal"))
        self.registration = Registration(**values, created_at=datetime.now(UTC), **times)
        self.keys = PlatformKeys(PlatformThreads(), self.fetch, lambda: self.now)

    def fetch(self, *_: object, **__: object) -> Any:
        self.count += 1
        if self.answer is None:
            raise FetchError("it is down")
        return self.answer

    def told(self, key_id: str) -> str:
        try:
            asyncio.run(self.keys.key(self.registration, key_id))
        except LtiError as error:
            return error.name
        return ""


@pytest.fixture
def clock(platform: Platform) -> Clock:
    return Clock(platform)


def test_unknown_keys_are_fetched_at_most_once_a_minute(clock: Clock) -> None:
    assert [clock.told("key-1") for _ in range(3)] == [""] * 3
    assert [clock.told(f"evil-{i}") for i in range(20)] == ["unknown-key"] * 20
    assert clock.count == 1
    clock.now += 60
    assert [clock.told(f"evil-{i}") for i in range(20)] == ["unknown-key"] * 20
    assert clock.count == 2


def test_a_new_key_is_found_and_an_old_one_forgotten(clock: Clock, platform: Platform) -> None:
    assert clock.told("key-1") == ""
    clock.answer = {"keys": [public_jwk(platform.key, "key-2")]}
    clock.now += 61
    assert (clock.told("key-2"), clock.told("key-1")) == ("", "unknown-key")


def test_known_keys_work_for_a_day_while_the_platform_is_down(clock: Clock) -> None:
    assert clock.told("key-1") == ""
    clock.answer = None
    clock.now += 23 * 3600
    assert clock.told("key-1") == ""
    clock.now += 2 * 3600
    assert clock.told("key-1") == "keys-unreachable"


# --- Work that waits for platforms has threads of its own


def test_a_slow_platform_leaves_threads_for_others_and_for_other_work() -> None:
    over, names = threading.Event(), []

    def slow() -> str:
        names.append(threading.current_thread().name)
        over.wait(ANSWER)
        return "slow"

    async def run() -> list[str]:
        threads = PlatformThreads()
        held = [asyncio.ensure_future(threads.run("slow", slow)) for _ in range(100)]
        async with asyncio.timeout(ANSWER):
            assert await threads.run("other", lambda: "quick") == "quick"
            # The threads of everything else.
            assert await asyncio.to_thread(lambda: "graded") == "graded"
        assert len(names) == platform_threads._MOST_EACH
        over.set()
        found = await asyncio.gather(*held)
        threads.close()
        return found

    assert asyncio.run(run()) == ["slow"] * 100
    assert all(name.startswith("lti-platform") for name in names)


def test_a_caller_that_gives_up_keeps_its_turn_until_the_work_ends() -> None:
    over, started = threading.Event(), []

    def slow() -> None:
        started.append(1)
        over.wait(ANSWER)

    async def run() -> None:
        threads = PlatformThreads()
        most = platform_threads._MOST_EACH
        held = [asyncio.ensure_future(threads.run("slow", slow)) for _ in range(2 * most)]
        while len(started) < most:
            await asyncio.sleep(0.001)
        for each in held[:most]:
            each.cancel()
        await asyncio.wait(held[:most])
        await asyncio.sleep(0.05)
        assert len(started) == most
        over.set()
        await asyncio.gather(*held[most:])
        assert len(started) == 2 * most
        threads.close()

    asyncio.run(run())


def test_the_error_of_the_work_reaches_the_caller() -> None:
    def failing() -> None:
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        asyncio.run(PlatformThreads().run("a", failing))
