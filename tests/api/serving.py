"""Helpers of the tests that start the real process."""

import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]


def announced_port(process: subprocess.Popen[bytes], log: Path) -> int:
    """Waits until the server says where it listens; the test's own timeout bounds that."""
    while True:
        text = log.read_text(encoding="utf-8")
        if found := re.search(r"running on http://127\.0\.0\.1:(\d+)", text):
            return int(found[1])
        try:
            process.wait(timeout=0.02)
        except subprocess.TimeoutExpired:
            continue
        raise AssertionError(f"the server has ended:\n{text}")
