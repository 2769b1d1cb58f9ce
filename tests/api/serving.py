"""Helpers of tests that start the real process."""

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.guards import ANSWER

ROOT = Path(__file__).parents[2]


def announced_port(process: subprocess.Popen[bytes], log: Path) -> int:
    """Wait until the server prints its port, and return the port."""
    while True:
        text = log.read_text(encoding="utf-8")
        if found := re.search(r"running on http://127\.0\.0\.1:(\d+)", text):
            return int(found[1])
        try:
            process.wait(timeout=0.02)
        except subprocess.TimeoutExpired:
            continue
        raise AssertionError(f"the server has ended:\n{text}")


@dataclass(frozen=True)
class Served:
    """A running server process."""

    process: subprocess.Popen[bytes]
    log: Path
    port: int

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.port}"


@contextmanager
def served(folder: Path, *, module: str = "dh_grader", **environment: str) -> Iterator[Served]:
    """Run a real process, `python -m dh_grader serve`, with its log in a folder."""
    # Another `module` may start the service with a change.
    log = folder / "log"
    command = [sys.executable, "-m", module, "serve"]
    usual = {"NO_COLOR": "1", "DH_GRADER_PORT": "0"}
    with (
        log.open("wb") as output,
        subprocess.Popen(
            command, cwd=ROOT, stdout=output, stderr=output,
            env=os.environ | usual | environment,
        ) as process,
    ):  # fmt: skip
        try:
            yield Served(process, log, announced_port(process, log))
        finally:
            process.terminate()
            process.wait(timeout=ANSWER)
    told = log.read_text(encoding="utf-8")
    assert "Traceback" not in told, told[told.index("Traceback") :]
