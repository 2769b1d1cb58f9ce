"""Test look-ups of keys in batches, without a database."""

import asyncio
import gc
import logging
import threading
import time
from collections.abc import Collection, Mapping
from datetime import UTC, datetime, timedelta

import pytest
from dh_grader import access as key_lookups
from dh_grader.access import Key, KeysBusyError
from dh_grader.access.keys import KeyLookups, KeyPlace

from tests.guards import ANSWER

NOW = datetime(2026, 11, 22, 12, tzinfo=UTC)


def place(number: int) -> KeyPlace:
    return "id", f"{number:08x}"


class Table:
    """A table with the keys of all even numbers; it notes what is looked up together."""

    def __init__(self) -> None:
        self.asked: list[list[KeyPlace]] = []
        self.times: list[float] = []
        self.error: Exception | None = None
        self.answers, self.is_asked = threading.Event(), threading.Event()
        self.answers.set()

    def find(self, places: Collection[KeyPlace]) -> Mapping[KeyPlace, Key]:
        self.times.append(time.monotonic())
        self.asked.append(list(places))
        self.is_asked.set()
        assert self.answers.wait(ANSWER)
        if self.error is not None:
            raise self.error
        until = NOW + timedelta(days=1)
        return {
            each: Key(each[1], "", frozenset(), None, NOW, until)
            for each in places
            if int(each[1], 16) % 2 == 0
        }


async def results(lookups: KeyLookups, *numbers: int) -> list[str | BaseException | None]:
    """Return the id of each key, None if there is no such key, or the error."""
    found = await asyncio.gather(
        *(lookups.key(place(each)) for each in numbers), return_exceptions=True
    )
    return [each.id if isinstance(each, Key) else each for each in found]


def test_each_key_is_asked_for_once_and_all_that_wait_together(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(key_lookups, "BATCH", 3)
    table = Table()
    lookups = KeyLookups(table.find)
    keys = {each: f"{each:08x}" for each in (2, 4, 6)}
    for _ in range(2):  # also in another event loop
        table.asked.clear()
        told = asyncio.run(results(lookups, 2, 1, 2, 4, 3, 6, 2))
        assert told == [keys[2], None, keys[2], keys[4], None, keys[6], keys[2]]
        assert table.asked == [[place(i) for i in (2, 1, 4)], [place(i) for i in (3, 6)]]

    async def one_after_the_other() -> list[str | BaseException | None]:
        return await results(lookups, 2) + await results(lookups, 3) + await results(lookups, 4)

    assert asyncio.run(one_after_the_other()) == [keys[2], None, keys[4]]
    lookups.close()


def test_there_is_a_pause_between_two_statements(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(key_lookups, "BATCH", 1)
    table = Table()
    lookups = KeyLookups(table.find, pause=0.03)
    asyncio.run(results(lookups, 1, 2, 3))
    lookups.close()
    assert [len(each) for each in table.asked] == [1, 1, 1]
    first, second, third = table.times
    assert min(second - first, third - second) >= 0.02


def test_an_error_of_the_database_is_told_to_all_who_wait(
    caplog: pytest.LogCaptureFixture,
) -> None:
    table = Table()
    lookups = KeyLookups(table.find)
    table.error = OSError("no database")
    assert asyncio.run(results(lookups, 1, 2, 1)) == [table.error] * 3

    async def leave() -> None:
        table.is_asked.clear()
        table.answers.clear()
        gone = asyncio.create_task(lookups.key(place(1)))
        while not table.is_asked.is_set():
            await asyncio.sleep(0.001)
        gone.cancel()
        table.answers.set()
        await results(lookups, 3)

    # If all callers have gone, nobody is told, and nothing is logged.
    with caplog.at_level(logging.DEBUG):
        asyncio.run(leave())
        gc.collect()
    assert "never retrieved" not in caplog.text
    # The next look-up asks again.
    table.error = None
    assert asyncio.run(results(lookups, 1, 2)) == [None, "00000002"]
    lookups.close()


def test_the_look_ups_work_after_the_end_of_an_event_loop(
    caplog: pytest.LogCaptureFixture,
) -> None:
    table = Table()
    lookups = KeyLookups(table.find)

    async def begin() -> list[asyncio.Task[Key | None]]:
        table.answers.clear()
        begun = [asyncio.create_task(lookups.key(place(1)))]
        while not table.is_asked.is_set():
            await asyncio.sleep(0.001)
        # This one waits for the next statement, which the event loop does not reach.
        begun.append(asyncio.create_task(lookups.key(place(2))))
        await asyncio.sleep(0)
        return begun

    assert all(each.cancelled() for each in asyncio.run(begin()))
    assert "exception" not in caplog.text.lower()
    table.answers.set()
    assert asyncio.run(results(lookups, 2, 1)) == ["00000002", None]
    lookups.close()


def test_only_so_many_look_ups_may_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(key_lookups, "MAX_WAITING", 2)
    lookups = KeyLookups(Table().find)
    *found, refused, known = asyncio.run(results(lookups, 2, 4, 6, 2))
    assert found == ["00000002", "00000004"]
    assert isinstance(refused, KeysBusyError)
    # One that is already looked up needs no place.
    assert known == "00000002"
    lookups.close()


def test_closing_ends_the_thread() -> None:
    def threads() -> set[threading.Thread]:
        return {each for each in threading.enumerate() if each.name.startswith("keys-read")}

    before = threads()
    lookups = KeyLookups(Table().find)
    asyncio.run(results(lookups, 2))
    assert len(threads() - before) == 1
    lookups.close()
    assert threads() <= before
