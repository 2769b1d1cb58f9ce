"""The levels of feedback in a report."""

from enum import StrEnum


class FeedbackLevel(StrEnum):
    """The level of feedback in a report, from the most to the least.

    ``full``: hints and corrections. ``hints``: hints without values. ``verdicts``: right and wrong
    entries. ``score``: only marks. All levels name unreadable entries.
    """

    FULL = "full"
    HINTS = "hints"
    VERDICTS = "verdicts"
    SCORE = "score"


_FROM_THE_MOST = tuple(FeedbackLevel)


def least(*levels: FeedbackLevel) -> FeedbackLevel:
    """Return the level with the least feedback."""
    return max(levels, key=_FROM_THE_MOST.index)
