"""Check many generated robots: ``python -m tests.variants.robots --seeds 10000 --level 1``."""

import argparse
import sys
import time
from collections import Counter

from dh_grader.kinematics import Convention
from dh_grader.variants.robots import PracticeId, asks_enough, robot_exercise

from tests.variants.robots.checks import (
    form,
    is_the_robot_of_its_statement,
    lazy_share,
    model_share,
    nearest_links,
    overlapping_labels,
)

CLEAR = 0.12
MOST_FOR_NOTHING = 0.25


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--level", type=int, default=1)
    arguments.add_argument("--first", type=int, default=0)
    arguments.add_argument("--seeds", type=int, default=200)
    arguments.add_argument("--solved", type=int, default=50, help="solve every n-th by SymPy")
    arguments.add_argument("--figures", type=int, default=50, help="draw every n-th")
    arguments.add_argument("--zeros", type=int, default=1, help="grade zeros for every n-th")
    chosen = arguments.parse_args()
    faults: Counter[str] = Counter()
    forms: dict[object, int] = {}
    dealt: Counter[tuple[Convention, bool]] = Counter()
    worst, slowest = 0.0, 0.0
    for number in range(chosen.first, chosen.first + chosen.seeds):
        for convention in Convention:
            began = time.process_time()
            exercise = robot_exercise(PracticeId(chosen.level, convention, number))
            slowest = max(slowest, time.process_time() - began)
            if number % chosen.zeros == 0:
                lazy = lazy_share(exercise)
                is_dealt = asks_enough(exercise) if number % 10 == 0 else lazy <= MOST_FOR_NOTHING
                dealt[convention, is_dealt] += 1
                worst = max(worst, lazy if is_dealt else 0)
            found = {
                "statement": not is_the_robot_of_its_statement(exercise, number),
                "model": model_share(exercise, solved=number % chosen.solved == 0) < 1,
                "links": nearest_links(exercise) < CLEAR,
                "labels": number % chosen.figures == 0 and bool(overlapping_labels(exercise)),
            }
            if convention is Convention.STANDARD:
                earlier = forms.setdefault(form(exercise), number)
                if earlier != number:
                    faults["alike"] += 1
                    found["alike below 500"] = number < 500
            for name, failed in found.items():
                if failed:
                    faults[name] += 1
                    print(f"{exercise.id}: {name}", flush=True)
    print(
        f"level {chosen.level}, {chosen.seeds} seeds: faults {dict(faults)}, not dealt "
        f"{sum(n for (_, yes), n in dealt.items() if not yes)} of {dealt.total()}, "
        f"{len(forms)} forms, zeros earn at most {worst:.1%}, slowest {1000 * slowest:.1f} ms",
        flush=True,
    )
    # Forms repeat late, where nobody gets to by dealing.
    return 1 if set(faults) - {"alike"} or worst > MOST_FOR_NOTHING else 0


if __name__ == "__main__":
    sys.exit(main())
