"""Who is next, of the requests that wait."""

from collections import Counter

import pytest

from service.server.fair_queue import HEAVIEST, LEAST, LIGHT, FairQueue, Ticket, weight


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


def test_costly_requests_leave_room_for_hundreds_of_small_ones() -> None:
    queue = FairQueue()
    for connection in range(16):
        wait(queue, "attacker", connection)
    for client in "abcdef":
        wait(queue, client)
    served = serve(queue, {"attacker": 0.040, **dict.fromkeys("abcdef", 0.0015)}, 3000)
    # 40 ms weigh 320 ms: each of six others has as much before it is the attacker's turn again.
    assert Counter(served)["attacker"] in (2, 3)
    assert min(Counter(served)[client] for client in "abcdef") >= 490


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
    # By time alone it would be 16 turns of 22 of the time: 290.
    assert 16 <= costly <= 48


def test_nobody_waits_for_ever() -> None:
    queue = FairQueue()
    wait(queue, "heavy")
    queue.charge(take(queue), 1000.0)
    wait(queue, "heavy")
    wait(queue, "light")
    served = serve(queue, {"heavy": 1000.0, "light": 0.002}, 600)
    assert Counter(served)["heavy"] >= 1
    assert served.index("heavy") <= HEAVIEST / 0.002 + 1


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
    with pytest.raises(ValueError, match="empty"):
        queue.pop()


def test_the_weight_grows_faster_than_the_time() -> None:
    assert weight(0.0) == LEAST
    assert weight(LIGHT / 2) == LIGHT / 2
    assert weight(4 * LIGHT) == pytest.approx(16 * LIGHT)
    assert weight(10.0) == HEAVIEST


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
