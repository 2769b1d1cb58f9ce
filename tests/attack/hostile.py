"""Generate random texts, grids and requests, and check how the program reads them."""

# The program reads many texts one after the other, and every fifth text twice in a row. Then it
# reads each text again with empty caches. It must read the same text in the same way each time, and
# may raise only documented errors.

import json
import re
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from functools import cached_property
from hashlib import blake2b
from heapq import nlargest
from random import Random
from statistics import median
from typing import Final, NamedTuple

from tests.attack import bodies
from tests.attack.in_process import InProcess, Post, caches
from tests.benchmarks.floors import stanford_pose
from tests.expressions.fuzzing import next_outcome, texts
from tests.pasting import test_hostile as grids

# The shares of the kinds of cases; a request costs as much as fifty texts.
GRIDS: Final = 0.08
SUBMISSIONS: Final = 0.01
PREVIEWS: Final = 0.01
# One in this number of cases is read twice in a row.
TWICE: Final = 5
# The number of the costliest cases that are kept.
COSTLIEST: Final = 20


class Case(NamedTuple):
    """A text, a grid or a request for the program to read."""

    kind: str
    value: str | Post
    degrees: bool = False

    def __str__(self) -> str:
        value = self.value
        shown = repr(value) if isinstance(value, str) else f"{value.path} {value.body!r}"
        return f"{self.kind}{' in degrees' if self.degrees else ''}: {shown[:600]}"


class Costly(NamedTuple):
    """A text, grid or request, and the cost of reading it."""

    ratio: float
    case: Case


@dataclass
class Found:
    """The results of reading many texts, grids and requests."""

    count: int = 0
    outcomes: Counter[str] = field(default_factory=Counter)
    escaped: list[str] = field(default_factory=list)
    differing: list[str] = field(default_factory=list)
    costliest: list[Costly] = field(default_factory=list)

    def add(self, other: "Found") -> None:
        self.count += other.count
        self.outcomes += other.outcomes
        self.escaped += other.escaped
        self.differing += other.differing
        self.costliest = nlargest(
            COSTLIEST, self.costliest + other.costliest, key=lambda each: each.ratio
        )


def cases(count: int, seed: str) -> Iterator[Case]:
    """Yield random texts, grids and requests."""
    random = Random(seed)
    single = texts(count, random.getrandbits(60))
    for _ in range(count):
        kind, degrees = random.random(), random.random() < 0.5
        if kind < SUBMISSIONS:
            yield Case("submission", bodies.submission(random))
        elif kind < SUBMISSIONS + PREVIEWS:
            yield Case("preview", bodies.preview(random))
        elif kind < SUBMISSIONS + PREVIEWS + GRIDS:
            yield Case("grid", _grid(random))
        else:
            yield Case("text", next(single), degrees)


def _grid(random: Random) -> str:
    if random.random() < 0.3:
        return "".join(random.choices(grids.FRAGMENTS, k=random.randint(1, 60)))
    if random.random() < 0.5:
        model = bodies.drawn_model(random)
        answer = random.choice(list(model.answers.values()))
        rows = bodies.rows_of(bodies.spoiled(answer, random, 0.1))
        if rows:
            return bodies.pasted(rows, random)
    text = random.choice(grids.SEEDS)
    for _ in range(random.randint(1, 6)):
        at = random.randint(0, len(text))
        put = random.choice(grids.FRAGMENTS)
        text = text[:at] + put + text[at + random.choice((0, 0, 1, 5, 12)) :]
    return text


class Reading:
    """Reads texts, grids and requests with the program, in this process."""

    @cached_property
    def service(self) -> InProcess:
        return InProcess()

    def close(self) -> None:
        self.service.close()

    def outcome(self, case: Case) -> tuple[str, bytes, float]:
        start = time.process_time()
        if isinstance(case.value, Post):
            status, body = self.service.post(case.value)
            seconds = time.process_time() - start
            assert status < 500, body
            json.loads(body)
            # A problem contains the request id, which differs for each request.
            return f"{case.kind} {status}", _digest(_REQUEST_ID.sub(b"", body)), seconds
        if case.kind == "grid":
            one, several = grids.outcome(case.value), grids.outcomes(case.value)
            seconds = time.process_time() - start
            grids.check_places(case.value, one, several)
            named = "refused" if isinstance(one, tuple) else "read"
            return f"grid {named}", _digest(repr((one, several)).encode(*_CODEC)), seconds
        fingerprint, seconds = next_outcome(case.value, degrees=case.degrees)
        # An error has four items: a code, a message, a span and a suggestion.
        named = f"refused: {fingerprint[0]}" if len(fingerprint) == 4 else "read"
        return f"text {named}", _digest(repr(fingerprint).encode(*_CODEC)), seconds


_REQUEST_ID: Final = re.compile(rb'"request_id": ?"[0-9a-f]{32}"')
_CODEC: Final = ("utf-8", "backslashreplace")


def _digest(data: bytes) -> bytes:
    return blake2b(data, digest_size=16).digest()


def floor_seconds() -> float:
    spent = []
    for _ in range(100):
        start = time.process_time()
        stanford_pose(32)
        spent.append(time.process_time() - start)
    return median(spent)


def clear_caches() -> None:
    """Empty every cache of the program."""
    for clear in caches():
        clear()


def group(chosen: Sequence[Case], reading: Reading) -> Found:
    found = Found(len(chosen))
    digests: list[bytes | None] = []
    floor = floor_seconds()
    for number, case in enumerate(chosen):
        try:
            named, digest, _ = reading.outcome(case)
            if number % TWICE == 0 and reading.outcome(case)[1] != digest:
                found.differing.append(f"twice in a row, {case}")
        except Exception as error:  # noqa: BLE001 - any exception is a finding
            found.escaped.append(f"{case}\n    {error!r}")
            digests.append(None)
            continue
        found.outcomes[named] += 1
        digests.append(digest)
    clear = tuple(caches())
    costly = []
    for case, first in reversed(list(zip(chosen, digests, strict=True))):
        if first is None:
            continue
        for empty in clear:
            empty()
        _, again, seconds = reading.outcome(case)
        if again != first:
            found.differing.append(f"from empty caches, {case}")
        costly.append(Costly(seconds / floor, case))
    found.costliest = nlargest(COSTLIEST, costly, key=lambda each: each.ratio)
    return found


def measured(case: Case, reading: Reading) -> Costly:
    ratios = []
    for _ in range(3):
        clear_caches()
        floor = floor_seconds()
        ratios.append(reading.outcome(case)[2] / floor)
    return Costly(min(ratios), case)


def groups(count: int, seed: str, size: int) -> Iterator[tuple[int, str]]:
    for number in range(0, count, size):
        yield min(size, count - number), f"{seed}.{number // size}"


def sample(count: int, seed: str) -> Found:
    with closing(Reading()) as reading:
        return group(list(cases(count, seed)), reading)
