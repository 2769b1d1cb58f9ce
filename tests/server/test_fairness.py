"""What honest clients wait beside an attacker, on the clock of a simulation."""

import itertools
import random

import pytest

from tests.server.simulated import Process

Waits = list[float]


def waits(monkeypatch: pytest.MonkeyPatch, pause: float, slow: float, *attack: object) -> Waits:
    """The waits of six honest clients, in order; ``attack`` says who attacks and how."""
    process = Process(monkeypatch)
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
    # As many requests in both.
    process.run(30.0 if pause else 5.0, *clients)
    return sorted(found)


@pytest.mark.parametrize("pause", [0.0, 0.1], ids=["in a row", "now and then"])
@pytest.mark.parametrize("slow", [1, 4], ids=["", "slow machine"])
def test_honest_clients_hardly_notice_costly_requests_on_sixteen_connections(
    monkeypatch: pytest.MonkeyPatch, pause: float, slow: int
) -> None:
    quiet = waits(monkeypatch, pause, slow)
    for address, again, gradings in itertools.product(
        ("elsewhere", "campus"), (True, False), (1, 32)
    ):
        beside = waits(monkeypatch, pause, slow, address, again, gradings)
        assert len(beside) > 0.8 * len(quiet)
        for share, most in ((0.5, 3), (0.99, 5)):
            times = beside[int(share * len(beside))] / quiet[int(share * len(quiet))]
            assert times <= most, (address, again, gradings, share)


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

    process.run(20.0, costly(1), costly(2))
    assert len(found) * 0.040 > 0.9 * 20.0
