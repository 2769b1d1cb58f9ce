"""The work that the reading of one submission may set going, counted and never timed.

Counted work is the same on every machine, so that the same submission gives the same report.
"""

from dataclasses import dataclass

# The pose of a seven-joint arm, multiplied out, not simplified and printed as LaTeX, has 21,000.
MAX_CHARACTERS = 24_000
# What cannot be read takes up to three times as long for each character.
UNREADABLE_COST = 3
# To look for the repaired text of an unreadable one costs more than any other reading.
MAX_REPAIRS = 12
# A text of so many characters takes one repair more for each further so many.
CHARACTERS_PER_REPAIR = 250


@dataclass(slots=True)
class WorkBudget:
    """The work left for a submission: one object for all its parts, pasted texts and units.

    ``characters`` counts those that may still be read, ``repairs`` the unreadable texts for which
    a repaired one may still be looked for.
    """

    characters: int = MAX_CHARACTERS
    repairs: int = MAX_REPAIRS

    def charge_unreadable(self, characters: int) -> None:
        """Count a text that could not be read, whose characters were counted once before."""
        self.characters -= (UNREADABLE_COST - 1) * characters
        self.repairs -= 1 + characters // CHARACTERS_PER_REPAIR
