"""Print how often reports name slips of random arms: part of ``make slips``."""

import argparse
from collections import Counter, defaultdict

from rich.console import Console

from tests.pose_slips.unseen.arms import arms
from tests.pose_slips.unseen.slips import CLASSES
from tests.pose_slips.unseen.trials import KINDS, ArmTrial, trials, two_slips

# The codes of messages about single entries.
OF_ENTRIES = {"value", "independent_of", "joint_variable_extra", "term_sign", "quantity"}


class Counts:
    """Counts of all trials, and of the trials whose report named the slip."""

    def __init__(self) -> None:
        self.all = self.named = self.placed = 0

    def add(self, trial: ArmTrial) -> None:
        self.all += 1
        self.named += trial.is_named
        self.placed += trial.is_placed


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--arms", type=int, default=60, help="the number of arms (60)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--each", type=int, default=2, help="slips of each class (2)")
    parser.add_argument("--show", action="store_true", help="print the slips that were not named")
    options = parser.parse_args()
    console = Console(width=200, highlight=False)
    counts: dict[tuple[str, str, bool], Counts] = defaultdict(Counts)
    total, unrelated, explained = Counts(), Counts(), Counter[str]()
    for number, arm in enumerate(arms(options.seed, options.arms)):
        for trial in trials(arm, number, options.each):
            counts[trial.slip.kind, trial.kind, trial.is_alone].add(trial)
            if trial.is_alone:
                total.add(trial)
            if options.show and not (trial.is_named and (trial.is_placed or not trial.is_alone)):
                console.print(number, arm.structure, arm.convention, trial.kind, trial.slip.kind)
                console.print("  ", trial.is_alone, sorted(trial.codes), trial.said[:3])
        for trial in two_slips(arm, number):
            unrelated.add(trial)
            if len(trial.said) == 1 and trial.said[0][0] not in OF_ENTRIES:
                explained[trial.said[0][0]] += 1
                if options.show:
                    console.print(number, arm.structure, arm.convention, trial.kind, "two slips")
                    console.print("  ", trial.said)
    for kind in CLASSES:
        for part in KINDS:
            alone, others = counts[kind, part, True], counts[kind, part, False]
            console.print(
                f"{kind}, {part}: alone {alone.named} of {alone.all} ({alone.placed} with its "
                f"place), with others {others.named} of {others.all}"
            )
    console.print(f"alone: {total.named} of {total.all} named")
    console.print(f"two slips, named as one: {explained.total()} of {unrelated.all}, {explained}")
    return int(total.named < 0.95 * total.all)


if __name__ == "__main__":
    raise SystemExit(main())
