"""Grade hand-ins in all kinds: ``python -m tests.submissions.handins --count 300 --seed 1``."""

import argparse
import sys
import tempfile
from pathlib import Path

from tests.submissions.handins.campaign import drawn, faults, outcomes, share_right, table_of

LEAST_RIGHT = 0.95


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="keep the classes in this new folder")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        if chosen.keep is not None:
            folder = chosen.keep
            folder.mkdir(parents=True)
        classes = drawn(chosen.count, chosen.seed, folder)
        found = [outcome for each in classes for outcome in outcomes(each, folder)]
    for each in found:
        if each.result != ("right" if each.kind.is_read else "listed"):
            apart = " (apart)" if each.kind.is_apart else ""
            print(f"{each.result}{apart}: {each.kind.name}: {each.where}\n    {each.said}")
    print(table_of(found))
    share, failed = share_right(found), faults(found)
    print(f"{len(found)} files, seed {chosen.seed}: {share:.1%} right, {len(failed)} faults")
    return bool(failed) or share < LEAST_RIGHT


if __name__ == "__main__":
    sys.exit(main())
