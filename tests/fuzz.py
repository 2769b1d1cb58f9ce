"""Read many random texts, grids and requests: `python -m tests.fuzz --count 1000000`.

Exit with 1 if the program raises an undocumented exception, reads a text differently a second time,
or takes too long.
"""

import argparse
import math
import os
import sys
import time
import warnings
from collections.abc import Iterator, Sequence
from multiprocessing import get_context

from tests.attack.hostile import Found, Reading, cases, group, groups, measured

GROUP = 500
# The largest allowed cost of a body, as a multiple of the floor of `make bench`.
BUDGET = 400.0
PROGRESS_SECONDS = 20.0

_reading = Reading()


def _group(count: int, seed: str) -> Found:
    # A warning counts as an error, because it would fill the log of a service.
    warnings.simplefilter("error")
    return group(list(cases(count, seed)), _reading)


def _numbered_group(each: tuple[int, str]) -> Found:
    return _group(*each)


def fuzz(count: int, seed: str, cores: int, minutes: float) -> Found:
    total = Found()
    began = told = time.monotonic()
    for found in _each(count, seed, cores):
        total.add(found)
        now = time.monotonic()
        if now - told > PROGRESS_SECONDS:
            told = now
            broken = f"{len(total.escaped)} escaped, {len(total.differing)} differing"
            rate = total.count / (now - began)
            sys.stderr.write(f"{total.count:,} of {count:,}, {rate:.0f} a second; {broken}\n")
        if now - began > 60 * minutes:
            break
    return total


def _each(count: int, seed: str, cores: int) -> Iterator[Found]:
    sizes = groups(count, seed, GROUP)
    if cores == 1:
        yield from (_group(*each) for each in sizes)
        return
    # A long-lived process could hide errors of a new one, so each reads only some groups.
    # (An executor of concurrent.futures waits for ever here: CPython's issue 115634.)
    with get_context("spawn").Pool(cores, maxtasksperchild=200) as pool:
        yield from pool.imap_unordered(_numbered_group, sizes)


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", default="0")
    parser.add_argument("--cores", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--minutes", type=float, default=math.inf, help="stop after this time")
    options = parser.parse_args(arguments)
    began = time.monotonic()
    found = fuzz(options.count, options.seed, options.cores, options.minutes)
    costliest = sorted((measured(each.case, _reading) for each in found.costliest), reverse=True)
    outcomes = "\n".join(f"  {times:9,} {named}" for named, times in found.outcomes.most_common())
    report = [
        f"{found.count:,} cases, seed {options.seed}, {time.monotonic() - began:.0f} s",
        outcomes,
        f"escaped: {len(found.escaped)}",
        *found.escaped[:20],
        f"differing between two readings: {len(found.differing)}",
        *found.differing[:20],
        f"the costliest, in multiples of the plain-numpy floor (budget {BUDGET:.0f}):",
        *(f"{ratio:6.0f} {case}" for ratio, case in costliest),
    ]
    sys.stdout.write("\n".join(report).encode("utf-8", "backslashreplace").decode() + "\n")
    over = bool(costliest) and costliest[0].ratio > BUDGET
    return 1 if found.escaped or found.differing or over else 0


if __name__ == "__main__":
    raise SystemExit(main())
