"""Test how scores are sent."""

import asyncio
import json
import random
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from dh_grader.access import OPEN_HERE, Secret
from dh_grader.access.key_ring import KeyRing
from dh_grader.api.application import application
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise
from dh_grader.lti.outbox import BackgroundSending
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import QUEUED, Priority, queue_scores
from dh_grader.store.tables import attempts, learners
from sqlalchemy import insert, select, update

from tests.access.kept_services import SECRET_TEXT
from tests.guards import ANSWER
from tests.lti.conftest import RIGHT, WRONG, Journey
from tests.lti.gradebook import AGS
from tests.lti.platform import LTI
from tests.store.databases import new_file

# --- A new score is sent before the many scores of a regrade

# 20 scores in ten seconds.
PACE = (20, 10)


def enrol_many(journey: Journey, number: int) -> None:
    [row] = journey.tool.do(lambda it: it.execute(select(attempts)).all())
    names = [f"{i:05}" for i in range(number)]
    of_platform = [
        {"registration": "moodle", "sub": f"user {name}", "learner": f"lti-{name}"}
        for name in names
    ]
    same = dict(row._mapping)
    del same["number"]
    new = [
        same | {"id": name, "learner": f"lti-{name}", "idempotency_key": f"k{name}"}
        for name in names
    ]
    journey.tool.do(lambda it: it.execute(insert(learners), of_platform))
    journey.tool.do(lambda it: it.execute(insert(attempts), new))
    chosen = attempts.c.id.in_(names)
    journey.tool.do(lambda it: queue_scores(it, chosen, Priority.REGRADE))


def sent_while(journey: Journey, ended: Callable[[], bool]) -> int:
    tries = 0
    while not ended():
        if journey.sender.send_next():
            tries += 1
            continue
        due = journey.sender.next_due()
        if due is None:
            return tries
        journey.clock.added += max(due - journey.clock.now(), journey.clock.added * 0)
    return tries


def hurried(journey: Journey, number: int) -> str:
    journey.hand_in()
    journey.send()
    enrol_many(journey, number)
    received = journey.gradebook.received
    received.clear()
    journey.gradebook.pace = PACE
    begun, worked = journey.clock.now(), datetime.now(UTC)
    tries = sent_while(journey, lambda: len(received) >= number // 2)
    journey.hand_in("grace")
    before, handed_in = len(received), journey.clock.now()
    tries += sent_while(journey, lambda: len(received) > before)
    waited = journey.clock.now() - handed_in
    assert received[before]["userId"] == "user grace"
    tries += sent_while(journey, lambda: False)
    assert {each["userId"] for each in received} >= {f"user {i:05}" for i in range(number)}
    # Each once.
    assert len(received) == number + 1
    assert tries <= (number + 1) * (1 + 2 / PACE[0]) + 2
    took = journey.clock.now() - begun
    return (
        f"{number} scores of a regrade at {PACE[0]} in {PACE[1]} s: {took.total_seconds():.0f} s "
        f"by the clock of the test, {tries} tries, in {(datetime.now(UTC) - worked).seconds} s; "
        f"a hand-in meanwhile was the next score, after {waited.total_seconds():.1f} s"
    )


@pytest.mark.long
def test_a_hand_in_goes_before_the_scores_of_a_regrade(journey: Journey) -> None:
    hurried(journey, 60)


@pytest.mark.campaign
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("tool", ["sqlite", "postgresql"], indirect=True)
def test_a_hand_in_goes_before_ten_thousand_scores(
    journey: Journey, figure: Callable[[str], None]
) -> None:
    figure(hurried(journey, 10_000))


# --- Send a score from the hand-in to the platform's gradebook

KINDS = pytest.mark.parametrize("tool", ["sqlite", "postgresql"], indirect=True)
ENDPOINT = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint"


@pytest.mark.long
@KINDS
def test_a_hand_in_an_override_and_a_forgotten_learner_arrive(journey: Journey) -> None:
    attempt = journey.hand_in()
    assert journey.send() == 1
    [message] = journey.gradebook.received
    assert message["scoreGiven"] == journey.total() > 0
    assert message["scoreMaximum"] == 10
    assert message["submission"]["submittedAt"][:19] == attempt["at"][:19]
    # Nothing waits, and nothing is sent twice.
    assert journey.send() == 0
    override = {"reason": "copied", "author": "t"}
    journey.post(f"attempts/{attempt['id']}/override", points=0, **override)
    assert journey.send() == 1
    assert journey.gradebook.grades() == {"ada": 0}
    journey.post(f"attempts/{attempt['id']}/override", points=attempt["max_points"], **override)
    assert journey.send() == 1
    assert journey.gradebook.grades() == {"ada": 100}
    known = journey.known()
    [platform], [score] = known["platforms"], known["scores"]
    assert (platform["name"], platform["sub"]) == ("Moodle of the university", "user ada")
    assert (score["sub"], score["state"], score["sent_points"]) == ("user ada", "sent", 10)
    assert journey.place() == (score["course"], score["in_assignment"])
    journey.post("learners/forget", learner=attempt["learner"], apply=True)
    assert "user ada" not in json.dumps(journey.known())
    journey.clock.go_on(seconds=3)
    [row] = journey.rows()
    assert "lti-" not in row.learner
    assert journey.send() == 1
    assert journey.gradebook.grades() == {"ada": None}
    assert journey.rows() == []


def test_only_the_best_attempt_is_sent(journey: Journey) -> None:
    # An attempt that is worse than the best, or as good, changes nothing at the platform.
    journey.hand_in(answers=WRONG)
    journey.send()
    best = journey.hand_in()
    journey.send()
    before = journey.gradebook.received[-1]
    assert before["scoreGiven"] > journey.gradebook.received[0]["scoreGiven"]
    for answers in (WRONG, RIGHT):
        journey.hand_in(answers=answers)
        journey.clock.go_on(seconds=5)
        assert journey.send() == 0
    assert journey.states() == {"ada": "sent"}
    assert before["submission"]["submittedAt"][:19] == best["at"][:19]
    assert journey.gradebook.asked.count("score") == 2


def test_more_time_gives_a_late_score_its_points_back(journey: Journey) -> None:
    # A late attempt counts half. With a later due date, its points come back.
    journey.launch()
    course, assignment = journey.place()
    path = f"courses/{course}/assignments/{assignment}"
    yesterday = datetime.now(UTC) - timedelta(days=1)
    closes = datetime.now(UTC) + timedelta(days=2)
    journey.post(path, due=yesterday.isoformat(), closes=closes.isoformat(), late_worth=0.5)
    journey.hand_in()
    journey.send()
    half = journey.gradebook.received[-1]["scoreGiven"]
    due = (datetime.now(UTC) + timedelta(days=1)).isoformat()
    journey.post(f"{path}/extensions", learner=journey.learner(), due=due)
    assert journey.send() == 1
    assert journey.gradebook.received[-1]["scoreGiven"] == pytest.approx(2 * half)
    assert journey.total() == pytest.approx(2 * half)


def test_points_of_the_assignment_that_change(journey: Journey) -> None:
    journey.hand_in()
    journey.send()
    course, assignment = journey.place()
    exercises = [{"exercise": "planar-rr", "points": 40}, {"exercise": "scara", "points": 60}]
    journey.post(f"courses/{course}/assignments/{assignment}", exercises=exercises)
    assert journey.send() == 1
    first, second = journey.gradebook.received
    assert second["scoreMaximum"] == 100
    assert second["scoreGiven"] == pytest.approx(4 * first["scoreGiven"]) == journey.total()


def test_a_regrade_queues_only_what_it_changes(journey: Journey) -> None:
    # An earlier program gave one of two learners wrong points. Only that learner is queued.
    changed = journey.hand_in("ada")
    journey.hand_in("grace")
    journey.send()
    right = journey.gradebook.grades()["ada"]
    mine = attempts.c.id == changed["id"]
    # As if an earlier program had graded both, and one of them wrongly.
    journey.tool.do(lambda it: it.execute(update(attempts).values(grader="0")))
    journey.tool.do(lambda it: it.execute(update(attempts).where(mine).values(points=0)))
    journey.post("exercises/planar-rr/regrade", apply=True)
    waiting = [each.sub for each in journey.rows() if each.state == "waiting"]
    assert waiting == ["user ada"]
    [row] = [each for each in journey.rows() if each.state == "waiting"]
    assert row.priority == 2
    # The platform has this score already.
    assert journey.send() == 0
    assert journey.gradebook.grades()["ada"] == right


def test_removed_learners_lose_their_score(journey: Journey) -> None:
    journey.hand_in()
    journey.send()
    course, _ = journey.place()
    journey.post(
        f"courses/{course}/learners/remove",
        learner=journey.learner(),
        with_attempts=True,
        apply=True,
    )
    assert journey.send() == 1
    assert journey.gradebook.grades() == {"ada": None}


def test_a_deleted_course_can_be_launched_again(journey: Journey) -> None:
    journey.hand_in()
    journey.send()
    course, assignment = journey.place()
    body = {"apply": True, "with_attempts": True}
    journey.post(f"courses/{course}/assignments/{assignment}/delete", **body)
    assert journey.rows() == []
    journey.launch()
    journey.hand_in()
    journey.post(f"courses/{course}/delete", **body)
    journey.launch()
    journey.hand_in()
    assert journey.send() == 1


def test_a_learner_who_comes_back_keeps_the_new_score(journey: Journey) -> None:
    # A forgotten learner submits again before the service has cleared the platform's score.
    journey.hand_in()
    journey.send()
    journey.post("learners/forget", learner=journey.learner(), apply=True)
    del journey.tokens["ada"]
    journey.hand_in(answers=RIGHT)
    journey.clock.go_on(seconds=5)
    journey.send()
    assert journey.gradebook.grades()["ada"] == pytest.approx(journey.total() * 10)
    assert len(journey.rows()) == 1


def test_a_learner_of_whom_nothing_was_sent_leaves_nothing(journey: Journey) -> None:
    journey.hand_in()
    journey.post("learners/forget", learner=journey.learner(), apply=True)
    assert journey.rows() == []


@pytest.mark.long
def test_a_platform_without_line_items_gets_one(journey: Journey) -> None:
    # The service makes one line item for all learners, with the title of the assignment.
    journey.tool.platform.habits.append(lambda claims: claims[ENDPOINT].pop("lineitem"))
    journey.gradebook.items.clear()
    for user in ("ada", "grace"):
        journey.hand_in(user)
    assert journey.send() == 2
    assert journey.gradebook.asked.count("new item") == 1
    [name] = journey.gradebook.items
    assert set(journey.gradebook.grades(name)) == {"ada", "grace"}
    assert journey.gradebook.items[name].label == "Homework 1"


def test_two_replicas_do_not_make_two_line_items(journey: Journey) -> None:
    journey.tool.platform.habits.append(lambda claims: claims[ENDPOINT].pop("lineitem"))
    journey.gradebook.items.clear()
    for user in ("ada", "grace"):
        journey.hand_in(user)
    other = journey.another_sender()
    tried: list[bool] = []

    def meanwhile() -> None:
        if not tried:
            tried.append(other.send_next())

    # The other replica takes a score while the first one is making the line item.
    journey.gradebook.before_item = meanwhile
    journey.send()
    assert tried == [True]
    journey.clock.go_on(seconds=5)
    journey.send()
    assert set(journey.states().values()) == {"sent"}
    assert len(journey.gradebook.items) == 1


@pytest.mark.parametrize("scopes", [["score"], ["score", "lineitem.readonly"]])
def test_a_score_is_refused_if_its_line_item_may_not_be_made(
    journey: Journey, scopes: list[str]
) -> None:
    def habit(claims: dict[str, dict[str, object]]) -> None:
        claims[ENDPOINT].pop("lineitem")
        claims[ENDPOINT]["scope"] = [f"{AGS}{each}" for each in scopes]

    journey.tool.platform.habits.append(habit)
    journey.gradebook.items.clear()
    journey.hand_in()
    journey.send()
    assert journey.states() == {"ada": "refused"}
    assert json.loads(journey.rows()[0].refusal)[0] == "no-scope"


def test_earlier_scores_are_sent_once_the_platform_takes_scores(journey: Journey) -> None:
    # When the platform begins to accept scores, scores of earlier attempts are sent, too.
    journey.tool.platform.habits.append(lambda claims: claims.pop(ENDPOINT))
    journey.hand_in()
    assert journey.rows() == []
    journey.tool.platform.habits.clear()
    journey.launch("grace")
    assert journey.send() == 1
    assert set(journey.gradebook.grades()) == {"ada"}


def test_names_that_change_change_no_score(journey: Journey) -> None:
    journey.hand_in()

    def renamed(claims: dict[str, object]) -> None:
        claims["name"] = "Ada King"
        claims[f"{LTI}context"] = {"id": "course-1", "title": "Robots"}

    journey.tool.platform.habits.append(renamed)
    journey.launch()
    journey.hand_in(answers=WRONG)
    assert journey.send() == 1
    assert len(journey.gradebook.received) == 1
    assert len(journey.tool.do(lambda it: it.execute(select(attempts)).all())) == 2


@pytest.mark.long
def test_no_timestamp_is_in_the_future(journey: Journey) -> None:
    # If a score changes often in a second, some changes wait. The platform gets the last score.
    attempt = journey.hand_in()
    for points in range(1, 7):
        body = {"points": points, "reason": "r", "author": "t"}
        journey.post(f"attempts/{attempt['id']}/override", **body)
        journey.send()
    for _ in range(5):
        journey.clock.go_on(seconds=1)
        journey.send()
    assert journey.gradebook.refused == []
    assert journey.gradebook.received[-1]["scoreGiven"] == journey.total()
    assert journey.states() == {"ada": "sent"}


def test_a_score_that_is_sent_at_once_is_not_from_before_the_attempt(journey: Journey) -> None:
    attempt = journey.hand_in()
    journey.clock.go_on(seconds=-3)
    assert journey.send() == 1
    [message] = journey.gradebook.received
    assert message["submission"]["submittedAt"][:19] == attempt["at"][:19]
    assert message["timestamp"] >= message["submission"]["submittedAt"]
    # A change within a second waits, because its timestamp must be later.
    journey.post(f"attempts/{attempt['id']}/override", points=1, reason="r", author="t")
    journey.clock.go_on(seconds=1)
    assert journey.send() == 1
    assert journey.gradebook.received[-1]["timestamp"] > message["timestamp"]


# --- Kill replicas of the service while they send scores

USERS = ("ada", "grace", "edsger", "barbara")
ROOT = Path(__file__).parents[2]


class Replicas:
    """Two processes that send scores."""

    def __init__(self, journey: Journey, folder: Path) -> None:
        self._file = folder / "added"
        module = ["-m", "tests.lti.replica"]
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
