"""What the application reports to the metrics."""

from typing import Protocol

from starlette.types import ASGIApp

from service.grading import Report


class Monitor(Protocol):
    """Counts requests and reports. It changes no answer."""

    def watched(self, app: ASGIApp) -> ASGIApp:
        """Return the application in a layer that sees every request and its answer."""

    def graded(self, report: Report, seconds: float) -> None:
        """Count a report, and the seconds that its grading took."""

    def refused(self, answer: str) -> None:
        """Count a refused request or connection; ``answer`` is the status code, or "none"."""
