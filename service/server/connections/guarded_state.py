"""The state that all connections of a server share."""

from collections.abc import Sequence

from fastapi import Response
from starlette.datastructures import Headers
from uvicorn.server import ServerState

from service.api.http.problems import ProblemError
from service.api.monitor import Monitor
from service.server.connections.early_cors import cors_headers
from service.server.connections.open_connections import OpenConnections, allowed_here
from service.server.refusals import refusal_response


class GuardedState(ServerState):
    """The state that all connections of a server share.

    Web pages of ``origins`` may read the responses to refused requests.
    """

    def __init__(self, origins: Sequence[str] = (), monitor: Monitor | None = None) -> None:
        super().__init__()
        self.open_connections = OpenConnections(allowed_here())
        self._origins = origins
        self._monitor = monitor

    def note_refusal(self, answer: str) -> None:
        """Count a refused request; ``answer`` is the status code of the response, or "none"."""
        if self._monitor is not None:
            self._monitor.refused(answer)

    def refusal(
        self, problem: ProblemError, path: str, origin: str, headers: Headers | None = None
    ) -> Response:
        """Count a refused request from a page of ``origin``, and return the error response."""
        self.note_refusal(str(problem.status.value))
        answer = refusal_response(problem, path, headers)
        answer.headers.update(cors_headers(self._origins, origin))
        return answer
