"""Test the keys that are kept in the database."""

import asyncio
import gc
import logging
import threading
import time
from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from dh_grader.access import (
    Caller,
    CredentialError,
    Key,
    KeysBusyError,
    KeysUnreachableError,
    Scope,
    Secret,
    new_key_text,
)
from dh_grader.access import key_ring as key_lookups
from dh_grader.access import key_ring as key_ring
from dh_grader.access.key_ring import (
    KeyLookups,
    KeyPlace,
    KeyRing,
    add_key,
    all_keys,
    insert_key,
    keys_at,
    link_keys,
    note_use,
    revoke_key,
    settle,
)
from dh_grader.store.database import in_transaction, open_database
from dh_grader.store.tables import key_secrets, keys
from sqlalchemy import Connection, Engine, delete, event, select, text

from tests.guards import ANSWER

# --- Test memoized API keys: their lifetime, and failures of the database

SECRET = Secret("0123456789abcdef" * 4)
# How long the key rings of these tests memoize keys (seconds).
MEMOIZED_SECONDS = 0.05
# How often a test tries again, each time after these seconds.
TRIES = 400
TICK = timedelta(microseconds=1)


@pytest.fixture
def engine(tmp_path: Path) -> Iterator[Engine]:
    engine = open_database(str(tmp_path / "keys.db"))
    yield engine
    engine.dispose()


def made(engine: Engine, *scopes: Scope, days: int = 1) -> tuple[str, Key]:
    key, now = new_key_text(), datetime.now(UTC)
    until = now + timedelta(days=days)
    digest = SECRET.key_digest(key)
    return key, in_transaction(
        engine, lambda connection: add_key(connection, "a", digest, scopes, None, now, until)
    )


def asked(ring: KeyRing, *credentials: str) -> list[Caller]:
    async def ask() -> list[Caller]:
        return list(await asyncio.gather(*map(ring.caller, credentials)))

    return asyncio.run(ask())


def test_only_a_keyed_hash_of_a_key_is_stored(engine: Engine, tmp_path: Path) -> None:
    key, known = made(engine, Scope.RECORD)
    with engine.connect() as connection:
        [row] = connection.execute(select(keys)).all()
        assert all_keys(connection) == [known]
    assert row.digest == SECRET.key_digest(key) != Secret(64 * "x").key_digest(key)
    stored = b"".join(file.read_bytes() for file in tmp_path.iterdir())
    assert key[4:36].encode() not in stored


def test_new_and_revoked_keys_take_effect_within_seconds(engine: Engine) -> None:
    ring = KeyRing(engine, SECRET, MEMOIZED_SECONDS)
    assert not asyncio.run(ring.are_needed())
    key, known = made(engine)

    async def becomes_needed() -> bool:
        for _ in range(TRIES):
            if await ring.are_needed():
                return True
            await asyncio.sleep(MEMOIZED_SECONDS)
        return False

    assert asyncio.run(becomes_needed())
    assert asked(ring, key, key) == 2 * [Caller(frozenset({Scope.GRADE}), key_id=known.id)]
    now = datetime.now(UTC)
    assert in_transaction(engine, lambda connection: revoke_key(connection, known.id, now))
    assert not in_transaction(engine, lambda connection: revoke_key(connection, known.id, now))

    async def until_refused() -> None:
        for _ in range(TRIES):
            await ring.caller(key)
            await asyncio.sleep(MEMOIZED_SECONDS)

    with pytest.raises(CredentialError, match="revoked"):
        asyncio.run(until_refused())
    # The service stays closed even if all its keys are revoked.
    assert KeyRing(engine, SECRET).has_keys
    ring.close()


def test_a_token_is_invalid_after_its_key_is_revoked(engine: Engine) -> None:
    _, known = made(engine, Scope.RECORD, Scope.TUTOR)
    ring = KeyRing(engine, SECRET, 0.0)
    learner = Caller(known.scopes | {Scope.GRADE}, frozenset({"scara"}), "ada", known.id)
    token = ring.token(learner, known.expires_at)
    [caller] = asked(ring, token)
    assert (caller.learner, caller.exercises) == ("ada", frozenset({"scara"}))
    assert caller.scopes == {Scope.GRADE, Scope.RECORD}
    assert caller.owner not in ("", known.id)
    now = datetime.now(UTC)
    in_transaction(engine, lambda connection: revoke_key(connection, known.id, now))
    with pytest.raises(CredentialError, match="revoked"):
        asked(ring, token)
    ring.close()


def test_the_last_use_is_written_once_a_minute(engine: Engine) -> None:
    key, _ = made(engine)
    ring = KeyRing(engine, SECRET, 0.0)
    for _ in range(3):
        asked(ring, key)
    ring.close()
    with engine.connect() as connection:
        [known] = all_keys(connection)
    assert known.last_used_at is not None
    assert known.created_at < known.last_used_at < known.created_at + timedelta(seconds=50)
    again = KeyRing(engine, SECRET, 0.0)
    asked(again, key)
    again.close()
    with engine.connect() as connection:
        assert all_keys(connection) == [known]


def test_repeated_uses_are_written_once(engine: Engine) -> None:
    written: list[str] = []

    @event.listens_for(engine, "before_cursor_execute")
    def note(*given: object) -> None:
        written.append(str(given[2]))

    one, other = made(engine)[0], made(engine)[0]
    ring = KeyRing(engine, SECRET, 0.0)
    for _ in range(3):
        asked(ring, one, other)
    ring.close()
    assert len([each for each in written if each.startswith("UPDATE")]) == 2


def test_keys_belong_to_one_secret(engine: Engine) -> None:
    other, now = Secret("x" * 64), datetime.now(UTC)

    def has_secret(secret: Secret | None) -> bool:
        ring = KeyRing(engine, secret)
        ring.close()
        return ring.has_their_secret

    # Nothing is recorded yet.
    assert has_secret(SECRET)
    assert in_transaction(engine, lambda it: settle(it, SECRET, now))
    _, known = made(engine)
    assert [has_secret(each) for each in (SECRET, other, None)] == [True, False, True]
    # While a key is valid, no key can be made with another secret.
    assert not in_transaction(engine, lambda it: settle(it, other, now))
    assert in_transaction(engine, lambda it: settle(it, SECRET, now))
    assert not in_transaction(engine, lambda it: settle(it, other, known.expires_at - TICK))
    assert has_secret(SECRET)
    # After the last one has ended, another secret may begin.
    assert in_transaction(engine, lambda it: settle(it, other, known.expires_at))
    assert [has_secret(each) for each in (SECRET, other)] == [False, True]
    # There is one row, in which every version of the program looks for it.
    with engine.connect() as connection:
        assert connection.execute(select(key_secrets)).all() == [(1, other.check)]


def test_a_revoked_key_holds_no_secret(engine: Engine) -> None:
    other, now = Secret("x" * 64), datetime.now(UTC)
    in_transaction(engine, lambda it: settle(it, SECRET, now))
    _, known = made(engine)
    in_transaction(engine, lambda it: revoke_key(it, known.id, now))
    assert in_transaction(engine, lambda it: settle(it, other, now))


def test_a_ring_asks_for_the_first_key_once_in_a_while(engine: Engine) -> None:
    ring = KeyRing(engine, SECRET, seconds=3600)
    assert not asyncio.run(ring.are_needed())
    made(engine)
    assert not asyncio.run(ring.are_needed())
    # The program itself has made a key, so it need not ask.
    ring.expect_keys()
    assert asyncio.run(ring.are_needed())
    ring.close()


def test_a_session_is_that_of_its_key(engine: Engine) -> None:
    key, known = made(engine, Scope.TUTOR)
    ring = KeyRing(engine, SECRET)
    [caller] = asked(ring, key)
    session = ring.session(caller, known.expires_at)
    assert asyncio.run(ring.session_caller(session)) == caller
    expired = ring.session(caller, datetime.now(UTC) - timedelta(seconds=2))
    with pytest.raises(CredentialError, match="The session has expired"):
        asyncio.run(ring.session_caller(expired))
    # A token of a learner is no session, and a session no token.
    learner = Caller(known.scopes, None, "ada", known.id)
    with pytest.raises(CredentialError, match="no session"):
        asyncio.run(ring.session_caller(ring.token(learner, known.expires_at)))
    with pytest.raises(CredentialError, match="neither a key nor a token"):
        asked(ring, session)
    ring.close()


def test_without_a_secret_no_key_is_valid(engine: Engine) -> None:
    key, _ = made(engine)
    ring = KeyRing(engine, None)
    for asking in (ring.caller(key), ring.session_caller("a.b.c")):
        with pytest.raises(CredentialError, match="DH_GRADER_SECRET is not set"):
            asyncio.run(asking)
    ring.close()


def test_a_known_key_works_while_the_database_is_down(engine: Engine) -> None:
    key, known = made(engine)
    other, _ = made(engine)
    ring = KeyRing(engine, SECRET, 0.0)
    asked(ring, key)
    with engine.execution_options(writes=True).begin() as connection:
        connection.execute(text("ALTER TABLE keys RENAME TO hidden"))
    assert [each.key_id for each in asked(ring, key, key)] == 2 * [known.id]
    with pytest.raises(KeysUnreachableError):
        asked(ring, other)
    ring.close()
    with pytest.raises(KeysUnreachableError):
        KeyRing(engine, SECRET)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """A clock for the memoized keys (``now``, in seconds) and for their use (``date``)."""
    clock = SimpleNamespace(now=1000.0, date=datetime.now(UTC))
    monkeypatch.setattr(key_ring, "monotonic", lambda: clock.now)
    monkeypatch.setattr(key_ring, "datetime", SimpleNamespace(now=lambda _: clock.date))
    return clock


class Statements:
    """Counts the statements on the keys of a database."""

    def __init__(self, engine: Engine) -> None:
        self._written: list[str] = []
        event.listen(engine, "before_cursor_execute", lambda *given: self._written.append(given[2]))

    def taken(self, word: str = "SELECT") -> int:
        """Return the number of statements with this word since the last time."""
        found = [each for each in self._written if each.startswith(word) and "keys" in each]
        self._written.clear()
        return len(found)


def outcome(ring: KeyRing, credential: str) -> str:
    try:
        return asked(ring, credential)[0].key_id
    except (CredentialError, KeysUnreachableError) as error:
        return type(error).__name__


def hide(engine: Engine, *, back: bool = False) -> None:
    """Rename the table of keys, so that every statement fails; or rename it back."""
    names = ("hidden", "keys") if back else ("keys", "hidden")
    with engine.execution_options(writes=True).begin() as connection:
        connection.execute(text("ALTER TABLE {} RENAME TO {}".format(*names)))


def test_a_known_key_is_looked_up_every_five_seconds(
    engine: Engine, clock: SimpleNamespace
) -> None:
    key, known = made(engine)
    ring, statements = KeyRing(engine, SECRET), Statements(engine)
    looked_up = []
    for seconds in (0.0, 0.0, 4.99, 5.0, 9.99, 10.0):
        clock.now = 1000 + seconds
        assert outcome(ring, key) == known.id
        looked_up.append(statements.taken())
    assert looked_up == [1, 0, 0, 1, 0, 1]
    ring.close()


def test_the_first_key_is_looked_for_every_five_seconds(
    engine: Engine, clock: SimpleNamespace
) -> None:
    ring, statements = KeyRing(engine, SECRET), Statements(engine)
    looked_for = []
    for seconds in (0.0, 4.99, 5.0, 5.0, 9.99, 10.0):
        clock.now = 1000 + seconds
        assert not asyncio.run(ring.are_needed())
        looked_for.append(statements.taken())
    assert looked_for == [0, 0, 1, 0, 0, 1]
    # While the database is down, there are no keys as before.
    hide(engine)
    clock.now = 1015.0
    assert not asyncio.run(ring.are_needed())
    hide(engine, back=True)
    made(engine)
    assert not asyncio.run(ring.are_needed())
    clock.now = 1020.0
    assert asyncio.run(ring.are_needed())
    statements.taken()
    # Keys stay needed, so nobody asks again.
    clock.now = 2000.0
    assert asyncio.run(ring.are_needed())
    assert statements.taken() == 0
    ring.close()


@pytest.mark.parametrize(("memoized", "until"), [(5.0, 2.0), (1.0, 1.0)])
def test_an_unknown_key_is_looked_up_every_two_seconds(
    engine: Engine, clock: SimpleNamespace, memoized: float, until: float
) -> None:
    key = new_key_text()
    ring, statements = KeyRing(engine, SECRET, memoized), Statements(engine)
    looked_up = []
    for seconds in (0.0, until - 0.01, until, 2 * until - 0.01):
        clock.now = 1000 + seconds
        assert outcome(ring, key) == "CredentialError"
        looked_up.append(statements.taken())
    assert looked_up == [1, 0, 1, 0]
    ring.close()


def test_a_database_that_is_down_is_asked_every_fifteen_seconds(
    engine: Engine, clock: SimpleNamespace
) -> None:
    key, known = made(engine)
    ring, statements = KeyRing(engine, SECRET), Statements(engine)
    asked(ring, key)
    hide(engine)
    statements.taken()
    looked_up = []
    for seconds in (5.0, 5.0, 19.99, 20.0, 34.99):
        clock.now = 1000 + seconds
        assert outcome(ring, key) == known.id
        looked_up.append(statements.taken())
    assert looked_up == [1, 0, 0, 1, 0]
    # The key was revoked in the meantime.
    hide(engine, back=True)
    in_transaction(engine, lambda it: revoke_key(it, known.id, datetime.now(UTC)))
    assert outcome(ring, key) == known.id
    clock.now = 1035.0
    assert outcome(ring, key) == "CredentialError"
    ring.close()


def test_a_deleted_key_is_forgotten(engine: Engine, clock: SimpleNamespace) -> None:
    key, known = made(engine)
    ring = KeyRing(engine, SECRET)
    assert outcome(ring, key) == known.id
    with engine.execution_options(writes=True).begin() as connection:
        connection.execute(delete(keys))
    clock.now += 5
    assert outcome(ring, key) == "CredentialError"
    # It does not work again while the database is down.
    hide(engine)
    assert outcome(ring, key) == "CredentialError"
    clock.now += 2
    assert outcome(ring, key) == "KeysUnreachableError"
    ring.close()


@pytest.mark.parametrize("limit", ["_MOST", "_MOST_UNKNOWN"])
def test_the_key_that_was_looked_up_first_is_forgotten_first(
    engine: Engine, clock: SimpleNamespace, monkeypatch: pytest.MonkeyPatch, limit: str
) -> None:
    monkeypatch.setattr(key_ring, limit, 2)
    texts = [made(engine)[0] if limit == "_MOST" else new_key_text() for _ in range(3)]
    ring, statements = KeyRing(engine, SECRET), Statements(engine)

    def looked_up(*numbers: int) -> list[int]:
        found = []
        for i in numbers:
            outcome(ring, texts[i])
            found.append(statements.taken())
        return found

    assert looked_up(0, 1, 0, 1) == [1, 1, 0, 0]
    clock.now += 5
    assert looked_up(1, 0, 2) == [1, 1, 1]
    # Key 1 has been forgotten, and then key 0.
    assert looked_up(0, 2, 1, 2, 0) == [0, 0, 1, 0, 1]
    ring.close()


def test_the_use_of_a_key_is_written_after_a_minute(engine: Engine, clock: SimpleNamespace) -> None:
    key, _ = made(engine)
    first = clock.date
    uses = []
    for seconds in (0, 59.9, 60, 119.9, 120):
        # Another process has noted the uses before.
        ring = KeyRing(engine, SECRET)
        clock.date = first + timedelta(seconds=seconds)
        asked(ring, key)
        ring.close()
        with engine.connect() as connection:
            uses += [each.last_used_at for each in all_keys(connection)]
    assert [(each - first).total_seconds() for each in uses if each] == [0, 0, 60, 60, 120]
    # A process whose clock is late does not move the time back.
    in_transaction(engine, lambda it: note_use(it, all_keys(it)[0].id, first))
    with engine.connect() as connection:
        assert all_keys(connection)[0].last_used_at == uses[-1]


def test_a_closed_ring_leaves_no_thread(engine: Engine) -> None:
    def threads() -> set[threading.Thread]:
        return {each for each in threading.enumerate() if each.name.startswith("keys")}

    before = threads()
    key, _ = made(engine)
    ring = KeyRing(engine, SECRET, 0.0)
    asked(ring, key, key)
    assert threads() > before
    ring.close()
    assert threads() <= before


def test_keys_and_links_are_listed_apart_and_the_oldest_key_first(engine: Engine) -> None:
    now = datetime.now(UTC)

    def added(number: int, age: int, **more: Any) -> Key:
        created = now - timedelta(hours=age)
        key = Key(f"{number:08x}", "", frozenset(), None, created, now, **more)
        in_transaction(engine, lambda it: insert_key(it, key, f"{number}"))
        return key

    young, old = added(1, 1), added(2, 2)
    course = added(3, 0, course="robots")
    link = added(4, 3, course="robots", learner="ada")
    added(5, 3, course="robots", learner="grace", revoked_at=now)
    added(6, 3, course="others", learner="ada")
    with engine.connect() as connection:
        assert all_keys(connection) == [old, young, course]
        assert link_keys(connection, "robots") == [link]


def flooded(ring: KeyRing, invented: int, *keys: str) -> list[Caller]:
    async def flood() -> list[BaseException | Caller]:
        before, after = ((new_key_text() for _ in range(invented // 2)) for _ in range(2))
        asked = map(ring.caller, (*before, *keys, *after))
        return await asyncio.gather(*asked, return_exceptions=True)

    told = asyncio.run(flood())
    refused = [each for each in told if isinstance(each, BaseException)]
    assert {type(each) for each in refused} == {CredentialError}
    assert len(refused) == invented
    return [each for each in told if isinstance(each, Caller)]


@pytest.mark.long
def test_a_valid_key_is_found_among_many_invented_ones(engine: Engine) -> None:
    known, new = made(engine), made(engine)
    ring = KeyRing(engine, SECRET, 0.0)
    asked(ring, known[0])
    statements = 0

    def count(*_: object) -> None:
        nonlocal statements
        statements += 1

    event.listen(engine, "before_cursor_execute", count)
    callers = flooded(ring, 2000, known[0], new[0])
    event.remove(engine, "before_cursor_execute", count)
    assert [each.key_id for each in callers] == [known[1].id, new[1].id]
    # One statement for 128 invented keys, and one to note the use of each real key.
    assert statements < 40
    ring.close()


def test_a_known_key_does_not_wait_for_invented_ones(
    engine: Engine, monkeypatch: pytest.MonkeyPatch
) -> None:
    key, known = made(engine)
    ring = KeyRing(engine, SECRET, 0.0)
    asked(ring, key)
    answers, looked = threading.Event(), threading.Event()

    def slow(connection: Connection, places: Collection[KeyPlace]) -> dict[KeyPlace, Key]:
        if ("digest", SECRET.key_digest(key)) not in places:
            looked.set()
            assert answers.wait(ANSWER)
        return keys_at(connection, places)

    monkeypatch.setattr("dh_grader.access.key_ring.keys_at", slow)

    async def ask() -> Caller:
        invented = [asyncio.create_task(ring.caller(new_key_text())) for _ in range(300)]
        while not looked.is_set():
            await asyncio.sleep(0)
        found = await ring.caller(key)
        assert not any(task.done() for task in invented)
        answers.set()
        refused = await asyncio.gather(*invented, return_exceptions=True)
        assert {type(each) for each in refused} == {CredentialError}
        return found

    assert asyncio.run(ask()).key_id == known.id
    ring.close()


def test_an_unknown_key_is_looked_up_again_within_seconds(engine: Engine) -> None:
    key, now = new_key_text(), datetime.now(UTC)
    ring = KeyRing(engine, SECRET, MEMOIZED_SECONDS)
    with pytest.raises(CredentialError):
        asked(ring, key)
    digest = SECRET.key_digest(key)
    in_transaction(
        engine,
        lambda connection: add_key(connection, "", digest, (), None, now, now + timedelta(days=1)),
    )

    async def until_known() -> Caller:
        for _ in range(TRIES):
            with suppress(CredentialError):
                return await ring.caller(key)
            await asyncio.sleep(MEMOIZED_SECONDS)
        raise AssertionError("the key stays unknown")

    assert asyncio.run(until_known()).scopes == {Scope.GRADE}
    ring.close()


def test_a_repeated_wrong_key_is_looked_up_rarely(engine: Engine) -> None:
    made(engine)
    ring = KeyRing(engine, SECRET, 60.0)
    key, statements = new_key_text(), []
    event.listen(engine, "before_cursor_execute", lambda *args: statements.append(args[2]))

    async def again_and_again() -> None:
        for _ in range(50):
            with pytest.raises(CredentialError, match="no such key"):
                await ring.caller(key)

    asyncio.run(again_and_again())
    assert len(statements) < 10
    ring.close()


def test_too_many_lookups_raise_a_busy_error(
    engine: Engine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("dh_grader.access.key_ring.MAX_WAITING", 10)
    key, known = made(engine)
    ring = KeyRing(engine, SECRET, 0.0)
    asked(ring, key)

    async def flood() -> list[BaseException | Caller]:
        invented = (new_key_text() for _ in range(50))
        return await asyncio.gather(*map(ring.caller, (*invented, key)), return_exceptions=True)

    *refused, caller = asyncio.run(flood())
    assert isinstance(caller, Caller)
    assert caller.key_id == known.id
    assert {type(each) for each in refused} == {CredentialError, KeysBusyError}
    ring.close()


def test_a_cancelled_lookup_does_not_affect_others(engine: Engine) -> None:
    key, known = made(engine)
    ring = KeyRing(engine, SECRET, 0.0)

    async def ask() -> Caller:
        gone, stays = (asyncio.create_task(ring.caller(key)) for _ in range(2))
        await asyncio.sleep(0)
        gone.cancel()
        return await stays

    assert asyncio.run(ask()).key_id == known.id
    ring.close()


def test_a_lookup_in_a_silent_database_times_out(
    engine: Engine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(key_lookups, "TIMEOUT", 0.05)
    reacts = threading.Event()
    key, _ = made(engine, Scope.GRADE)
    ring = KeyRing(engine, SECRET, MEMOIZED_SECONDS)

    def silent(*_: object) -> None:
        reacts.wait(ANSWER)

    event.listen(engine, "before_cursor_execute", silent)
    try:
        with pytest.raises(KeysUnreachableError):
            asked(ring, key)
    finally:
        reacts.set()
        ring.close()


# --- Test look-ups of keys in batches, without a database

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
