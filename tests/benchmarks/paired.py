"""Compare the speed of two checkouts by measuring them in turn."""

import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from statistics import median

HERE = Path(__file__).parents[2]
PROBE = Path(__file__).with_name("probe.py")
# A line counts as slower if its ratio is above this.
TOLERATED = 1.03


@dataclass(frozen=True)
class Comparison:
    """A benchmark and its median time in two checkouts."""

    what: str
    here: float
    there: float

    @property
    def ratio(self) -> float:
        return self.here / self.there

    @property
    def slower(self) -> bool:
        return self.ratio > TOLERATED


def python_of(checkout: Path) -> str:
    """Return the Python in the checkout's virtual environment."""
    if checkout == HERE:
        return sys.executable
    folder = checkout / ".venv" / ("Scripts" if sys.platform == "win32" else "bin")
    return str(folder / "python")


def measured(checkout: Path, *, with_server: bool) -> dict[str, float]:
    options = [] if with_server else ["--no-server"]
    result = subprocess.run(
        [python_of(checkout), "-P", str(PROBE), *options],
        cwd=checkout, env=os.environ | {"PYTHONPATH": str(checkout)},
        stdout=subprocess.PIPE, text=True, check=True,
    )  # fmt: skip
    figures: dict[str, float] = json.loads(result.stdout)
    return figures


def compare(there: Path, rounds: int, *, with_server: bool) -> list[Comparison]:
    pairs = [
        (measured(HERE, with_server=with_server), measured(there, with_server=with_server))
        for _ in range(rounds)
    ]
    ours, theirs = pairs[0]
    return [
        Comparison(
            what,
            median(here[what] for here, _ in pairs),
            median(there[what] for _, there in pairs),
        )
        for what in ours
        if what in theirs
    ]
