"""When a call that failed is tried again."""

import random
from dataclasses import dataclass

from service.client.errors import GraderClientError


@dataclass(frozen=True, slots=True)
class Retries:
    """How often a call is tried again, and the seconds to wait before that.

    The waits double from ``first_wait`` on, up to ``longest_wait``: with these numbers 15 seconds
    in all, in which a service is started again. Each is drawn between half and the whole of that,
    so that clients which failed together do not come back together. A service that names a time
    gets at least that; one that names more than ``longest_wait`` is not asked again.
    """

    number: int = 5
    first_wait: float = 0.5
    longest_wait: float = 30.0

    def wait(self, failures: int, error: GraderClientError) -> float | None:
        """The seconds to wait after so many failures, or None where the last one stands.

        Only what is temporary is tried again: no answer, or one of the statuses 429, 502, 503, 504.
        """
        if failures > self.number or not error.is_temporary:
            return None
        if error.retry_after > self.longest_wait:
            return None
        longest = min(self.first_wait * 2.0 ** (failures - 1), self.longest_wait)
        return error.retry_after + random.uniform(longest / 2, longest)
