"""Test the turns of requests."""

import asyncio
import itertools
import json
import math
import time
from collections import Counter
from collections.abc import Callable, Coroutine, Iterator
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from dh_grader.api import http as turns
from dh_grader.api.http import ARRIVED, CLIENT, COURSE_SITE, ONE_STUDENT, Client, give_way
from dh_grader.server import turns as admission
from dh_grader.server import turns as speed
from dh_grader.server.turns import (
    ALLOWANCE,
    CREDIT,
    FIRST,
    OF_ALL,
    OF_ONE,
    FairAdmission,
    FairQueue,
    Metered,
    Speed,
    Ticket,
)
from dh_grader.slices import SLICE
from dh_grader.submissions.bodies import MAX_BODY_SIZE
from starlette.requests import ClientDisconnect, Request

from tests.server.simulated import simulate_speed

# --- Clients take fair turns, and their queues are limited

Messages = list[dict[str, Any]]


class AdmissionClient:
    """A connection that sends one request and records the response."""

    def __init__(
        self, address: str, port: int = 1, body: bytes = b"{}", path: str = "/v1/preview"
    ) -> None:
        self.scope = {
            "type": "http", "method": "POST", "path": path, "headers": [], "query_string": b"",
            "client": (address, port),
        }  # fmt: skip
        self._body: list[bytes] = [body[i : i + 65536] for i in range(0, len(body), 65536)]
        self._sent = list(self._body)
        self.gone = asyncio.Event()
        self.answer: Messages = []

    def reset(self) -> None:
        self._body = list(self._sent)

    async def receive(self) -> dict[str, Any]:
        if self._body:
            part = self._body.pop(0)
            return {"type": "http.request", "body": part, "more_body": bool(self._body)}
        await self.gone.wait()
        return {"type": "http.disconnect"}

    async def send(self, message: Any) -> None:
        self.answer.append(message)

    @property
    def status(self) -> int | None:
        return self.answer[0]["status"] if self.answer else None


class Application:
    """A fake application that records the requests that it answers."""

    def __init__(self, work: Callable[[Any], None] = lambda _: None) -> None:
        self.served: list[str] = []
        self.bodies: list[bytes] = []
        self._work = work

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        body, more = b"", True
        while more:
            message = await receive()
            if message["type"] == "http.disconnect":
                return
            body += message["body"]
            more = message["more_body"]
        self.bodies.append(body)
        client = scope["client"][0]
        self.served.append(client)
        self._work(scope)
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await send({"type": "http.response.body", "body": b""})


def busy(seconds: float) -> None:
    """Use processor time for some seconds."""
    end = time.thread_time() + seconds
    while time.thread_time() < end:
        pass


def run(story: Coroutine[Any, Any, None]) -> None:
    asyncio.run(story)


def begin(app: FairAdmission, *clients: AdmissionClient) -> list["asyncio.Task[None]"]:
    return [
        asyncio.create_task(app(client.scope, client.receive, client.send)) for client in clients
    ]


async def passes(number: int) -> None:
    for _ in range(number):
        await asyncio.sleep(0)


@pytest.fixture
def alike(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = itertools.count()
    monkeypatch.setattr(admission, "thread_time", lambda: next(clock) * 1.01 * SLICE)


@pytest.mark.usefixtures("alike")
def test_a_client_does_not_wait_for_all_connections_of_another_one() -> None:
    async def story() -> None:
        inner = Application()
        app = FairAdmission(inner)
        tasks = begin(
            app,
            *(AdmissionClient("attacker", port) for port in range(16)),
            AdmissionClient("honest"),
        )
        await asyncio.gather(*tasks)
        assert inner.served[:3] == ["attacker", "attacker", "honest"]
        assert len(inner.served) == 17

    run(story())


@pytest.mark.usefixtures("alike")
def test_learners_take_turns_and_a_course_site_has_a_turn_for_each_request() -> None:
    async def story() -> None:
        inner = Application()
        app = FairAdmission(inner)
        students = [AdmissionClient("10.0.0.1", port) for port in range(8)]
        for each in students:
            each.scope[CLIENT] = turns.Client("a learner", ONE_STUDENT)
        site = [AdmissionClient("10.0.0.2", port) for port in range(8)]
        for each in site:
            each.scope[CLIENT] = turns.Client("a key that may record", COURSE_SITE)
        for _ in range(20):
            tasks = begin(app, *students, *site)
            await asyncio.gather(*tasks)
            for each in (*students, *site):
                each.reset()
        # The learner pays for eight connections as for one, the site for each of its own.
        first = inner.served[-16:][:9]
        assert first.count("10.0.0.2") >= 7

    run(story())


@pytest.mark.usefixtures("alike")
def test_requests_that_arrive_during_an_answer_are_read_before_the_next_one_begins() -> None:
    async def story() -> None:
        inner = Application()
        app = FairAdmission(inner)
        waiting = begin(app, *(AdmissionClient("attacker", port) for port in range(16)))
        served_between = []
        for _ in range(5):
            # A socket would also be read once in a pass of the event loop.
            before = len(inner.served)
            client = AdmissionClient("honest")
            await asyncio.gather(*begin(app, client))
            served_between.append(inner.served[before:].index("honest"))
        # The attacker has eight shares, and one of its requests was begun already.
        assert max(served_between) <= 9
        await asyncio.gather(*waiting)

    run(story())


@pytest.mark.usefixtures("alike")
def test_a_request_keeps_the_moment_of_its_arrival_while_it_waits() -> None:
    arrivals: list[datetime] = []
    starts: list[datetime] = []

    def work(scope: Any) -> None:
        arrivals.append(scope[ARRIVED])
        starts.append(datetime.now(UTC))
        busy(0.02)

    async def story() -> None:
        app = FairAdmission(Application(work))
        await asyncio.gather(*begin(app, *(AdmissionClient(f"10.0.0.{i}") for i in range(5))))

    run(story())
    # All of the others arrived before the second one had its turn.
    assert max(arrivals) <= starts[1]
    assert starts[4] - arrivals[4] >= timedelta(seconds=0.06)


class ManyGradings(Application):
    """A fake application that lets others run while it serves an attacker."""

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        if scope["client"][0] == "attacker":
            for _ in range(10):
                self.served.append("part")
                busy(0.02)
                await give_way(Request(scope))
        await super().__call__(scope, receive, send)


@pytest.mark.long
def test_small_requests_go_before_the_next_grading_of_a_large_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    simulate_speed(monkeypatch)

    async def story() -> None:
        inner = ManyGradings()
        app = FairAdmission(inner)
        tasks = begin(app, *(AdmissionClient("attacker", port) for port in range(4)))
        await passes(3)
        tasks += begin(app, *(AdmissionClient("honest", port) for port in range(100)))
        await asyncio.gather(*tasks)
        # Each of the four has a step at its arrival, and one has another; then all small ones come.
        first = inner.served.index("honest")
        assert first <= 5
        assert inner.served[first : first + 108].count("honest") >= 95
        assert inner.served.count("part") == 40
        assert inner.served.count("attacker") == 4

    run(story())


def test_a_request_of_many_gradings_ends_when_its_client_has_gone() -> None:
    async def story() -> None:
        inner = ManyGradings()
        app = FairAdmission(inner)
        client = AdmissionClient("attacker")
        tasks = begin(app, client)
        await passes(1)
        client.gone.set()
        [error] = await asyncio.gather(*tasks, return_exceptions=True)
        assert isinstance(error, ClientDisconnect)
        assert inner.served == ["part"]

    run(story())


@pytest.mark.usefixtures("alike")
def test_a_client_with_too_many_waiting_requests_is_refused() -> None:
    async def story() -> None:
        inner = Application()
        app = FairAdmission(inner)
        many = [AdmissionClient("many", port) for port in range(OF_ONE[0] + 11)]
        other = AdmissionClient("other")
        await asyncio.gather(*begin(app, *many, other))
        statuses = [client.status for client in many]
        # One is begun at once, and OF_ONE[0] may wait.
        assert statuses.count(200) == OF_ONE[0] + 1
        assert statuses.count(429) == 10
        assert other.status == 200
        refused = many[statuses.index(429)].answer
        headers = dict(refused[0]["headers"])
        assert headers[b"content-type"] == b"application/problem+json"
        assert 1 <= int(headers[b"retry-after"]) <= 30
        assert json.loads(refused[1]["body"])["status"] == 429

    run(story())


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("gradings", "each", "seconds"), [(1, 0.003, 2), (10, 0.003, 11), (20, 0.015, 30)]
)
def test_retry_after_grows_with_the_work_that_waits(
    monkeypatch: pytest.MonkeyPatch, gradings: int, each: float, seconds: int
) -> None:
    # A grading takes `each` seconds, and 512 requests wait.
    now = 0.0
    monkeypatch.setattr(admission, "thread_time", lambda: now)

    async def app(scope: Any, _receive: Any, send: Any) -> None:
        nonlocal now
        for i in range(gradings):
            if i:
                await give_way(Request(scope))
            now += each
        await send({"type": "http.response.start", "status": 200, "headers": []})

    async def story() -> None:
        fair = FairAdmission(app)
        for port in range(10):
            await asyncio.gather(*begin(fair, AdmissionClient("many", port)))
        await passes(3)
        many = [AdmissionClient("many", port) for port in range(OF_ONE[0] + 11)]
        await asyncio.gather(*begin(fair, *many))
        refused = [client.answer[0]["headers"] for client in many if client.status == 429]
        assert {int(dict(headers)[b"retry-after"]) for headers in refused} == {seconds}

    run(story())


@pytest.mark.usefixtures("alike")
@pytest.mark.parametrize("size", [0, 1])
def test_the_bytes_of_waiting_requests_are_bounded(
    monkeypatch: pytest.MonkeyPatch, size: int
) -> None:
    monkeypatch.setattr(admission, "OF_ONE", (1000, 3000))

    async def story() -> None:
        app = FairAdmission(Application())
        clients = [AdmissionClient("a", port, b" " * (1000 + size)) for port in range(4)]
        await asyncio.gather(*begin(app, *clients))
        assert [client.status for client in clients].count(429) == size

    run(story())


@pytest.mark.usefixtures("alike")
def test_the_service_refuses_requests_when_too_many_wait() -> None:
    async def story() -> None:
        app = FairAdmission(Application())
        clients = [AdmissionClient(f"10.0.0.{i}") for i in range(OF_ALL[0] + 2)]
        await asyncio.gather(*begin(app, *clients))
        statuses = [client.status for client in clients]
        assert (statuses.count(200), statuses.count(503)) == (OF_ALL[0] + 1, 1)
        assert b"retry-after" in dict(clients[statuses.index(503)].answer[0]["headers"])

    run(story())


@pytest.mark.usefixtures("alike")
def test_health_checks_do_not_wait_for_other_requests() -> None:
    async def story() -> None:
        inner = Application()
        app = FairAdmission(inner)
        tasks = begin(app, *(AdmissionClient("a", port) for port in range(5)))
        tasks += begin(app, AdmissionClient("supervisor", path="/healthz"))
        await passes(1)
        assert inner.served == ["a", "supervisor"]
        await asyncio.gather(*tasks)

    run(story())


@pytest.mark.usefixtures("alike")
def test_small_answers_do_not_delay_other_requests(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(admission, "OF_ONE", (1, 10**6))

    async def story() -> None:
        inner = Application()
        app = FairAdmission(inner)
        many = [AdmissionClient("many", port) for port in range(40)]
        asking = [AdmissionClient("many", port, path="/healthz") for port in range(40)]
        other = [AdmissionClient("other"), AdmissionClient("third")]
        tasks = begin(app, *many, *asking, *other)
        while other[1].status is None:
            await passes(1)
        # Three submissions are served, one after the other, and with each of them four health
        # checks and four refusals: health checks do not wait for refusals.
        for clients in (many, asking):
            answered = sum(client.status is not None for client in clients)
            assert 2 * 4 <= answered <= 5 * 4
        await asyncio.gather(*tasks)
        assert [client.status for client in many].count(429) == 38
        assert {client.status for client in asking} == {200}

    run(story())


@pytest.mark.usefixtures("alike")
def test_a_client_that_has_gone_is_not_served() -> None:
    async def story() -> None:
        inner = Application()
        app = FairAdmission(inner)
        gone = AdmissionClient("gone")
        gone.gone.set()
        await asyncio.gather(*begin(app, AdmissionClient("a"), AdmissionClient("b"), gone))
        assert inner.served == ["a", "b"]

    run(story())


@pytest.mark.usefixtures("alike")
def test_a_cancelled_request_does_not_stop_the_others() -> None:
    async def story() -> None:
        inner = Application()
        app = FairAdmission(inner)
        tasks = begin(app, *(AdmissionClient(name) for name in "abc"))
        await passes(1)
        tasks[1].cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        assert inner.served == ["a", "c"]

    run(story())


@pytest.mark.usefixtures("alike")
def test_a_request_that_waits_when_the_process_ends_is_given_up_without_an_error() -> None:
    async def story() -> None:
        inner = Application()
        clients = [AdmissionClient(name) for name in "abc"]
        tasks = begin(FairAdmission(inner), *clients)
        await passes(1)
        clients[1].gone.set()
        tasks[1].cancel()
        assert await asyncio.gather(*tasks, return_exceptions=True) == [None, None, None]
        assert inner.served == ["a", "c"]

    run(story())


@pytest.mark.parametrize("size", [0, 2, 65537, MAX_BODY_SIZE, MAX_BODY_SIZE + 1, 3 * 10**6])
def test_the_application_reads_the_body_as_it_was_sent(size: int) -> None:
    async def story() -> None:
        inner = Application()
        body = bytes(range(256)) * (size // 256) + b"x" * (size % 256)
        client = AdmissionClient("a", body=body)
        client._body = client._body or [b""]
        await asyncio.gather(*begin(FairAdmission(inner), client))
        assert inner.bodies == [body]

    run(story())


def test_an_error_of_the_application_is_raised_and_the_next_request_is_served() -> None:
    class Broken(Application):
        async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
            if scope["client"][0] == "broken":
                raise ZeroDivisionError
            await super().__call__(scope, receive, send)

    async def story() -> None:
        inner = Broken()
        tasks = begin(FairAdmission(inner), AdmissionClient("broken"), AdmissionClient("a"))
        failed, _ = await asyncio.gather(*tasks, return_exceptions=True)
        assert isinstance(failed, ZeroDivisionError)
        assert inner.served == ["a"]

    run(story())


def test_only_the_time_of_the_request_itself_is_measured() -> None:
    async def steps() -> None:
        busy(0.02)
        await asyncio.sleep(0)
        busy(0.02)
        with pytest.raises(KeyError):
            await asyncio.wait_for(failing(), 5)

    async def failing() -> None:
        await asyncio.sleep(0.001)
        raise KeyError

    async def others() -> None:
        busy(0.2)

    async def measured() -> float:
        metered = Metered(steps())
        other = asyncio.ensure_future(others())
        await metered
        await other
        return metered.spent

    assert 0.04 <= asyncio.run(measured()) < 0.15


# --- Test the order of waiting requests

SHARES = 8.0
STEP = 0.004
# The time of an ordinary request.
ORDINARY = 0.015


def come(
    queue: FairQueue, client: str, connection: int = 1, size: int = 1, shares: float = SHARES
) -> Ticket:
    ticket = Ticket(Client(client, shares), connection, size)
    queue.enter(ticket)
    queue.push(ticket)
    return ticket


def serve(queue: FairQueue, costs: dict[str, float], turns: int) -> list[str]:
    served = []
    for _ in range(turns):
        ticket = queue.pop()
        served.append(ticket.client.name)
        queue.charge(ticket, costs[ticket.client.name])
        queue.push(ticket)
    return served


def test_clients_with_equal_costs_take_turns() -> None:
    queue = FairQueue(ORDINARY)
    for client in "abc":
        come(queue, client)
    assert "".join(serve(queue, dict.fromkeys("abc", STEP), 9)) == "abcabcabc"


def test_clients_have_the_same_time_and_not_the_same_number_of_turns() -> None:
    queue = FairQueue(ORDINARY)
    for client in "ab":
        come(queue, client)
    served = Counter(serve(queue, {"a": 0.010, "b": 0.001}, 1100))
    assert served["a"] == pytest.approx(100, rel=0.1)


@pytest.mark.parametrize(
    ("shares", "connections", "expected"),
    [(8.0, 4, 4), (8.0, 16, 8), (1.0, 16, 1), (math.inf, 16, 16)],
    ids=["a small class", "an address beyond its shares", "one student", "a course site"],
)
def test_a_client_has_a_share_for_each_connection_up_to_a_number(
    shares: float, connections: int, expected: int
) -> None:
    queue = FairQueue(ORDINARY)
    for connection in range(1, connections + 1):
        come(queue, "many", connection, shares=shares)
    come(queue, "one")
    served = Counter(serve(queue, {"many": STEP, "one": STEP}, 3000))
    assert served["many"] / served["one"] == pytest.approx(expected, rel=0.1)


def test_indistinguishable_connections_share_their_shares() -> None:
    queue = FairQueue(ORDINARY)
    for _ in range(4):
        come(queue, "behind a proxy", 0)
    come(queue, "one")
    served = Counter(serve(queue, {"behind a proxy": STEP, "one": STEP}, 3000))
    assert served["behind a proxy"] / served["one"] == pytest.approx(4, rel=0.1)


def test_a_connection_that_was_idle_has_a_limited_credit() -> None:
    queue = FairQueue(ORDINARY)
    away = come(queue, "away")
    queue.pop()
    queue.charge(away, STEP)
    queue.leave(away)
    come(queue, "here")
    serve(queue, {"here": STEP}, 1000)
    come(queue, "away")
    served = serve(queue, {"here": STEP, "away": STEP}, 100)
    assert set(served[:20]) == {"away"}
    first = served.index("here")
    # Work within the allowance is not charged before the next request; the first one left a part.
    allowed = (FIRST + ALLOWANCE) * ORDINARY - STEP
    assert first * STEP == pytest.approx(CREDIT + allowed, rel=0.1)
    assert Counter(served[first:])["away"] == pytest.approx((100 - first) / 2, abs=2)


def test_ordinary_requests_run_in_the_order_in_which_they_came() -> None:
    queue = FairQueue(ORDINARY)
    served = []
    for _ in range(4):
        left = dict.fromkeys("abc", 5)
        order = ""
        tickets = []
        for client in left:
            tickets.append(come(queue, client))
            # Time passes between two arrivals.
            queue._now += 0.001
        while queue.length:
            ticket = queue.pop()
            order += ticket.client.name
            queue.charge(ticket, STEP)
            left[ticket.client.name] -= 1
            if left[ticket.client.name]:
                queue.push(ticket)
        for ticket in tickets:
            queue.leave(ticket)
        served.append(order)
    # For its first request, a connection has a smaller allowance.
    assert served[0] != "aaaaabbbbbccccc"
    assert served[-1] == "aaaaabbbbbccccc"


def test_costly_requests_one_after_the_other_give_way_after_each_step() -> None:
    queue = FairQueue(ORDINARY)
    for _ in range(3):
        come(queue, "costly")
        ticket = queue.pop()
        queue.charge(ticket, 15 * STEP)
        queue.leave(ticket)
    come(queue, "costly")
    come(queue, "other")
    served = serve(queue, {"costly": STEP, "other": STEP}, 20)
    # The first request of the other one is ordinary.
    assert served.count("other") == pytest.approx((20 + ORDINARY / STEP) / 2, abs=2)


def test_no_request_waits_for_ever_for_new_connections() -> None:
    queue = FairQueue(ORDINARY)
    long = come(queue, "long")
    queue.charge(queue.pop(), 0.050)
    queue.push(long)
    for number in range(2, 1000):
        come(queue, "many", number)
        ticket = queue.pop()
        if ticket is long:
            break
        queue.charge(ticket, STEP)
        queue.leave(ticket)
    assert number < 60


def test_requests_of_one_connection_are_served_in_order() -> None:
    queue = FairQueue(ORDINARY)
    tickets = [come(queue, "a") for _ in range(3)]
    assert [queue.pop() for _ in range(3)] == tickets
    with pytest.raises(ValueError, match="empty"):
        queue.pop()


def test_a_request_that_is_given_up_leaves_the_others() -> None:
    queue = FairQueue(ORDINARY)
    tickets = [come(queue, client) for client in "abc"]
    queue.remove(tickets[0])
    queue.leave(tickets[0])
    assert [queue.pop(), queue.pop()] == tickets[1:]
    assert (queue.length, queue.size) == (0, 0)


def test_requests_and_bytes_are_counted_by_client() -> None:
    queue = FairQueue(ORDINARY)
    tickets = [come(queue, "a", 1, 100), come(queue, "a", 2, 50), come(queue, "b", 1, 7)]
    of = [queue.waiting(Client(name, SHARES)) for name in "abc"]
    assert of == [(2, 150), (1, 7), (0, 0)]
    assert (queue.length, queue.size) == (3, 157)
    for _ in tickets:
        queue.leave(queue.pop())
    assert (queue.length, queue.size, queue.waiting(Client("a", SHARES))) == (0, 0, (0, 0))


def test_the_number_of_accounts_is_bounded() -> None:
    queue = FairQueue(ORDINARY)
    for number in range(5_000):
        ticket = come(queue, f"client {number}", number)
        queue.charge(queue.pop(), 0.001)
        queue.leave(ticket)
    assert len(queue._accounts) <= 2_001
    assert not queue._clients


def test_a_slow_machine_lets_the_same_requests_run_to_their_end() -> None:
    orders = []
    for slower in (1, 3):
        queue = FairQueue(slower * ORDINARY)
        for client in "ab":
            come(queue, client)
            # Time passes between two arrivals.
            queue._now += 0.001
        orders.append("".join(serve(queue, dict.fromkeys("ab", slower * STEP), 12)))
    assert orders[0] == orders[1]
    assert orders[0].startswith("aaa")


# --- Estimate the processing time of an ordinary request


@pytest.fixture
def measured(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    times = [1e-4]

    def ticks() -> Iterator[float]:
        while True:
            yield times.pop(0) if len(times) > 1 else times[0]

    ticking = ticks()
    monkeypatch.setattr(speed, "_measured", lambda: next(ticking))
    return times


def test_a_machine_of_half_the_speed_takes_twice_as_long(measured: list[float]) -> None:
    fast = Speed().ordinary
    measured[0] *= 2
    assert Speed().ordinary == pytest.approx(2 * fast)


def test_a_few_slow_moments_do_not_count(measured: list[float]) -> None:
    quiet = Speed().ordinary
    measured[:0] = [1e-2] * 10
    assert Speed().ordinary == quiet


def test_a_machine_that_becomes_slower_is_noticed(measured: list[float]) -> None:
    estimate = Speed()
    fast = estimate.ordinary
    measured[0] *= 3
    for _ in range(1000):
        estimate.after_request()
    assert estimate.ordinary == pytest.approx(3 * fast)


def test_an_ordinary_request_takes_some_milliseconds() -> None:
    assert 0.001 < Speed().ordinary < 1.0
