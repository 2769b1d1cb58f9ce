"""`python -m tests.attack`: attacks on a real process, while honest clients use it.

Exit code 1 where an honest client goes without an answer, memory grows by more than 100 MB, a
question about health takes a second, or the process does not end in ten.
"""

import argparse
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path

from tests.attack.floods import (
    CHUNKED,
    HEAD,
    Flood,
    costly,
    dripping,
    endless,
    half_bodies,
    half_open,
)
from tests.attack.honest import watched
from tests.server.raw import HEALTH, service

MEMORY = 100.0
HEALTH_SECONDS = 1.0
END_SECONDS = 10.0


def floods(scale: float) -> dict[str, Flood]:
    """The attacks, as large as is asked."""
    header = b"Cookie: " + b"x" * 50 + b"\r\n"
    megabytes = 60 * scale
    return {
        "nothing": half_open(0),
        "8,000 half heads": half_open(int(8000 * scale)),
        "half bodies": half_bodies(int(1000 * scale)),
        "endless headers": endless(HEAD, header * 1000, megabytes),
        "an endless header": endless(HEAD + b"A: ", b"x" * 60_000, megabytes),
        "an endless address": endless(b"GET /", b"x" * 60_000, megabytes),
        "endless chunks": endless(CHUNKED, b"1000\r\n" + b" " * 4096 + b"\r\n", megabytes),
        "endless tiny chunks": endless(CHUNKED, b"1\r\n \r\n" * 10_000, megabytes),
        "an endless extension": endless(CHUNKED + b"1;", b"x" * 60_000, megabytes),
        "endless trailers": endless(CHUNKED + b"0\r\n", header * 1000, megabytes),
        "an endless pipeline": endless(b"", HEALTH * 1000, megabytes),
        "bodies a byte a second": dripping(int(1000 * scale)),
        "costly bodies": costly(16),
        "costly bodies, same address": costly(16, "127.0.0.2"),
    }


def attack(seconds: float, scale: float, only: str = "") -> list[str]:
    """Run the attacks one after the other and print their figures; what was not held."""
    broken: list[str] = []
    with tempfile.TemporaryDirectory() as folder, ExitStack() as opened:
        running = opened.enter_context(service(Path(folder)))
        running.ask(HEALTH)
        start = 0.0
        for name, flood in floods(scale).items():
            if only and only not in name and name != "nothing":
                continue
            with watched(running) as (submissions, health):
                said = flood(running, opened, time.monotonic() + seconds)
            # The program's own caches are full after the first.
            start = start or running.memory()
            grown = running.memory() - start
            print(f"{name}: {said}; memory +{grown:.0f} MB", flush=True)  # noqa: T201
            print(f"    honest: {submissions}\n    health: {health}", flush=True)  # noqa: T201
            if submissions.failures or not submissions.seconds:
                broken.append(f"{name}: honest clients had no answer")
            if grown > MEMORY:
                broken.append(f"{name}: memory grew by {grown:.0f} MB")
            if health.failures or health.quantile(1.0) > HEALTH_SECONDS:
                broken.append(f"{name}: a question about health took too long")
        began = time.monotonic()
        code = running.end()
        took = time.monotonic() - began
        print(f"ended in {took:.1f} s, exit code {code}", flush=True)  # noqa: T201
        if code or took > END_SECONDS:
            broken.append("the process did not end in good order")
    return broken


def main() -> int:
    """Run all attacks, or those of which the name holds a word."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=35.0, help="for each attack")
    parser.add_argument("--scale", type=float, default=1.0, help="the size, as a share")
    parser.add_argument("--only", default="", help="a word of the attacks' names")
    options = parser.parse_args()
    broken = attack(options.seconds, options.scale, options.only)
    for line in broken:
        print(line, file=sys.stderr, flush=True)  # noqa: T201
    return 1 if broken else 0


if __name__ == "__main__":
    raise SystemExit(main())
