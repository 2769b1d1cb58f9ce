"""Receive the responses of a server within limits, and convert failures to exceptions."""

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
from service.translations import say

# Far larger than the reports on the most submissions in one request (bytes).
MAX_ANSWER: Final = 64 * 1024 * 1024


@dataclass(frozen=True, slots=True)
class HttpAnswer:
    """A complete response."""

    status: int
    headers: httpx.Headers
    content: bytes


@dataclass
class AnswerPieces:
    """Collects the pieces of a response; ``seconds`` is the time limit for the whole response."""

    # The time limits of httpx apply to each piece. A server that sends a byte now and then would
    # never exceed them.

    response: httpx.Response
    seconds: float
    _content: bytearray = field(default_factory=bytearray)
    _began: float = field(default_factory=time.monotonic)

    def add(self, piece: bytes) -> None:
        """Add a piece. Raises httpx.ReadTimeout or UnexpectedAnswerError."""
        self._content += piece
        if len(self._content) > MAX_ANSWER:
            raise UnexpectedAnswerError(
                say(
                    "The answer has more than {most} MiB; no report is so large.",
                    most=MAX_ANSWER // 1024**2,
                )
            )
        if time.monotonic() - self._began > self.seconds:
            raise httpx.ReadTimeout(f"no complete answer within {self.seconds:g} seconds")

    def whole(self) -> HttpAnswer:
        """Return the complete response, after the last piece."""
        return HttpAnswer(self.response.status_code, self.response.headers, bytes(self._content))


def unreachable(server: str, error: httpx.TransportError) -> ServerUnreachableError:
    """Convert a connection error of httpx to an exception of this client."""
    reason = str(error) or type(error).__name__
    message = say("{server} cannot be reached: {reason}", server=server, reason=reason)
    is_temporary = not any(map(_is_permanent, _causes(error)))
    return ServerUnreachableError(message, is_temporary=is_temporary)


def error_in(server: str, answer: HttpAnswer) -> GraderClientError:
    """Return the exception for an error response."""
    if location := answer.headers.get("location"):
        return UnexpectedAnswerError(
            say(
                "{server} redirects to {location}; if you trust that address, call it instead.",
                server=server,
                location=location,
            )
        )
    wait = _seconds(answer.headers.get("retry-after", ""))
    try:
        problem = ProblemDocument.model_validate_json(answer.content)
    except ValidationError:
        # Perhaps the answer of a proxy: its page for people is useless to a program.
        message = say(
            "{server} answers with the status {status}.", server=server, status=answer.status
        )
        return RequestRefusedError(answer.status, message, retry_after=wait)
    name = problem.type.removeprefix(TYPE_PREFIX) if problem.type.startswith(TYPE_PREFIX) else ""
    reasons = tuple(problem.errors or ())
    return RequestRefusedError(
        answer.status, problem.detail, name=name, reasons=reasons, retry_after=wait
    )


def _seconds(retry_after: str) -> float:
    if retry_after.isascii() and retry_after.isdigit():
        return float(retry_after[:9])
    try:
        date = parsedate_to_datetime(retry_after)
    except (ValueError, TypeError):
        return 0.0
    return max(0.0, date.timestamp() - time.time())


def _is_permanent(cause: BaseException) -> bool:
    if isinstance(cause, gaierror):
        return cause.errno == EAI_NONAME
    return isinstance(cause, ssl.SSLCertVerificationError)


def _causes(error: BaseException | None) -> Iterator[BaseException]:
    while error is not None:
        yield error
        error = error.__cause__ or error.__context__
