"""`python -m tests.attack`: attack a real process while honest clients use it.

Print the waiting times of honest clients. Exit with 1 if a limit is missed.
"""

# Exit with 1 if an honest client gets no response, if costly requests make the 99th percentile of
# the waiting times more than five times as long as ordinary requests on as many connections do (the
# median of five runs), if the memory grows by more than 100 MB, if a health check takes 0.3 s, or
# if the process does not end within ten seconds.

import argparse
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from tests.attack.floods import (
    CHUNKED,
    HEAD,
    KINDS,
    Flood,
    Source,
    costly,
    dripping,
    endless,
    from_addresses,
    from_one_address,
    half_bodies,
    half_open,
    many_costly,
    of_kind,
    one_costly,
    one_honest,
)
from tests.attack.honest import Waits, watched
from tests.attack.interface import faults, with_key
from tests.server.raw import HEALTH, service

MEMORY = 100.0
HEALTH_SECONDS = 0.3
END_SECONDS = 10.0
LONGER = 5.0
RUNS = 5
# The number of requests that schemathesis generates for each operation.
EXAMPLES = 300
INTERFACE = "requests generated from the OpenAPI document"
# Seconds between an answer and the next submission of a client that pauses.
PAUSE = 0.1
HONEST_ADDRESS = "127.0.0.2"


@dataclass(frozen=True)
class Attack:
    """A flood of requests to the service."""

    # If there is a flood `alike`, of ordinary requests from the same addresses, honest clients must
    # not wait much longer than during that flood.
    flood: Flood
    pause: float = 0.0
    alike: Flood | None = None


def attacks(scale: float) -> dict[str, Attack]:
    """Return the attacks by name; ``scale`` multiplies their sizes."""
    header = b"Cookie: " + b"x" * 50 + b"\r\n"
    floods = {
        "8,000 half heads": half_open(int(8000 * scale)),
        "half bodies": half_bodies(int(1000 * scale)),
        "endless headers": endless(HEAD, header * 1000),
        "an endless header": endless(HEAD + b"A: ", b"x" * 60_000),
        "an endless address": endless(b"GET /", b"x" * 60_000),
        "endless chunks": endless(CHUNKED, b"1000\r\n" + b" " * 4096 + b"\r\n"),
        "endless tiny chunks": endless(CHUNKED, b"1\r\n \r\n" * 10_000),
        "an endless extension": endless(CHUNKED + b"1;", b"x" * 60_000),
        "endless trailers": endless(CHUNKED + b"0\r\n", header * 1000),
        "an endless pipeline": endless(b"", HEALTH * 1000),
        "bodies a byte a second": dripping(int(1000 * scale)),
    }

    def same(_: int) -> str:
        return HONEST_ADDRESS

    def compared(
        body: Callable[[int], bytes] = one_costly, source: Source = from_one_address, **how: bool
    ) -> tuple[Flood, Flood]:
        return costly(body, source, **how), costly(one_honest, source, **how)

    costly_ones = {
        **{f", {kind}, one address": compared(of_kind(kind)) for kind in KINDS},
        **{f", {kind}, 16 addresses": compared(of_kind(kind), from_addresses) for kind in KINDS},
        ", many in one": compared(many_costly),
        ", same address": compared(source=same),
        ", each its own connection": compared(again=False),
        ", same address, each its own connection": compared(source=same, again=False),
    }
    return {name: Attack(flood) for name, flood in floods.items()} | {
        f"costly bodies{how}, {clients}": Attack(flood, pause, alike)
        for clients, pause in {
            "honest clients without a pause": 0.0,
            "honest clients with pauses": PAUSE,
        }.items()
        for how, (flood, alike) in costly_ones.items()
    }


def attack(seconds: float, scale: float, only: str = "", runs: int = RUNS) -> list[str]:
    """Run the attacks one after the other; return a line for each missed limit."""
    # An attack that is compared has `runs` shorter runs, and as many for its comparison.
    broken: list[str] = []
    with tempfile.TemporaryDirectory() as folder, ExitStack() as opened:
        running = opened.enter_context(service(Path(folder)))
        running.ask(HEALTH)
        # The caches of the program are full after the first run.
        with watched(running, 0.0, HONEST_ADDRESS) as (submissions, health):
            time.sleep(seconds)
        _print("nothing", submissions, health)
        start = running.memory()
        for name, each in attacks(scale).items():
            if only not in name:
                continue
            ratios = []
            for _ in range(1 if each.alike is None else runs):
                lasting = seconds if each.alike is None else seconds / runs
                usual = None
                if each.alike is not None:
                    with watched(running, each.pause, HONEST_ADDRESS) as (usual, _health):
                        each.alike(running, opened, time.monotonic() + lasting)
                with watched(running, each.pause, HONEST_ADDRESS) as (submissions, health):
                    said = each.flood(running, opened, time.monotonic() + lasting)
                grown = running.memory() - start
                _print(f"{name}: {said}; memory +{grown:.0f} MB", submissions, health)
                if grown > MEMORY:
                    broken.append(f"{name}: memory grew by {grown:.0f} MB")
                broken += [f"{name}: {what}" for what in _faults(submissions, health)]
                if usual is not None:
                    ratios.append(_longer(submissions, usual))
            if ratios and median(ratios) > LONGER:
                broken.append(
                    f"{name}: the 99th percentile of honest waiting times is {median(ratios):.1f} "
                    "times as long as beside ordinary requests"
                )
        if only in INTERFACE:
            failed = list(faults(running, Path(folder), max(1, int(EXAMPLES * scale))))
            print(f"{INTERFACE}: {'faults' if failed else 'no fault'}", flush=True)  # noqa: T201
            broken += failed
            settings, key = with_key(Path(folder))
            with service(Path(folder), **settings) as keyed:
                failed = list(faults(keyed, Path(folder), max(1, int(EXAMPLES * scale)), key=key))
            print(f"{INTERFACE}, with keys: {'faults' if failed else 'no fault'}", flush=True)  # noqa: T201
            broken += failed
        began = time.monotonic()
        code = running.end()
        took = time.monotonic() - began
        print(f"ended in {took:.1f} s, exit code {code}", flush=True)  # noqa: T201
        if code or took > END_SECONDS:
            broken.append("the process did not shut down as promised")
    return broken


def _print(name: str, submissions: Waits, health: Waits) -> None:
    print(f"{name}\n    honest: {submissions}\n    health: {health}", flush=True)  # noqa: T201


def _faults(submissions: Waits, health: Waits) -> Iterator[str]:
    if submissions.failures or not submissions.seconds:
        yield "honest clients had no answer"
    if health.failures or health.quantile(1.0) > HEALTH_SECONDS:
        yield "a health check took too long"


def _longer(submissions: Waits, usual: Waits) -> float:
    # Both were sent the same bodies, and some bodies take long by themselves: those that only one
    # of the runs answered in time are left out.
    shared = set(submissions.bodies) & set(usual.bodies)
    submissions, usual = submissions.of(shared), usual.of(shared)
    p50, p99 = (submissions.quantile(share) / usual.quantile(share) for share in (0.5, 0.99))
    print(f"    beside ordinary requests: {usual}", flush=True)  # noqa: T201
    print(f"    p50: {p50:.1f}, p99: {p99:.1f} times as long", flush=True)  # noqa: T201
    return p99


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=25.0, help="for each attack")
    parser.add_argument(
        "--scale", type=float, default=1.0, help="factor for the size of the attacks"
    )
    parser.add_argument("--only", default="", help="only attacks whose names contain this")
    parser.add_argument("--runs", type=int, default=RUNS, help="of attacks that are compared")
    options = parser.parse_args()
    broken = attack(options.seconds, options.scale, options.only, options.runs)
    for line in broken:
        print(line, file=sys.stderr, flush=True)  # noqa: T201
    return 1 if broken else 0


if __name__ == "__main__":
    raise SystemExit(main())
