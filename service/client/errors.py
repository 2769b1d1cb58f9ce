"""The reasons why a call has no result."""

from http import HTTPStatus
from typing import Final

from service.contract.problems import Reason

# The service has too much to do, or a proxy before it finds none while it is started again.
_TEMPORARY: Final = {
    HTTPStatus.TOO_MANY_REQUESTS,
    HTTPStatus.BAD_GATEWAY,
    HTTPStatus.SERVICE_UNAVAILABLE,
    HTTPStatus.GATEWAY_TIMEOUT,
}


class GraderClientError(Exception):
    """A call has no result; the text says why.

    ``is_temporary`` says that the same call may succeed later, ``retry_after`` in how many seconds
    at the earliest.
    """

    def __init__(
        self, message: str, *, is_temporary: bool = False, retry_after: float = 0.0
    ) -> None:
        super().__init__(message)
        self.is_temporary = is_temporary
        self.retry_after = retry_after


class RequestRefusedError(GraderClientError):
    """The service answered with a problem.

    ``status`` is that of HTTP, ``code`` the name of the problem (such as ``unknown-exercise``) or
    empty, ``message`` its explanation. ``reasons`` has one entry for each fault, with its place in
    the body.
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
    """No answer came, or not the whole of it."""


class UnexpectedAnswerError(GraderClientError):
    """The server answered as no DH Grader does, or none of this version.

    A redirection counts as such: a client that follows one may give its key away.
    """
