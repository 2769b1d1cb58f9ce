"""Test the order of waiting requests."""

import math
from collections import Counter

import pytest
from dh_grader.api.http import Client
from dh_grader.server.turns import ALLOWANCE, CREDIT, FIRST, FairQueue, Ticket

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
