"""What honest clients wait beside an attacker, on the clock of a simulation."""

import itertools
import random

import pytest

from service.server import costs
from tests.server.simulated import Process

Waits = list[float]


def waits(monkeypatch: pytest.MonkeyPatch, pause: float, slow: float, *attack: object) -> Waits:
    """The waits of six honest clients, in order; ``attack`` says who attacks and how."""
    process = Process(monkeypatch, slow)
    ports = itertools.count(1000)
    found: Waits = []

    async def honest(number: int) -> None:
        choose = random.Random(number)
        while True:
            # One in three is wrong, and has a diagnosis.
            dear = choose.random() < 1 / 3
            cost = choose.choice([0.0017, 0.002, 0.003, 0.0068]) if dear else 0.0005
            size = choose.randrange(600, 700)
            found.append(await process.ask("campus", number, size, slow * cost))
            await process.pause(pause)

    async def attacker(number: int, address: str, again: bool, gradings: int) -> None:
        while True:
            port = 500 + number if again else next(ports)
            await process.ask(address, port, 4000 * gradings, *[slow * 0.040] * gradings)

    clients = [honest(number) for number in range(6)]
    if attack:
        clients += [attacker(number, *attack) for number in range(16)]  # type: ignore[arg-type]
    process.run({0.0: 5.0, 0.1: 30.0, 3.0: 250.0}[pause], *clients)
    return sorted(found)


@pytest.mark.parametrize(
    ("pause", "slow"),
    [(0.0, 1), (0.1, 1), (3.0, 1), (0.0, 4), (0.1, 4)],
    ids=["in a row", "now and then", "seldom", "slow, in a row", "slow, now and then"],
)
def test_honest_clients_hardly_notice_costly_requests_on_sixteen_connections(
    monkeypatch: pytest.MonkeyPatch, pause: float, slow: int
) -> None:
    quiet = waits(monkeypatch, pause, slow)
    for address, again, gradings in (
        ("elsewhere", True, 1), ("elsewhere", False, 32), ("campus", True, 32), ("campus", False, 1)
    ):  # fmt: skip
        beside = waits(monkeypatch, pause, slow, address, again, gradings)
        assert len(beside) > 0.8 * len(quiet)
        for share, most in ((0.5, 3), (0.99, 5)):
            times = beside[int(share * len(beside))] / quiet[int(share * len(quiet))]
            assert times <= most, (address, again, gradings, share)


def test_an_honest_submission_that_is_taken_for_costly_waits_for_few_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    process = Process(monkeypatch)
    found: Waits = []

    async def ordinary(number: int) -> None:
        while True:
            await process.ask("campus", number, 600, 0.001)
            await process.pause(0.1)

    async def long(number: int) -> None:
        while True:
            found.append(await process.ask("campus", number, 600, 0.025))
            await process.pause(0.5)

    async def attacker(number: int) -> None:
        while True:
            await process.ask("campus", 500 + number, 4000, 0.080)

    process.run(30.0, *map(ordinary, range(5)), long(6), *map(attacker, range(16)))
    # For a costlier one at most, and for half the rest after it.
    assert max(found) < 0.025 + 0.080 + 0.5 * 9 * 0.080 + 0.02


@pytest.mark.parametrize("slow", [1, 4], ids=["", "slow machine"])
def test_without_an_attacker_nobody_waits_longer_than_in_turn(
    monkeypatch: pytest.MonkeyPatch, slow: int
) -> None:
    here = waits(monkeypatch, 0.0, slow)
    monkeypatch.setattr(costs, "_COSTLY", float("inf"))
    assert here == waits(monkeypatch, 0.0, slow)


def test_a_costly_submission_is_answered_in_the_end_beside_others_like_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    process = Process(monkeypatch)
    found: Waits = []

    async def ordinary(number: int) -> None:
        while True:
            await process.ask("campus", number, 600, 0.001)

    async def costly(number: int, address: str) -> None:
        while True:
            seconds = await process.ask(address, number, 4000, 0.040)
            if address == "student":
                found.append(seconds)

    attackers = [costly(number, "attacker") for number in range(16)]
    process.run(20.0, *map(ordinary, range(6)), *attackers, costly(1, "student"))
    # In turn with the attacker, with the longest rest between any two.
    assert len(found) >= 4
    assert max(found) < 5.0


def test_costly_submissions_need_no_rest_where_nobody_else_comes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    process = Process(monkeypatch)
    found: Waits = []

    async def costly(number: int) -> None:
        while True:
            found.append(await process.ask("course", number, 4000, 0.040))

    process.run(60.0, costly(1), costly(2))
    # Only the first ten seconds after what might have been ordinary ones.
    assert len(found) * 0.040 > 0.8 * 60.0
