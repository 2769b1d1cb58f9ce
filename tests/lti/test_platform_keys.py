import asyncio
from datetime import UTC, datetime
from typing import Any

import pytest
from dh_grader.lti import LtiError, Registration
from dh_grader.lti.fetching import FetchError, PlatformKeys, PlatformThreads

from tests.lti.platform import Platform, public_jwk


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
