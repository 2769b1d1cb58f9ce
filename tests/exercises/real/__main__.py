"""``python -m tests.exercises.real --tables 1000``: grade random tables of every real robot."""

import argparse
import os
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context

from tests.exercises.real.campaign import ACCEPTED, REFUSED, VALID, WRONG, run
from tests.shipped import REAL_ROBOTS


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.exercises.real", description=__doc__)
    parser.add_argument("--tables", type=int, default=1000, help="valid and wrong ones each")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--robot", default="", help="only robots whose id contains this")
    options = parser.parse_args()
    names = [name for name in REAL_ROBOTS if options.robot in name]
    task = partial(run, tables=options.tables, seed=options.seed)
    misjudged = 0
    with ProcessPoolExecutor(options.jobs, mp_context=get_context("spawn")) as pool:
        for name, found in zip(names, pool.map(task, names), strict=True):
            counts = found.counts
            misjudged += len(found.misses)
            sys.stdout.write(
                f"{name:22} {counts[ACCEPTED]:5} of {counts[VALID]:5} valid tables accepted, "
                f"{counts[REFUSED]:5} of {counts[WRONG]:5} wrong ones refused\n"
            )
            sys.stdout.write("".join(f"    {miss}\n" for miss in found.misses[:5]))
            sys.stdout.flush()
    return 1 if misjudged else 0


if __name__ == "__main__":
    sys.exit(main())
