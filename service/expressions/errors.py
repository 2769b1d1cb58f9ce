"""What the reader tells a student: one error that stops, and notes that do not."""

from dataclasses import dataclass

Span = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Note:
    """Something worth knowing about how a text was read.

    `span` is [from, to) in the text that the student typed.
    """

    code: str
    message: str
    span: Span


class ExpressionError(Exception):
    """A text that cannot be read.

    `code` is stable, so that a class can be counted. `span` is [from, to) in the text that the
    student typed. `suggestion` is the whole repaired text where one is near, else None.
    """

    def __init__(self, code: str, message: str, span: Span, suggestion: str | None = None) -> None:
        super().__init__(code, message, span, suggestion)
        self.code = code
        self.message = message
        self.span = span
        self.suggestion = suggestion

    def __str__(self) -> str:
        return self.message

    def again(self) -> "ExpressionError":
        """Return an equal error without a traceback, so that a remembered one can be raised."""
        return ExpressionError(self.code, self.message, self.span, self.suggestion)
