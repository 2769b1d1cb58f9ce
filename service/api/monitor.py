"""What looks on while requests are answered, where the service is watched."""

from typing import Protocol

from starlette.types import ASGIApp

from service.grading import Report


class Monitor(Protocol):
    """Counts what happens; what it is told changes no answer."""

    def watched(self, app: ASGIApp) -> ASGIApp:
        """The application with a layer around it that sees every request and its answer."""

    def graded(self, report: Report, seconds: float) -> None:
        """Count a report that took so long."""

    def refused(self, answer: str) -> None:
        """Count what is refused before the application sees it: with a status, or "none"."""
