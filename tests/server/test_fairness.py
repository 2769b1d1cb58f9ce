"""Simulate how long clients wait for each other."""

import itertools
import random

import pytest

from service.time_slices import FIRST_SLICE
from tests.server.simulated import ORDINARY, Process

Waits = list[float]
# Seconds of a grading of the costliest body.
COSTLIEST = 0.060

# Seconds of gradings of wrong tables, from the quickest twentieth to the slowest; one in 200 takes
# seven times as long as the mean.
WRONG = [0.0006, 0.0007, 0.0009, 0.0012, 0.0019, 0.0025, 0.003, 0.0037, 0.0044, 0.0053, 0.0062]
WRONG += [0.0075, 0.009, 0.010, 0.0109, 0.012, 0.0135, 0.0158, 0.0189, 0.024]
WRONG = 10 * WRONG[:-1] + 9 * WRONG[-1:] + [0.050]


def cost(choose: random.Random) -> float:
    """Return the random duration of a grading in seconds."""
    right = choose.random() < 0.5
    return 0.001 if right else choose.choice([0.002, 0.003, 0.003, 0.004, 0.004, 0.006, 0.015])


def waits(
    monkeypatch: pytest.MonkeyPatch, pause: float, step: float, *attack: object, apart: bool = False
) -> Waits:
    """Return the sorted waiting times of six honest clients."""
    # If `attack` has the parameters of `attacker`, sixteen attackers send requests, too. The honest
    # clients share one address unless `apart`.
    process = Process(monkeypatch, step)
    ports = itertools.count(1000)
    found: Waits = []

    async def honest(number: int) -> None:
        choose = random.Random(number)
        address = f"student {number}" if apart else "campus"
        for turn in itertools.count():
            seconds = await process.ask(address, number, 600, cost(choose))
            # A new connection has no credit.
            found.extend([seconds] if turn else [])
            await process.pause(pause)

    async def attacker(number: int, address: str, again: bool, gradings: int) -> None:
        while True:
            port = 500 + number if again else next(ports)
            where = address.format(number)
            await process.ask(where, port, 4000 * gradings, *[COSTLIEST] * gradings)

    clients = [honest(number) for number in range(6)]
    if attack:
        clients += [attacker(number, *attack) for number in range(16)]  # type: ignore[arg-type]
    process.run({0.0: 5.0, 0.1: 12.0, 3.0: 120.0}[pause], *clients)
    return sorted(found)


@pytest.mark.long
@pytest.mark.parametrize("apart", [False, True], ids=["one address", "six addresses"])
@pytest.mark.parametrize("pause", [0.0, 0.1, 3.0], ids=["no pause", "short pause", "long pause"])
def test_costly_requests_on_sixteen_connections_hardly_delay_honest_clients(
    monkeypatch: pytest.MonkeyPatch, pause: float, apart: bool
) -> None:
    quiet = waits(monkeypatch, pause, 0.004, apart=apart)
    for address, again, gradings in (
        ("elsewhere", True, 1), ("elsewhere", False, 32), ("elsewhere {}", True, 1),
        ("elsewhere {}", False, 32), ("campus", True, 32), ("campus", False, 1),
    ):  # fmt: skip
        attacked = waits(monkeypatch, pause, 0.004, address, again, gradings, apart=apart)
        ratio = attacked[int(0.99 * len(attacked))] / quiet[int(0.99 * len(quiet))]
        assert ratio <= 5, (address, again, gradings, ratio)


@pytest.mark.long
@pytest.mark.parametrize("slower", [0.7, 1.0, 2.5])
def test_99_percent_of_wrong_tables_on_eight_connections_wait_for_at_most_twenty_gradings(
    monkeypatch: pytest.MonkeyPatch, slower: float
) -> None:
    process = Process(monkeypatch, 0.002, slower)
    found: Waits = []

    async def student(number: int) -> None:
        choose = random.Random(number)
        while True:
            seconds = slower * choose.choice(WRONG)
            found.append(await process.ask("campus", number, 600, seconds))

    process.run(60.0, *map(student, range(1, 9)))
    mean = slower * sum(WRONG) / len(WRONG)
    assert sorted(found)[int(0.99 * len(found))] <= 20 * mean


@pytest.mark.long
def test_a_batch_takes_as_long_as_its_submissions_one_after_the_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def seconds(*batches: int) -> float:
        process = Process(monkeypatch)
        ends: Waits = []

        async def autograder() -> None:
            for number in batches:
                await process.ask("autograder", 1, 600, *[ORDINARY] * number)
            ends.append(process.now)

        async def other(number: int, address: str) -> None:
            while True:
                await process.ask(address, number, 600, COSTLIEST)

        others = [other(number, f"other {number % 4}") for number in range(1, 17)]
        process.run(30.0, autograder(), *others)
        return ends[0]

    assert seconds(64) == pytest.approx(seconds(*[1] * 64), rel=0.1)


def test_the_processor_is_never_idle_while_a_request_waits(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    process = Process(monkeypatch)
    work = 0.0

    async def student(number: int) -> None:
        nonlocal work
        choose = random.Random(number)
        while True:
            seconds = cost(choose)
            await process.ask("course server", number, 600, seconds)
            work += seconds

    process.run(30.0, *map(student, range(8)))
    assert work == pytest.approx(30.0, rel=0.01)


def test_a_class_at_once_is_answered_within_the_time_of_its_gradings(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    process = Process(monkeypatch)
    choose = random.Random(1)
    costs = [cost(choose) for _ in range(120)]
    found: Waits = []

    async def student(number: int) -> None:
        found.append(await process.ask("campus", number, 600, costs[number]))

    process.run(10.0, *map(student, range(120)))
    assert len(found) == 120
    # The first request runs for a slice before the others come.
    assert max(found) == pytest.approx(sum(costs), abs=1.5 * FIRST_SLICE)


@pytest.mark.long
def test_a_costly_answer_waits_no_longer_than_its_share(monkeypatch: pytest.MonkeyPatch) -> None:
    process = Process(monkeypatch)
    found: Waits = []

    async def ordinary(number: int) -> None:
        while True:
            await process.ask("campus", number, 600, 0.001)

    async def costly(number: int, address: str) -> None:
        while True:
            seconds = await process.ask(address, number, 4000, COSTLIEST)
            if address == "student":
                found.append(seconds)

    attackers = [costly(number, "attacker") for number in range(16)]
    process.run(20.0, *map(ordinary, range(6)), *attackers, costly(1, "student"))
    # One share of fifteen: six of the campus, eight of the attacker, and the student's own.
    assert max(found) < 15 * COSTLIEST * 1.2


@pytest.mark.parametrize(
    ("trusted", "expected"),
    # 46 equal shares, of which 30 are the site's; or 24, of which an address has eight.
    [(True, 0.3 * 46 / 30), (False, 0.3 * 24 / 8)],
    ids=["a course site", "an address"],
)
def test_a_course_site_has_a_share_for_each_student(
    monkeypatch: pytest.MonkeyPatch, trusted: bool, expected: float
) -> None:
    process = Process(monkeypatch)
    ends: Waits = []

    async def student(number: int) -> None:
        await process.ask("site", number, 600, 0.010, trusted=trusted)
        ends.append(process.now)

    async def other(number: int) -> None:
        while True:
            await process.ask(f"other {number}", 1, 600, 0.010)

    process.run(5.0, *map(student, range(1, 31)), *map(other, range(16)))
    assert len(ends) == 30
    # The last ones of an address, fewer than eight, have fewer shares.
    assert ends[-1] == pytest.approx(expected, rel=0.2)
