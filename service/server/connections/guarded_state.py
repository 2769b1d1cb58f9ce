"""What all connections of a server share, and the refusals that the application does not see."""

from collections.abc import Sequence

from fastapi import Response
from starlette.datastructures import Headers
from uvicorn.server import ServerState

from service.api.http.problems import ProblemError
from service.api.monitor import Monitor
from service.server.connections.early_cors import leave_to_read
from service.server.connections.open_connections import Crowd, room_here
from service.server.refusals import named


class GuardedState(ServerState):
    """What all connections of a server share; pages of ``origins`` may read refusals, too."""

    def __init__(self, origins: Sequence[str] = (), monitor: Monitor | None = None) -> None:
        super().__init__()
        self.crowd = Crowd(room_here())
        self._origins = origins
        self._monitor = monitor

    def note_refusal(self, answer: str) -> None:
        """Count a request, or a connection, that is refused with this answer."""
        if self._monitor is not None:
            self._monitor.refused(answer)

    def refusal(
        self, problem: ProblemError, path: str, origin: str, headers: Headers | None = None
    ) -> Response:
        """The answer to a request of a page of ``origin``, which is counted."""
        self.note_refusal(str(problem.status.value))
        answer = named(problem, path, headers)
        answer.headers.update(leave_to_read(self._origins, origin))
        return answer
