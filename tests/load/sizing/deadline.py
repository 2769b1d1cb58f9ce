"""Simulate a class that submits before a deadline, and how long students wait."""

# In the model, students work for a week. The times of submission follow a power law: half of the
# students submit on the last day, about one in six in the last hour, and one in 27 in the last
# minute. Before that, a student types the answers (each pause sends a preview) and checks them;
# some are wrong. Each student's connection goes to a random process, which answers one request at a
# time.

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
# Measured processor seconds of requests, by their kind.
Costs = Mapping[str, Numbers]

WEEK: Final = 7 * 24 * 3600.0
HOUR: Final = 3600.0
# Half of all hand-ins in the last of seven days: (1 / 7) ** EXPONENT is 1 / 2.
EXPONENT: Final = float(np.log(2) / np.log(7))
# What a student asks for before and with a hand-in: how often, and within how many seconds.
REQUESTS: Final[Mapping[str, tuple[int, float]]] = {
    "page": (1, 1800.0),
    "preview": (60, 1800.0),
    "right": (1, 900.0),
    "wrong": (3, 1800.0),
    "hand_in": (1, 1.0),
}


@dataclass(frozen=True)
class Waits:
    """The waiting times in the last hour, and the greatest load."""

    # `busiest` is the load of the processes in the busiest minute: 1 means that all are busy for
    # the whole minute.
    median: float
    p99: float
    longest: float
    busiest: float


def before_deadline(students: int, choose: np.random.Generator) -> Numbers:
    """Return each student's time between hand-in and deadline, in seconds."""
    return WEEK * choose.random(students) ** (1 / EXPONENT)


def waits(students: int, processes: int, seconds: Costs, choose: np.random.Generator) -> Waits:
    """Simulate the last hour before the deadline."""
    moments, costs, places, handed_in = [], [], [], []
    hand_ins = -before_deadline(students, choose)
    at = choose.integers(processes, size=students)
    for kind, (times, span) in REQUESTS.items():
        asked = hand_ins[:, None] - span * choose.random((students, times))
        moments.append(asked.ravel())
        costs.append(choose.choice(seconds[kind], asked.size))
        places.append(np.repeat(at, times))
        handed_in.append(np.full(asked.size, kind == "hand_in"))
    asked, cost, place, counts = map(np.concatenate, (moments, costs, places, handed_in))
    is_late = asked > -HOUR
    asked, cost, place, counts = asked[is_late], cost[is_late], place[is_late], counts[is_late]
    answered = np.empty_like(asked)
    for k in range(processes):
        answered[place == k] = waited(asked[place == k], cost[place == k])
    minute = np.bincount(((asked + HOUR) // 60).astype(int), weights=cost)
    return Waits(
        median=float(np.median(answered[counts])),
        p99=float(np.quantile(answered[counts], 0.99)),
        longest=float(answered[counts].max()),
        busiest=float(minute.max() / 60 / processes),
    )


def waited(asked: Numbers, cost: Numbers) -> Numbers:
    """Return the waiting times at one process, which takes requests in order."""
    # Work on a request begins when it arrives or when the previous work ends, whichever is later.
    order = np.argsort(asked, kind="stable")
    asked, cost = asked[order], cost[order]
    worked = np.cumsum(cost)
    ends = worked + np.maximum.accumulate(asked - worked + cost)
    found = np.empty_like(ends)
    found[order] = ends - asked
    return found


def most_students(processes: int, seconds: Costs, p99: float, choose: np.random.Generator) -> int:
    """Return the largest class in which 99 % wait at most ``p99`` seconds."""
    enough, too_many = 100, 100
    while waits(too_many, processes, seconds, choose).p99 <= p99:
        enough, too_many = too_many, 2 * too_many
    while too_many - enough > enough // 20:
        middle = (enough + too_many) // 2
        if waits(middle, processes, seconds, choose).p99 <= p99:
            enough = middle
        else:
            too_many = middle
    return int(float(f"{enough:.1e}"))
