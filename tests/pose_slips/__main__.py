"""Print how often reports name a slip, for each robot and kind of part: ``make slips``."""

import argparse
from collections import Counter, defaultdict

from rich.console import Console

from tests.pose_slips.campaign import KINDS, trials
from tests.pose_slips.robots import robots


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--every", type=int, default=1, help="try every n-th slip (1)")
    parser.add_argument("--robot", help="only this robot")
    parser.add_argument("--show", action="store_true", help="print the slips that were not named")
    options = parser.parse_args()
    console = Console(width=200, highlight=False)
    counts: dict[tuple[bool, str], Counter[str]] = defaultdict(Counter)
    for robot in robots():
        if options.robot not in (None, robot.name):
            continue
        of_robot: Counter[str] = Counter()
        for trial in trials(robot, lambda k: k % options.every == 0):
            named = "named" if trial.outcome == "named" else "missed"
            counts[trial.alone, trial.kind][named] += 1
            of_robot[named] += 1
            if options.show and named == "missed":
                where = f"row {trial.slip.row + 1}, column {trial.slip.column + 1}"
                console.print(
                    robot.name, trial.kind, where, trial.slip.cell, trial.alone, trial.outcome
                )
        console.print(f"{robot.name}: {of_robot['named']} of {of_robot.total()} named")
    alone: Counter[str] = Counter()
    for kind in KINDS:
        for is_alone, words in ((True, "alone"), (False, "with others")):
            found = counts[is_alone, kind]
            console.print(f"{kind}, {words}: {found['named']} of {found.total()} named")
            alone += found if is_alone else Counter()
    return alone["named"] < 0.95 * alone.total()


if __name__ == "__main__":
    raise SystemExit(main())
