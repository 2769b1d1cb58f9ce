"""Findings: the messages of a grading, before the feedback level decides what is visible."""

from dataclasses import dataclass
from enum import StrEnum

from service.grading.report import Feedback, Severity


class FeedbackLevel(StrEnum):
    """The amount that a report tells: all, all but the correction, or only the reading."""

    FULL = "full"
    VERDICTS = "verdicts"
    SCORE = "score"


@dataclass(frozen=True, slots=True)
class Finding:
    """A message in two sentences: a hint where to look, and the correction itself.

    ``code`` is stable, so that a class can be counted. ``values`` is a counterexample. ``reading``
    marks a finding on the reading of a text and not on its worth: it gives nothing away and is
    visible at every level. ``suggestion`` is the repaired text of one that cannot be read.
    """

    code: str
    hint: str
    correction: str = ""
    severity: Severity = Severity.ERROR
    span: tuple[int, int] | None = None
    values: dict[str, float | str] | None = None
    reading: bool = False
    suggestion: str | None = None

    def visible(
        self, level: FeedbackLevel, row: str | None = None, cell: str | None = None
    ) -> Feedback | None:
        """The message at this level, or None where the level keeps it back."""
        if level is FeedbackLevel.SCORE and not self.reading:
            return None
        tells_all = level is FeedbackLevel.FULL or self.reading
        message = f"{self.hint} {self.correction}" if tells_all and self.correction else self.hint
        return Feedback(
            code=self.code,
            severity=self.severity,
            message=message,
            row=row,
            cell=cell,
            span=self.span,
            values=self.values if level is FeedbackLevel.FULL else None,
        )


def reading_error(code: str, message: str, span: tuple[int, int] | None = None) -> Finding:
    """The finding that something cannot be read."""
    return Finding(code, message, span=span, reading=True)


def reading_note(code: str, message: str, span: tuple[int, int] | None = None) -> Finding:
    """The finding that something was read, and how."""
    return Finding(code, message, severity=Severity.INFO, span=span, reading=True)


class UnreadableAnswerError(Exception):
    """Nothing of an answer can be read; ``finding`` says what it would have to look like."""

    def __init__(self, finding: Finding) -> None:
        super().__init__(finding.hint)
        self.finding = finding


ROUNDED = Finding(
    "rounded",
    "Accepted, though rounded: write it exactly (pi/2, sqrt(2)/2) and nothing can be lost.",
    severity=Severity.INFO,
)


def visible_messages(
    findings: tuple[Finding, ...],
    level: FeedbackLevel,
    row: str | None = None,
    cell: str | None = None,
) -> tuple[Feedback, ...]:
    """The messages that the level lets through."""
    if not findings:
        return ()
    feedback = (finding.visible(level, row, cell) for finding in findings)
    return tuple(message for message in feedback if message is not None)
