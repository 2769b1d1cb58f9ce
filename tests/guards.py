"""Time limits that only detect hangs; they do not measure speed."""

# These limits do not measure speed: a test must not fail because the machine is busy. If a test
# waits for a condition, the timeout of pytest is the limit (see pyproject.toml).

from typing import Final

# Seconds of processor time for one text or submission. The budget of 50 ms is for the benchmarks
# and the long fuzz.
STALL: Final = 10.0
# Seconds for one answer of a server process, or for its end.
ANSWER: Final = 150.0
