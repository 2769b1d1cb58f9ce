"""The reasons why a score did not reach a platform, as sentences for tutors."""

import json
from collections.abc import Mapping
from typing import Any, Final

from service.lti.problems import short_value
from service.translations import ENGLISH, Language, Sentence, SentenceValue, template
from service.translations import told as told_in

# By their names. Braces are places for values.
SCORE_PROBLEMS: Final[Mapping[str, str]] = {
    "not-accepted": template(
        "The platform refuses the score (status {status}). Is the learner still "
        "enrolled in the course there?"
    ),
    "no-line-item": template(
        "The platform has no column for this assignment any more. Open the assignment "
        "from the course at the platform, then send again."
    ),
    "no-token-address": template(
        "No token address is registered for this platform. Register it, then send again."
    ),
    "no-scope": template(
        "The platform does not allow to make a column for the assignment. Allow it at the "
        "platform, open the assignment there, then send again."
    ),
    "token-refused": template("The platform gives no access token: {reason}"),
    "busy": template("The platform asks to wait (status {status})."),
    "unreachable": template("The platform cannot be reached: {reason}"),
    "unusable-answer": template("The answer of the platform cannot be used: {reason}"),
    "unauthorised": template("The platform refuses the access token (status 401)."),
    "stamp": template("The platform has a score with a later time."),
    "no-secret": template(
        "The secret of the service is not the one with which its keys were made."
    ),
    "failed": template("The service could not send the score. Its log has the cause."),
}
# The same for reports on handed-in files, where the sentence is another one.
_REPORT_PROBLEMS: Final[Mapping[str, str]] = {
    "not-accepted": template("The platform refuses the report (status {status})."),
    "no-token-address": template("No token address is registered for this platform."),
    "stamp": template("The platform has a report with a later time."),
    "failed": template("The service could not grade the files. Its log has the cause."),
}


class ScoreError(Exception):
    """A score was not sent; ``name`` is one of ``SCORE_PROBLEMS``."""

    def __init__(self, name: str, /, **values: object) -> None:
        self.name = name
        self.values = {key: short_value(value) for key, value in values.items()}
        super().__init__(Sentence(SCORE_PROBLEMS[name], self.values))

    @property
    def stored(self) -> str:
        """The problem as a text for the database."""
        return json.dumps([self.name, _packed(self.values)])


class RefusedError(ScoreError):
    """The platform will not take the score, however often it is sent."""


class LaterError(ScoreError):
    """The platform accepts nothing now; ``seconds`` is the time that it asks to wait, or None."""

    def __init__(self, name: str, /, seconds: float | None = None, **values: object) -> None:
        self.seconds = seconds
        super().__init__(name, **values)


class ThisLaterError(ScoreError):
    """The platform does not accept this score now, but may accept other scores."""


def told(stored: str | None, language: Language = ENGLISH, *, of_report: bool = False) -> str:
    """Return the sentence that describes a stored problem, or "".

    ``of_report`` is True for a report on files, False for a score.
    """
    if not stored:
        return ""
    name, values = json.loads(stored)
    sentences = {**SCORE_PROBLEMS, **_REPORT_PROBLEMS} if of_report else SCORE_PROBLEMS
    return told_in(Sentence(sentences[name], _unpacked(values)), language.translation)


def _packed(values: Mapping[str, SentenceValue]) -> dict[str, Any]:
    # JSON cannot store a Sentence: store its template and values.
    return {
        key: [value.template, _packed(value.values)] if isinstance(value, Sentence) else value
        for key, value in values.items()
    }


def _unpacked(values: Mapping[str, Any]) -> dict[str, SentenceValue]:
    return {
        key: Sentence(value[0], _unpacked(value[1])) if isinstance(value, list) else value
        for key, value in values.items()
    }
