"""``python -m tests.same --base COMMIT``: compare this checkout with a commit, byte for byte.

Both answer the same requests and commands side by side, in processes of their own. Every answer
that differs is listed. Exit code 1 if one differs. Nothing is stored.
"""

import argparse
import sys
import time
from pathlib import Path
from typing import Final

from tests.same.asked import all_asked, share_of
from tests.same.comparing import compared, told

ROOT: Final = Path(__file__).parents[2]


def main() -> int:
    """Compare the checkout with the commit that the command line names."""
    parser = argparse.ArgumentParser(prog="python -m tests.same", description=__doc__)
    parser.add_argument("--base", required=True, help="the commit to compare with")
    parser.add_argument("--share", type=int, default=1, help="ask only one in so many")
    parser.add_argument("--only", default="", help="ask only what has this in its name")
    parser.add_argument("--shown", type=int, default=20, help="how many differences to print")
    options = parser.parse_args()
    begun = time.monotonic()
    asked = [each for each in share_of(all_asked(), options.share) if options.only in each.name]
    differences = compared(ROOT, options.base, asked)
    for each in differences[: options.shown]:
        sys.stdout.write(f"{told(each)}\n")
    seconds = time.monotonic() - begun
    sys.stdout.write(f"{len(asked):,} asked, {len(differences):,} differ, {seconds:.0f} s\n")
    return 1 if differences else 0


if __name__ == "__main__":
    raise SystemExit(main())
