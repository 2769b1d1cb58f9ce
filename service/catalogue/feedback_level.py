"""How much a report tells."""

from enum import StrEnum


class FeedbackLevel(StrEnum):
    """How much a report tells, from the most to the least.

    ``full``: hints and corrections. ``hints``: what to look at, never the value. ``verdicts``:
    right and wrong, and what could not be read. ``score``: bare marks, and what could not be read.
    """

    FULL = "full"
    HINTS = "hints"
    VERDICTS = "verdicts"
    SCORE = "score"


_FROM_THE_MOST = tuple(FeedbackLevel)


def least(*levels: FeedbackLevel) -> FeedbackLevel:
    """That of the levels which tells the least."""
    return max(levels, key=_FROM_THE_MOST.index)
