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

# Pasted texts are cut into cells, whose characters are counted once more when they are read. The
# longest text leaves half as much for the other parts.
MAX_PASTED = 36_000


# In units of the least work that a grading can be: six links multiplied out at all samples.
MAX_EXPLANATIONS = 150.0


@dataclass(slots=True)
class WorkBudget:
    """The work left for a submission: one object for all its parts, pasted texts and units.

    ``characters`` counts those that may still be read, ``repairs`` the unreadable texts for which
    a repaired one may still be looked for. ``pasted`` counts the characters of texts that may
    still be cut into cells. ``explanations`` is the work that may still be spent on what is wrong
    and why; verdicts and points draw on nothing.
    """

    characters: int = MAX_CHARACTERS
    repairs: int = MAX_REPAIRS
    pasted: int = MAX_PASTED
    explanations: float = MAX_EXPLANATIONS

    def affords(self, work: float) -> bool:
        """Whether there is so much left for explanations. It is taken, and what is gone is gone."""
        self.explanations -= work
        return self.explanations >= 0

    def charge_unreadable(self, characters: int) -> None:
        """Count a text that could not be read, whose characters were counted once before."""
        self.characters -= (UNREADABLE_COST - 1) * characters
        self.repairs -= 1 + characters // CHARACTERS_PER_REPAIR
