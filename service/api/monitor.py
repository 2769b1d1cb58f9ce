"""The interface through which the application counts requests and reports in the metrics."""

from typing import Protocol

from starlette.types import ASGIApp

from service.grading import Report


class Monitor(Protocol):
    """Counts requests and reports, without changing any response."""

    def watched(self, app: ASGIApp) -> ASGIApp:
        """Return the application, wrapped in a layer that counts requests."""

    def graded(self, report: Report, seconds: float) -> None:
        """Count a report, and record how many seconds the grading took."""

    def refused(self, answer: str) -> None:
        """Count a refused request; ``answer`` is the status code of the response, or "none"."""
