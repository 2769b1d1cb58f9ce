"""The answer of a server: received within bounds, and the error where it is no success."""

import ssl
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from email.utils import parsedate_to_datetime
from socket import EAI_NONAME, gaierror
from typing import Final

import httpx
from pydantic import ValidationError

from service.client.errors import (
    GraderClientError,
    RequestRefusedError,
    ServerUnreachableError,
    UnexpectedAnswerError,
)
from service.contract.problems import TYPE_PREFIX, ProblemDocument

# Far over the reports on as many submissions as one request may hold.
MAX_ANSWER: Final = 64 * 1024 * 1024


@dataclass(frozen=True, slots=True)
class HttpAnswer:
    """A whole answer."""

    status: int
    headers: httpx.Headers
    content: bytes


@dataclass
class AnswerPieces:
    """The pieces of an answer as they come; ``seconds`` is the time for all of them.

    The time limits of httpx count from piece to piece, so that a server which sends a byte now and
    then would never reach them.
    """

    response: httpx.Response
    seconds: float
    _content: bytearray = field(default_factory=bytearray)
    _began: float = field(default_factory=time.monotonic)

    def add(self, piece: bytes) -> None:
        """Add a piece. Raises httpx.ReadTimeout or UnexpectedAnswerError."""
        self._content += piece
        if len(self._content) > MAX_ANSWER:
            raise UnexpectedAnswerError(
                f"The answer has more than {MAX_ANSWER // 1024**2} MiB, as no report has."
            )
        if time.monotonic() - self._began > self.seconds:
            raise httpx.ReadTimeout(f"no whole answer within {self.seconds:g} seconds")

    def whole(self) -> HttpAnswer:
        """The answer, of which all pieces have come."""
        return HttpAnswer(self.response.status_code, self.response.headers, bytes(self._content))


def unreachable(server: str, error: httpx.TransportError) -> ServerUnreachableError:
    """The error for one of the connection to this server."""
    reason = str(error) or type(error).__name__
    message = f"{server} cannot be reached: {reason}"
    return ServerUnreachableError(message, is_temporary=not any(map(_stays, _causes(error))))


def error_in(server: str, answer: HttpAnswer) -> GraderClientError:
    """The error for an answer that is no success."""
    if location := answer.headers.get("location"):
        return UnexpectedAnswerError(
            f"{server} redirects to {location}; if you trust that address, call it instead."
        )
    wait = _seconds(answer.headers.get("retry-after", ""))
    try:
        problem = ProblemDocument.model_validate_json(answer.content)
    except ValidationError:
        # Of a proxy, perhaps: the page that it shows to people says nothing to a program.
        message = f"{server} answers with the status {answer.status}."
        return RequestRefusedError(answer.status, message, retry_after=wait)
    name = problem.type.removeprefix(TYPE_PREFIX) if problem.type.startswith(TYPE_PREFIX) else ""
    reasons = tuple(problem.errors or ())
    return RequestRefusedError(
        answer.status, problem.detail, name=name, reasons=reasons, retry_after=wait
    )


def _seconds(retry_after: str) -> float:
    """The seconds of a header ``Retry-After``, which may be a date; 0 where it says nothing."""
    if retry_after.isascii() and retry_after.isdigit():
        return float(retry_after[:9])
    try:
        date = parsedate_to_datetime(retry_after)
    except (ValueError, TypeError):
        return 0.0
    return max(0.0, date.timestamp() - time.time())


def _stays(cause: BaseException) -> bool:
    """Whether a failure will be there again: no such host, or a certificate that is not trusted."""
    if isinstance(cause, gaierror):
        return cause.errno == EAI_NONAME
    return isinstance(cause, ssl.SSLCertVerificationError)


def _causes(error: BaseException | None) -> Iterator[BaseException]:
    while error is not None:
        yield error
        error = error.__cause__ or error.__context__
