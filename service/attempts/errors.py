"""The errors that the store of attempts raises. This module loads no database driver."""


class StoreDownError(Exception):
    """The database cannot be reached, cannot write, or does not respond.

    Nothing was written, unless only the database's reply to a commit was lost.
    """


class UnusableDatabaseError(Exception):
    """The database at this URL cannot be used; the message says why."""


class UnknownAttemptError(LookupError):
    """No attempt has this id."""


class UnusablePointsError(ValueError):
    """The number of points is not allowed; the message says why."""


class BadCursorError(ValueError):
    """The text is not a valid cursor."""
