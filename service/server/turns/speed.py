"""Measure how long an ordinary request takes on this machine.

The measure is the time of a fixed computation, because costly requests must not change it.
"""

from collections import deque
from statistics import median
from time import thread_time
from typing import Final

import numpy as np

from service.kinematics.chain import pose
from service.kinematics.dh import Convention

# The mean of wrong tables, in multiples of the computation.
ORDINARY: Final = 190
# The number of measurements that count, and of requests between two of them.
_KEPT, _BETWEEN = 31, 50
_LINKS: Final = np.random.default_rng(0).uniform(-1, 1, (6, 4, 64))


class Speed:
    """The time of an ordinary request: the median of the last measurements."""

    def __init__(self) -> None:
        self._measured = deque((_measured() for _ in range(_KEPT)), maxlen=_KEPT)
        self._requests = 0
        self.ordinary = ORDINARY * median(self._measured)

    def after_request(self) -> float:
        """Return the time of an ordinary request, which is measured again now and then."""
        self._requests += 1
        if self._requests % _BETWEEN == 0:
            self._measured.append(_measured())
            self.ordinary = ORDINARY * median(self._measured)
        return self.ordinary


def _measured() -> float:
    began = thread_time()
    pose(_LINKS, Convention.STANDARD)
    return thread_time() - began
