"""`python -m tests.worst --minutes 10`: find the costliest request bodies.

Print where their processor time goes. Exit with 1 if a body costs more than 300 times a pose
computed in NumPy (500 times for a table of random decimals).
"""

import argparse
import re
import sys
import time
from pathlib import Path

from tests.worst.bodies import KNOWN
from tests.worst.entry_points import ENTRIES, Attack, Target, forget
from tests.worst.exercises import exercises
from tests.worst.search import Found, Search
from tests.worst.seeds import attacks, cells
from tests.worst.stages import Stages

PROMISED = 300
# A table of random decimals may cost this much.
PROMISED_DECIMALS = 500
MOST_DECIMALS = 8


_DECIMAL = re.compile(rb'"-?[0-9]+[.][0-9]+"')


def promised(attack: Attack) -> int:
    """Return how many floors a request may cost at most."""
    is_of_decimals = len(_DECIMAL.findall(attack.content)) > MOST_DECIMALS
    return PROMISED_DECIMALS if is_of_decimals else PROMISED


def line_of(found: Found, target: Target) -> str:
    stages = Stages()

    def action() -> None:
        forget()
        target.answer(found.attack)

    stages.watch(action)
    content = found.attack.content
    return (
        f"{found.ratio:6.0f} × floor  {found.attack.entry} {found.attack.exercise} "
        f"({found.status}, {len(content)} bytes): {stages.line()}\n"
        f"         {content[:160].decode('utf-8', 'replace')!r}"
    )


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.worst", description=__doc__)
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--entry", default="", choices=("", *ENTRIES))
    parser.add_argument("--exercise", default="", help="only exercises whose id begins with this")
    parser.add_argument("--most", type=int, default=5, help="bodies of each entry point")
    parser.add_argument("--out", type=Path, metavar="DIR", help="write the bodies here")
    options = parser.parse_args()
    until = time.monotonic() + 60 * options.minutes
    attacked = {
        name: each for name, each in exercises().items() if name.startswith(options.exercise)
    }
    target = Target(attacked)
    search = Search(target, options.seed, cells())
    known = (each for each in KNOWN.values() if each.exercise in attacked)
    search.evolve((*attacks(attacked, options.seed), *known), until, options.entry)
    is_within = True
    sys.stdout.write(f"{search.tried} bodies, seed {options.seed}\n")
    for entry in ENTRIES:
        for i, found in enumerate(search.costliest(entry, options.most)):
            # The cost of one measurement varies by a half; the least of several counts.
            ratio, status = target.ratio(found.attack, enough=promised(found.attack))
            again = Found(ratio, found.attack, status)
            is_within &= again.ratio <= promised(again.attack)
            text = line_of(again, target)
            sys.stdout.buffer.write(f"{text}\n".encode("utf-8", "replace"))
            sys.stdout.flush()
            if options.out is not None:
                options.out.mkdir(parents=True, exist_ok=True)
                name = f"{entry}-{found.attack.exercise}-{i}"
                (options.out / f"{name}.json").write_bytes(found.attack.content)
                with (options.out / "list.txt").open("a", encoding="utf-8") as listed:
                    listed.write(f"{again.ratio:.0f}  {name}.json  {text.splitlines()[0]}\n")
    target.close()
    return 0 if is_within else 1


if __name__ == "__main__":
    raise SystemExit(main())
