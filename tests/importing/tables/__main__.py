"""Import tables in all styles: ``python -m tests.importing.tables --tables 500 --seed 1``."""

import argparse
import sys
from collections import Counter
from collections.abc import Iterator

import numpy as np

from tests.importing.tables.campaign import Outcome, faults, outcome
from tests.importing.tables.drawn import random_table, real_table
from tests.importing.tables.programs import PROGRAMS
from tests.importing.tables.styles import STYLES, Typed, typed
from tests.shipped import REAL_ROBOTS

SHOWN = 20


def outcomes(tables: int, seed: int) -> Iterator[tuple[str, Typed, Outcome]]:
    """Import each real table and random tables in turn, typed by people and by programs."""
    for k in range(tables):
        rng = np.random.default_rng([seed, k])
        is_real = k % 2 == 0
        name = REAL_ROBOTS[k // 2 % len(REAL_ROBOTS)] if is_real else f"random {seed}/{k}"
        drawn = real_table(name) if is_real else random_table(rng)
        style = STYLES[(k + k // len(STYLES)) % len(STYLES)]
        text = typed(drawn, style, rng)
        yield f"{name}, {style.name}", text, outcome(drawn, text)
        write = PROGRAMS[(k + k // len(PROGRAMS)) % len(PROGRAMS)]
        written = write(drawn, rng)
        if written is not None:
            yield f"{name}, {write.__name__}", written, outcome(drawn, written)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tables", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    made = list(outcomes(chosen.tables, chosen.seed))
    found, counts = faults(iter(made))
    reasons = Counter(each.reason for _, _, each in made if each.result == "refused")
    for reason, count in reasons.most_common(SHOWN):
        print(f"{count} refused: {reason}")
    for fault in found[:SHOWN]:
        print("FAULT", fault)
    print(f"{len(made)} texts, seed {chosen.seed}: {dict(counts)}")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
