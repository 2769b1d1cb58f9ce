"""Why a score did not arrive: what the tutor reads."""

import json
from collections.abc import Mapping
from typing import Final

# By their names. Braces are places for values.
SCORE_PROBLEMS: Final[Mapping[str, str]] = {
    "not-accepted": "The platform refuses the score (status {status}). Is the learner still "
    "enrolled in the course there?",
    "no-line-item": "The platform has no column for this assignment any more. Open the assignment "
    "from the course at the platform, then send again.",
    "no-token-address": "No token address is registered for this platform. Register it, then send "
    "again.",
    "no-scope": "The platform does not allow to make a column for the assignment. Allow it at the "
    "platform, open the assignment there, then send again.",
    "token-refused": "The platform gives no access token: {reason}",
    "busy": "The platform asks to wait (status {status}).",
    "unreachable": "The platform cannot be reached: {reason}",
    "unusable-answer": "The answer of the platform cannot be used: {reason}",
    "unauthorised": "The platform refuses the access token (status 401).",
    "stamp": "The platform has a score with a later time.",
    "no-secret": "The secret of the service is not the one with which its keys were made.",
    "failed": "The service could not send the score. Its log has the cause.",
}
# The same for reports on handed-in files, where the sentence is another one.
_REPORT_PROBLEMS: Final[Mapping[str, str]] = {
    "not-accepted": "The platform refuses the report (status {status}).",
    "no-token-address": "No token address is registered for this platform.",
    "stamp": "The platform has a report with a later time.",
    "failed": "The service could not grade the files. Its log has the cause.",
}


class ScoreError(Exception):
    """A score was not sent; ``name`` is one of ``SCORE_PROBLEMS``."""

    def __init__(self, name: str, /, **values: object) -> None:
        self.name = name
        self.values = {key: str(value)[:200] for key, value in values.items()}
        super().__init__(told(self.stored))

    @property
    def stored(self) -> str:
        """The problem as a text for the database."""
        return json.dumps([self.name, self.values])


class RefusedError(ScoreError):
    """The platform will not take the score, however often it is sent."""


class LaterError(ScoreError):
    """The platform takes nothing now; ``seconds`` is how long it asks to wait, if it says so."""

    def __init__(self, name: str, /, seconds: float | None = None, **values: object) -> None:
        self.seconds = seconds
        super().__init__(name, **values)


class ThisLaterError(ScoreError):
    """This score is not taken now; others may be."""


def told(stored: str | None, *, of_report: bool = False) -> str:
    """Return the sentence of a stored problem of a score, or of a report; or ""."""
    if not stored:
        return ""
    name, values = json.loads(stored)
    sentences = {**SCORE_PROBLEMS, **_REPORT_PROBLEMS} if of_report else SCORE_PROBLEMS
    return sentences[name].format_map(values)
