"""Who is next, of the requests that wait."""

from collections import Counter

import pytest

from service.server.fair_queue import FairQueue, Ticket


def wait(queue: FairQueue, client: str, connection: int = 0, size: int = 1) -> Ticket:
    ticket = Ticket(client, connection, size)
    queue.push(ticket)
    return ticket


def take(queue: FairQueue) -> Ticket:
    ticket = queue.pop()
    queue.begin(ticket)
    return ticket


def serve(queue: FairQueue, costs: dict[str, float], turns: int) -> list[str]:
    """Serve for so many turns clients that ask again at once, and say whose turns they were."""
    served = []
    for _ in range(turns):
        ticket = take(queue)
        served.append(ticket.client)
        queue.charge(ticket, costs[ticket.client])
        queue.push(ticket)
    return served


def test_clients_alike_come_in_turn() -> None:
    queue = FairQueue()
    for client in "abc":
        wait(queue, client)
    assert "".join(serve(queue, dict.fromkeys("abc", 0.001), 9)) == "abcabcabc"


def test_sixteen_connections_have_one_turn() -> None:
    queue = FairQueue()
    for connection in range(16):
        wait(queue, "many", connection)
    queue.charge(take(queue), 0.002)
    wait(queue, "one")
    assert queue.pop().client == "one"


def test_clients_have_the_same_time_and_not_the_same_number_of_turns() -> None:
    queue = FairQueue()
    for client in "ab":
        wait(queue, client)
    served = Counter(serve(queue, {"a": 0.010, "b": 0.001}, 1100))
    # What each weighs at least comes on top.
    assert served["a"] == pytest.approx(100, rel=0.1)


def test_connections_of_one_address_are_told_apart() -> None:
    queue = FairQueue()
    for connection in range(16):
        wait(queue, "campus", connection)
    for connection in range(100, 106):
        wait(queue, "campus", connection)
    costly = 0
    for _ in range(3000):
        ticket = take(queue)
        attacks = isinstance(ticket.connection, int) and ticket.connection < 16
        costly += attacks
        queue.charge(ticket, 0.040 if attacks else 0.0015)
        queue.push(ticket)
    # Each of the six has 0.7 s, and each of the sixteen as much in the end.
    assert costly == pytest.approx(16 * 0.0015 / 0.040 * 3000 / 6, rel=0.2)


def test_who_was_away_has_no_credit() -> None:
    queue = FairQueue()
    wait(queue, "here")
    serve(queue, {"here": 0.004}, 100)
    wait(queue, "new")
    served = serve(queue, {"here": 0.004, "new": 0.004}, 10)
    assert Counter(served) == {"here": 5, "new": 5}


def test_one_connection_is_served_in_order() -> None:
    queue = FairQueue()
    tickets = [wait(queue, "a", 1) for _ in range(3)]
    assert [queue.pop() for _ in range(3)] == tickets
    with pytest.raises(IndexError):
        queue.pop()


def test_requests_and_bytes_are_counted_by_client() -> None:
    queue = FairQueue()
    wait(queue, "a", 1, 100)
    wait(queue, "a", 2, 50)
    wait(queue, "b", 1, 7)
    assert (queue.of("a"), queue.of("b"), queue.of("c")) == ((2, 150), (1, 7), (0, 0))
    assert (len(queue), queue.size) == (3, 157)
    for _ in range(3):
        queue.pop()
    assert (len(queue), queue.size, queue.of("a")) == (0, 0, (0, 0))


def test_accounts_of_many_clients_take_no_room() -> None:
    queue = FairQueue()
    for number in range(3_000):
        wait(queue, f"client {number}", number)
        queue.charge(take(queue), 0.001)
    for number in range(3_000):
        wait(queue, "one", number)
        queue.charge(take(queue), 0.001)
    assert len(queue._clients.spent) <= 1001
    assert len(queue._connections) <= 1001
    assert all(len(accounts.spent) <= 1001 for accounts in queue._connections.values())
