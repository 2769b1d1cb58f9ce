"""Guards against a hang, far above what the slowest run takes on an idle machine.

They are no measure of speed: a test must not fail because the machine is busy. Where a test waits
for a condition, the timeout of pytest (see pyproject.toml) is its guard.
"""

from typing import Final

# Seconds of processor time for one text or submission. The budget of 50 ms is for the benchmarks
# and the long fuzz.
STALL: Final = 10.0
# Seconds for one answer of a process that serves, or for its end.
ANSWER: Final = 60.0
