"""The exceptions of the client."""

from http import HTTPStatus
from typing import Final

from service.contract.problems import Reason

# The service is overloaded, or it restarts behind a proxy.
_TEMPORARY: Final = {
    HTTPStatus.TOO_MANY_REQUESTS,
    HTTPStatus.BAD_GATEWAY,
    HTTPStatus.SERVICE_UNAVAILABLE,
    HTTPStatus.GATEWAY_TIMEOUT,
}


class GraderClientError(Exception):
    """A call failed; the message says why.

    If ``is_temporary``, the call may succeed after ``retry_after`` seconds.
    """

    def __init__(
        self, message: str, *, is_temporary: bool = False, retry_after: float = 0.0
    ) -> None:
        super().__init__(message)
        self.is_temporary = is_temporary
        self.retry_after = retry_after


class RequestRefusedError(GraderClientError):
    """The service answered with an error.

    ``status`` is the HTTP status, ``code`` the name of the error, such as ``unknown-exercise``.
    ``reasons`` describes each fault of the request.
    """

    def __init__(
        self,
        status: int,
        message: str,
        *,
        name: str = "",
        reasons: tuple[Reason, ...] = (),
        retry_after: float = 0.0,
    ) -> None:
        super().__init__(message, is_temporary=status in _TEMPORARY, retry_after=retry_after)
        self.status = status
        self.code = name
        self.message = message
        self.reasons = reasons


class ServerUnreachableError(GraderClientError):
    """There was no response, or the response was incomplete."""


class UnexpectedAnswerError(GraderClientError):
    """The response is not from a DH Grader of this version."""

    # A redirect also raises this error: a client that follows a redirect may reveal its key.
