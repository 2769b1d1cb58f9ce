"""The work that the reading of one submission may set going, counted and never timed.

Counted work is the same on every machine, so that the same submission gives the same report.
"""

from dataclasses import dataclass

# A 4×4 matrix of a six-joint arm, multiplied out and not simplified, takes a third of it.
MAX_CHARACTERS = 12_000
# To look for the repaired text of an unreadable one costs more than any other reading.
MAX_REPAIRS = 12


@dataclass(slots=True)
class WorkBudget:
    """The work left for a submission: one object for all its parts, pasted texts and units.

    ``characters`` counts those that may still be read, ``repairs`` the unreadable texts for which
    a repaired one may still be looked for.
    """

    characters: int = MAX_CHARACTERS
    repairs: int = MAX_REPAIRS
