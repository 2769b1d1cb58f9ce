"""The campaign of generated robots: ``python -m tests.variants.robots --seeds 10000 --level 1``."""

import argparse
import time
from collections import Counter

from service.kinematics.dh import Convention
from service.variants.robots.practice_id import PracticeId
from service.variants.robots.robot_exercise import robot_exercise
from tests.variants.robots.checks import (
    form,
    is_the_robot_of_its_statement,
    lazy_share,
    model_share,
    nearest_links,
    overlapping_labels,
)

CLEAR = 0.12


def main() -> None:
    """Print what does not hold, and the figures."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--level", type=int, default=1)
    arguments.add_argument("--first", type=int, default=0)
    arguments.add_argument("--seeds", type=int, default=200)
    arguments.add_argument("--solved", type=int, default=50, help="solve every n-th by SymPy")
    arguments.add_argument("--figures", type=int, default=50, help="draw every n-th")
    chosen = arguments.parse_args()
    faults: Counter[str] = Counter()
    forms: dict[object, int] = {}
    worst, slowest = 0.0, 0.0
    for number in range(chosen.first, chosen.first + chosen.seeds):
        for convention in Convention:
            began = time.process_time()
            exercise = robot_exercise(PracticeId(chosen.level, convention, number))
            slowest = max(slowest, time.process_time() - began)
            lazy = lazy_share(exercise)
            worst = max(worst, lazy)
            found = {
                "statement": not is_the_robot_of_its_statement(exercise, number),
                "model": model_share(exercise, solved=number % chosen.solved == 0) < 1,
                "lazy": lazy > 0.25,
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
        f"level {chosen.level}, {chosen.seeds} seeds, both conventions: faults {dict(faults)}, "
        f"{len(forms)} forms, lazy at most {worst:.1%}, slowest {1000 * slowest:.1f} ms",
        flush=True,
    )


if __name__ == "__main__":
    main()
