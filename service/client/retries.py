"""The rules by which failed calls are retried."""

import random
from dataclasses import dataclass

from service.client.errors import GraderClientError


@dataclass(frozen=True, slots=True)
class Retries:
    """The number of retries, and the waits before them in seconds.

    The waits double from ``first_wait`` up to ``longest_wait``.
    """

    # By default, the waits last 15 seconds in all, so that a service can restart meanwhile. Each
    # wait is shortened at random by up to half, so that clients that failed together do not retry
    # together. A wait that the service asks for is added; if it is longer than
    # ``longest_wait``, the client gives up.

    number: int = 5
    first_wait: float = 0.5
    longest_wait: float = 30.0

    def wait(self, failures: int, error: GraderClientError) -> float | None:
        """Return the seconds to wait after this number of failures, or None to give up."""
        # Only temporary failures are retried: no response, or the status 429, 502, 503 or 504.
        if failures > self.number or not error.is_temporary:
            return None
        if error.retry_after > self.longest_wait:
            return None
        longest = min(self.first_wait * 2.0 ** (failures - 1), self.longest_wait)
        return error.retry_after + random.uniform(longest / 2, longest)
