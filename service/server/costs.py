"""What a request is likely to cost: what others of its connection, or like it, have cost before.

What a body costs is known when it has been graded, too late to let others go first. But whoever
sends one costly body sends more of them: over the same connection, or, where each has a connection
of its own, from the same address and with about the same length.
"""

from collections import OrderedDict
from collections.abc import Hashable
from math import log2
from typing import Final

from service.server.fair_queue import Ticket

# A request is costly that takes so many times what is typical of the others. A wrong table with its
# diagnosis takes five to twelve times what a right one takes, the costliest body a hundred times.
_COSTLY: Final = 14.0
# But no request is that takes less, in seconds of processor time: somebody who asks for nothing but
# trifles has no say in what is costly.
_LEAST_COSTLY: Final = 0.008
# What is typical until that is known, in seconds of processor time, and its steps with each
# request. It falls faster than it rises: a third of the ordinary requests take less, and hold it
# against an attacker's.
_FIRST_TYPICAL: Final = 0.001
_UP, _DOWN = 1.01, 1.02
# The share of the last request in the expectation: one that is cheap does not hide one that is not.
_RECENT: Final = 0.5
# Lengths are alike that differ by less than a fifth.
_ALIKE: Final = 4.0
_KEPT: Final = 10_000
_LONGEST_REST: Final = 2.0


class Costs:
    """The mean processor time of late, by connection and length, and what is typical."""

    def __init__(self) -> None:
        self._means: OrderedDict[Hashable, float] = OrderedDict()
        self._typical = _FIRST_TYPICAL

    def is_costly(self, seconds: float) -> bool:
        """Whether a request is costly that takes so much time."""
        return seconds > self._bound

    @property
    def _bound(self) -> float:
        return max(_COSTLY * self._typical, _LEAST_COSTLY)

    def rest(self, seconds: float) -> float:
        """How many seconds after another costly request one may come that will take so much time.

        For one that is hardly costly these are three times as many as it takes, for one that takes
        twice as much twelve times as many.
        """
        return min(3.0 * seconds * (seconds / self._bound) ** 2, _LONGEST_REST)

    def expected(self, ticket: Ticket) -> float:
        """Seconds that a request is likely to take; 0 where nothing is known."""
        mean = self._means.get(_connection(ticket))
        return self._means.get(_length(ticket), 0.0) if mean is None else mean

    def note(self, ticket: Ticket, seconds: float, *, ordinary: bool) -> None:
        """Note what a request has taken; the ``ordinary`` ones say what is costly."""
        for key in (_connection(ticket), _length(ticket)):
            mean = self._means.pop(key, seconds)
            self._means[key] = mean + _RECENT * (seconds - mean)
        while len(self._means) > _KEPT:
            self._means.popitem(last=False)
        if ordinary:
            self._typical *= _UP if seconds > self._typical else 1 / _DOWN


def _connection(ticket: Ticket) -> Hashable:
    return ticket.client, ticket.connection


def _length(ticket: Ticket) -> Hashable:
    """A key that lengths share that are alike; no connection has it."""
    return ticket.client, "length", round(_ALIKE * log2(1 + ticket.size))
