"""Kill replicas of the service while they send scores."""

import asyncio
import random
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest
from dh_grader.access import OPEN_HERE, Secret
from dh_grader.access.keys import KeyRing
from dh_grader.api.application import application
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise
from dh_grader.lti.outbox import BackgroundSending
from dh_grader.store import AttemptStore
from dh_grader.store.database import QUEUED

from tests.access.kept_services import SECRET_TEXT
from tests.attempts.databases import new_file
from tests.guards import ANSWER
from tests.lti.scores.conftest import Journey

USERS = ("ada", "grace", "edsger", "barbara")
ROOT = Path(__file__).parents[3]


class Replicas:
    """Two processes that send scores."""

    def __init__(self, journey: Journey, folder: Path) -> None:
        self._file = folder / "added"
        module = ["-m", "tests.lti.scores.replica"]
        command = [sys.executable, *module, journey.tool.url, str(self._file), SECRET_TEXT]
        pipe = subprocess.PIPE
        self._parent = subprocess.Popen(command, cwd=ROOT, stdin=pipe, stdout=pipe, text=True)
        self._number = 0
        self._journey = journey
        self.go_on(0)
        self.restart()

    def go_on(self, seconds: float) -> None:
        self._journey.clock.go_on(seconds=seconds)
        draft = self._file.with_suffix(".new")
        draft.write_text(str(self._journey.clock.added.total_seconds()))
        draft.replace(self._file)

    def kill(self, number: int) -> None:
        self._ask("kill", number)
        self._number -= number

    def restart(self) -> None:
        self._ask("start", 2 - self._number)
        self._number = 2

    def close(self) -> None:
        self._parent.communicate(timeout=ANSWER)

    def _ask(self, word: str, number: int) -> None:
        assert self._parent.stdin is not None
        assert self._parent.stdout is not None
        self._parent.stdin.write(f"{word} {number}\n")
        self._parent.stdin.flush()
        assert self._parent.stdout.readline() == "done\n"


@pytest.fixture
def replicas(journey: Journey, tmp_path: Path) -> Iterator[Replicas]:
    (folder := tmp_path / "clock").mkdir()
    made = Replicas(journey, folder)
    yield made
    made.close()


class Round:
    """A round of the test, in which replicas are killed."""

    def __init__(self, replicas: Replicas, at: int, killed: int) -> None:
        self._replicas, self._at, self._killed = replicas, at, killed
        self._lock = threading.Lock()
        self.received = 0

    def answer(self) -> None:
        with self._lock:
            if self.received + 1 == self._at:
                self._replicas.kill(self._killed)
            self.received += 1

    @property
    def is_over(self) -> bool:
        return self.received >= self._at


def killed(journey: Journey, replicas: Replicas, rounds: int) -> str:
    choose = random.Random(rounds)
    ids = {user: journey.hand_in(user) for user in USERS}
    most = ids["ada"]["max_points"]
    kills, wanted = 0, dict.fromkeys(USERS, -1.0)
    for number in range(rounds):
        # One replica goes on in every second round.
        this = Round(replicas, choose.randint(1, len(USERS)), 2 - number % 2)
        journey.gradebook.before_answer = this.answer
        # Other points than before: all of them are sent.
        further = {user: choose.randint(1, int(most) - 1) for user in USERS}
        wanted = {user: (wanted[user] + further[user]) % most for user in USERS}
        for user, points in wanted.items():
            change = {"points": points, "reason": "r", "author": "t"}
            journey.post(f"attempts/{ids[user]['id']}/override", **change)
        _wait(lambda this=this: this.is_over or _is_done(journey))  # type: ignore[misc]
        kills += this.is_over
        replicas.restart()
        # The leases of the killed senders end.
        replicas.go_on(100)
        _wait(lambda: _is_done(journey))
        share = {user: points / most * 100 for user, points in wanted.items()}
        assert journey.gradebook.grades() == pytest.approx(share, abs=1e-3), number
    assert journey.gradebook.refused == []
    received = len(journey.gradebook.received)
    changes = rounds * len(USERS)
    return f"{kills} kills in {rounds} rounds: {received} scores received for {changes} changes"


def _is_done(journey: Journey) -> bool:
    return set(journey.states().values()) == {"sent"}


def _wait(until: Callable[[], bool]) -> None:
    end = time.monotonic() + 2 * ANSWER
    while not until():
        assert time.monotonic() < end, "the scores do not arrive"
        time.sleep(0.05)


def test_the_service_sends_what_it_has_committed(
    journey: Journey, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A commit wakes the sending thread, long before its next regular look at the queue.
    monkeypatch.setattr("dh_grader.lti.outbox._LOOK", 3600)
    # A closed one takes no note away.
    closed = BackgroundSending(journey.tool.store.engine, journey.sender, QUEUED)
    closed.start()
    closed.close()
    sending = BackgroundSending(journey.tool.store.engine, journey.sender, QUEUED)
    sending.start()
    try:
        attempt = journey.hand_in()
        _wait(lambda: len(journey.gradebook.received) == 1)
        body = {"points": 0, "reason": "r", "author": "t"}
        journey.post(f"attempts/{attempt['id']}/override", **body)
        _wait(lambda: len(journey.gradebook.received) == 2)
    finally:
        sending.close()
    assert journey.gradebook.grades() == {"ada": 0}


def test_all_listen_before_a_thread_begins(
    catalogue: Mapping[str, Exercise], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A commit iterates over its listeners, so all of them must be added before a thread starts.
    store = AttemptStore.open(new_file(tmp_path))
    keys = KeyRing(store.engine, Secret(SECRET_TEXT))
    access = Access(OPEN_HERE, solutions=None, read_attempts=None, keys=keys)
    app = application(catalogue, access=access, store=store)
    listening: list[int] = []
    begin = threading.Thread.start

    def start(thread: threading.Thread) -> None:
        listening.append(len(store.engine.dispatch.commit))
        begin(thread)

    async def run() -> None:
        async with app.router.lifespan_context(app):
            listening.append(len(store.engine.dispatch.commit))

    monkeypatch.setattr(threading.Thread, "start", start)
    asyncio.run(run())
    # Two threads send and one writes; the last number is that of the running application.
    assert len(listening) >= 4
    assert len(set(listening)) == 1


@pytest.mark.long
def test_a_killed_sender_loses_no_score(journey: Journey, replicas: Replicas) -> None:
    killed(journey, replicas, 1)


@pytest.mark.campaign
@pytest.mark.timeout(1200)
@pytest.mark.parametrize("tool", ["sqlite", "postgresql"], indirect=True)
def test_senders_that_are_killed_twenty_times(
    journey: Journey, replicas: Replicas, figure: Callable[[str], None]
) -> None:
    kind = journey.tool.store.engine.dialect.name
    figure(f"{kind}: {killed(journey, replicas, 20)}")
