"""The interface through which the application counts requests and reports in the metrics."""

from typing import Protocol

from starlette.types import ASGIApp

from service.grading import Report


class Monitor(Protocol):
    """Counts requests and reports. It changes no response."""

    def watched(self, app: ASGIApp) -> ASGIApp:
        """Return the application in a layer that sees every request and its response."""

    def graded(self, report: Report, seconds: float) -> None:
        """Count a report, and record how many seconds the grading took."""

    def refused(self, answer: str) -> None:
        """Count a refusal; ``answer`` is the status code of the response, or "none"."""
