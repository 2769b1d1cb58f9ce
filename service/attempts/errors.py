"""The failures that callers of the store tell apart; it loads no database driver."""


class StoreDownError(Exception):
    """The database cannot be reached, cannot write, or does not react.

    What was asked for was not done, unless the answer to a commit was lost.
    """


class UnusableDatabaseError(Exception):
    """The URL names no database that can be used; the text says why."""


class UnknownAttemptError(LookupError):
    """No attempt has this id."""


class UnusablePointsError(ValueError):
    """So many points cannot be given; the text says why."""


class BadCursorError(ValueError):
    """The text is no cursor of a page."""
