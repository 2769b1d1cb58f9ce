"""``python -m tests.frame_choice --tables 1000 --seed N``: the figures for all robots."""

import argparse
import sys
import zlib
from collections import Counter

import numpy as np

from tests.frame_choice.figures import HEAD, by_policy, line
from tests.frame_choice.robots import GIVEN, POLICIES, ROBOTS, conventions
from tests.frame_choice.trials import Tally, run


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.frame_choice", description=__doc__)
    parser.add_argument("--tables", type=int, default=1000, help="for each robot and convention")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--policy", choices=["given", "free"], default="given")
    parser.add_argument("--robot", default="", help="only robots whose name contains this")
    parser.add_argument("--misses", type=int, default=0, help="print so many of each kind")
    options = parser.parse_args()
    total = Tally()
    tell(HEAD)
    for robot in ROBOTS:
        if options.robot.lower() not in robot.name.lower():
            continue
        only_given = options.policy == "given"
        policy = GIVEN if only_given else POLICIES[-1]
        for convention in conventions(robot, policy):
            seed = zlib.crc32(f"{options.seed} {robot.name} {convention}".encode())
            rng = np.random.default_rng(seed)
            tally = run(robot, convention, only_given, options.tables, rng)
            tell(line(f"{robot.name}, {convention}", tally))
            total.add(tally)
    tell(line("all", total))
    tell(f"\nraised: {total.counts['crashed']}\n{by_policy(total)}")
    tell_misses(total, options.misses)


def tell_misses(total: Tally, at_most: int) -> None:
    tell("\nslips by kind: exactly blamed of all")
    for group, kind in sorted({(group, kind) for group, kind, _ in total.kinds}):
        right, wrong = total.kinds[group, kind, True], total.kinds[group, kind, False]
        tell(f"  {group:9}{kind:22}{right:7} of {right + wrong}")
    shown: Counter[str] = Counter()
    for miss in total.misses:
        key = f"{miss.what}: {miss.table.robot.name}"
        shown[key] += 1
        if shown[key] <= at_most:
            tell(f"\n{miss}")
    tell("\nmisses: " + "".join(f"\n  {count:5} {key}" for key, count in shown.most_common()))


def tell(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


main()
