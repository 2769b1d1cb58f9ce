"""Measure the processor time of whole processes of the command line."""

import os
import resource
import subprocess
import sys
from typing import Final

from dh_grader.catalogue import shipped_folder

ROUNDS: Final = 5
SUBMISSION: Final = shipped_folder().parent / "docs" / "examples" / "stanford-arm.json"

# A process for comparison, because the speed of a machine may vary.
NUMPY: Final = ("-c", "import numpy")
COMMANDS: Final = {
    "dh-grader --help": ("-m", "dh_grader", "--help"),
    "dh-grader grade, one file": (
        *("-m", "dh_grader", "grade", str(SUBMISSION)),
        *("--exercise", "stanford-arm"),
    ),
}  # fmt: skip


def seconds(*arguments: str) -> float:
    """Return the processor time of one Python process whose modules are already compiled."""
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        [sys.executable, *arguments], env=environment, stdout=subprocess.DEVNULL, check=False
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def start_seconds() -> dict[str, float]:
    """Return the processor time of importing numpy and of each command."""
    measured = {"python -c 'import numpy'": NUMPY, **COMMANDS}
    rounds = [
        {what: seconds(*command) for what, command in measured.items()} for _ in range(ROUNDS)
    ]
    return {what: min(each[what] for each in rounds) for what in measured}
