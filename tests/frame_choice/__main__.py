"""``python -m tests.frame_choice --tables 1000 --seed N``: grade random tables of all robots."""

import argparse
import sys
from collections import Counter

from tests.frame_choice.campaign import FREE_TABLES, TABLES, Task, figures, total, whole_campaign
from tests.frame_choice.figures import HEAD, by_policy, line
from tests.frame_choice.robots import ROBOTS
from tests.frame_choice.trials import Tally


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.frame_choice", description=__doc__)
    parser.add_argument("--tables", type=int, default=TABLES, help="for each robot and convention")
    parser.add_argument("--free-tables", type=int, default=FREE_TABLES, help="with free base, …")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, help="processes; one for each processor by default")
    parser.add_argument("--robot", default="", help="only robots whose name contains this")
    parser.add_argument("--misses", type=int, default=0, help="misses to print of each kind")
    options = parser.parse_args()
    robots = [robot for robot in ROBOTS if options.robot.lower() in robot.name.lower()]
    lines: list[str] = []

    def keep(task: Task, tally: Tally) -> None:
        policy = "" if task.only_given else " (free)"
        lines.append(line(f"{task.name}{policy}", tally))

    given, free = whole_campaign(
        options.tables, options.free_tables, options.seed, robots, options.jobs, keep
    )
    both = total([given, free])
    found = list(figures(given, free))
    write("\n".join([HEAD, *lines, line("all", both), "", by_policy(both)]))
    write_misses(both, options.misses)
    write("\nfigures\n" + "\n".join(f"  {figure}" for figure in found))
    return 0 if all(figure.holds for figure in found) else 1


def write_misses(total: Tally, at_most: int) -> None:
    write("\nslips by kind: exactly blamed of all")
    for group, kind in sorted({(group, kind) for group, kind, _ in total.kinds}):
        right, wrong = total.kinds[group, kind, True], total.kinds[group, kind, False]
        write(f"  {group:9}{kind:22}{right:7} of {right + wrong}")
    printed: Counter[str] = Counter()
    for miss in total.misses:
        key = f"{miss.what}: {miss.table.robot.name}"
        printed[key] += 1
        if printed[key] <= at_most:
            write(f"\n{miss}")
    write("\nmisses: " + "".join(f"\n  {count:5} {key}" for key, count in printed.most_common()))


def write(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
