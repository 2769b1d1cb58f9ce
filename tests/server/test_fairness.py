"""Simulate how long clients wait for each other, and measure when work may give way."""

import itertools
import random
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from types import FrameType

import pytest
from dh_grader import slices as time_slices
from dh_grader.slices import FIRST_SLICE

from tests.server.simulated import ORDINARY, Process
from tests.worst.bodies import ARM, KNOWN
from tests.worst.entry_points import (
    FILE,
    GRADE,
    PREVIEW,
    Attack,
    Target,
    floor_seconds,
    forget,
)
from tests.worst.exercises import exercises

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


# The most work between two checkpoints, in floors; twice what docs/performance.md says, because of
# the machine.
STEP = 220
_PAIRS = 12_900
# Texts that only look like a table or a matrix.
_HOSTILE: Mapping[str, str] = {
    "brackets": "[" + "(" * _PAIRS + ")" * _PAIRS + "]",
    "brackets one after the other": "[" + "()" * _PAIRS + "]",
    "open brackets": "[" + "(" * 2 * _PAIRS,
    # A body may have 5,000 braces and square brackets, and 20,000 commas.
    "braces": "{" * 1_600 + "}" * 1_600,
    "square brackets": "[" * 1_600 + "]" * 1_600,
    "quotes": "['" + "''" * _PAIRS,
    "dollars": "[" + "$ $" * (_PAIRS // 2) + "]",
    "commas": "[" + "," * 6_000 + "]",
    "blanks": "[" + "1 " * _PAIRS + "]",
    "lines": "1\n" * _PAIRS,
}
BODIES: Mapping[str, Attack] = {
    **{name: each for name, each in KNOWN.items() if each.entry != FILE},
    **{
        f"a submission of {name}": Attack(
            GRADE, ARM, {"answers": dict.fromkeys(("table", "links", "pose"), text)}
        )
        for name, text in _HOSTILE.items()
    },
    **{
        f"a preview of {name}": Attack(
            PREVIEW, ARM, {"text": text, "exercise": ARM, "part": "links"}
        )
        for name, text in _HOSTILE.items()
    },
}


class _Steps:
    """Measures the processor time between two checkpoints, in place of the clock of slices."""

    def __init__(self) -> None:
        self.longest = 0.0
        self._last = time.thread_time()
        self._place = ""
        # Where the longest step ended.
        self.place = ""

    def __call__(self) -> float:
        frame = sys._getframe(1)
        # ``working_time`` looks at the clock without giving way.
        if frame.f_code.co_name in ("checkpoint", "_slice"):
            self.end(frame.f_back)
        return time.perf_counter()

    def end(self, frame: FrameType | None) -> None:
        now = time.thread_time()
        if now - self._last > self.longest:
            self.longest = now - self._last
            self.place = "" if frame is None else f"{frame.f_code.co_filename}:{frame.f_lineno}"
        self._last = now


@pytest.fixture(scope="module")
def target() -> Iterator[Target]:
    found = exercises()
    target = Target({each.exercise: found[each.exercise] for each in BODIES.values()})
    yield target
    target.close()


@pytest.mark.long
@pytest.mark.parametrize("name", BODIES)
def test_work_gives_way_before_others_have_waited_long(
    name: str, target: Target, monkeypatch: pytest.MonkeyPatch, figure: Callable[[str], None]
) -> None:
    def step() -> tuple[float, str]:
        forget()
        before = floor_seconds()
        with monkeypatch.context() as context:
            steps = _Steps()
            context.setattr(time_slices, "perf_counter", steps)
            assert target.answer(BODIES[name]) in (200, 201, 403, 404, 422)
            steps.end(None)
        return steps.longest / max(before, floor_seconds()), steps.place

    longest, place = min(step() for _ in range(3))
    where = place or "the end"
    figure(f"{name}: gives way after at most {longest:.0f} × the floor, at {where}")
    assert longest < STEP, where
