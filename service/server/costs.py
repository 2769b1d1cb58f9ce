"""What a request is likely to cost: what others of its connection, or like it, have cost before.

What a body costs is known when it has been graded, too late to let others go first. But whoever
sends one costly body sends more of them: over the same connection, or, where each has a connection
of its own, from the same address and with about the same length.

What is costly is measured by the pace of the machine, in which no client has a say.
"""

from collections import OrderedDict
from collections.abc import Callable, Hashable
from math import log2
from typing import Final

from service.server.fair_queue import Ticket

# A request is costly that takes so many units of work. A right table takes 6 to 12, nineteen of
# twenty honest ones up to 75 on a busy machine, the costliest body 110 to 300.
_COSTLY: Final = 80.0
# Seconds of processor time between two measurements of the pace, and the share of the last.
_MEASURED: Final = 0.2
_RECENT_PACE: Final = 0.2
# The classes of cost: ordinary, up to twice the bound, up to four times, more.
CLASSES: Final = 4
# How many times as long as a costly request took the process rests from its class: so the class has
# a tenth of the process, and few of the others find it busy.
REST: Final = 9.0
# The share of the last request in the expectation: one that is cheap does not hide one that is not.
_RECENT: Final = 0.5
# Lengths are alike that differ by less than a fifth.
_ALIKE: Final = 4.0
_KEPT: Final = 10_000


class Costs:
    """The mean processor time of late, by connection and length, and what is costly.

    ``measure`` gives the seconds that one unit of work takes at present.
    """

    def __init__(self, measure: Callable[[], float]) -> None:
        self._means: OrderedDict[Hashable, float] = OrderedDict()
        self._measure = measure
        # At first all is cold, and honest requests take twice as long.
        self._unit = 2 * measure()
        self._since_measured = 0.0

    def class_of(self, seconds: float) -> int:
        """The class of a request that takes so much time: 0 where it is ordinary."""
        times = seconds / (_COSTLY * self._unit)
        return 0 if times <= 1.0 else min(1 + int(log2(times)), CLASSES - 1)

    def expected(self, ticket: Ticket) -> float:
        """Seconds that a request is likely to take; 0 where nothing is known."""
        mean = self._means.get(_connection(ticket))
        return self._means.get(_length(ticket), 0.0) if mean is None else mean

    def note(self, ticket: Ticket, seconds: float) -> None:
        """Note what a request has taken."""
        for key in (_connection(ticket), _length(ticket)):
            mean = self._means.pop(key, seconds)
            self._means[key] = mean + _RECENT * (seconds - mean)
        while len(self._means) > _KEPT:
            self._means.popitem(last=False)
        self._since_measured += seconds
        if self._since_measured >= _MEASURED:
            self._since_measured = 0.0
            # Somebody else's program may have had the processor meanwhile.
            unit = min(self._measure(), 2 * self._unit)
            self._unit += _RECENT_PACE * (unit - self._unit)


def rest(seconds: float, steps: int) -> float:
    """How long to rest, after a costly request, from those so many classes away."""
    return REST * seconds * 0.5**steps


def _connection(ticket: Ticket) -> Hashable:
    return ticket.client, ticket.connection


def _length(ticket: Ticket) -> Hashable:
    """A key that lengths share that are alike; no connection has it."""
    return ticket.client, "length", round(_ALIKE * log2(1 + ticket.size))
