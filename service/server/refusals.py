"""The errors for requests that are refused before they reach a route."""

from http import HTTPStatus
from typing import Final

from fastapi import Response
from starlette.datastructures import Headers

from service.api.http.problems import ProblemError
from service.api.http.request_context import HEADER, begin_request
from service.server.limits import HEAD_TIMEOUT, MAX_HEADERS, MAX_URL, TIMEOUT
from service.translations import say

_CLOSE: Final = {"Connection": "close"}


def refusal_response(problem: ProblemError, path: str, headers: Headers | None = None) -> Response:
    """Return the error response to a request that does not reach the application.

    ``headers`` are the request's headers, or None if they have not been read.
    """
    request = begin_request(headers.get(HEADER) if headers else None)
    answer = problem.response(path)
    answer.headers[HEADER] = request.id
    return answer


def malformed(detail: str) -> ProblemError:
    """Return the error for bytes that are no HTTP request."""
    title = "This is no HTTP request"
    return ProblemError(HTTPStatus.BAD_REQUEST, detail, "malformed-request", title, headers=_CLOSE)


def late() -> ProblemError:
    """Return the error for a request that did not arrive in time."""
    detail = (
        f"The head of a request must arrive within {HEAD_TIMEOUT:.0f} seconds, and the whole "
        f"request within {TIMEOUT:.0f}."
    )
    return ProblemError(HTTPStatus.REQUEST_TIMEOUT, detail, headers=_CLOSE)


def long_address() -> ProblemError:
    """Return the error for a URL that is too long."""
    detail = f"An address may have {MAX_URL} characters; this one has more."
    return ProblemError(HTTPStatus.REQUEST_URI_TOO_LONG, detail, headers=_CLOSE)


def too_many_headers() -> ProblemError:
    """Return the error for a request with too many headers."""
    return large_frame(f"A request may have {MAX_HEADERS} headers; this one has more.")


def large_frame(detail: str) -> ProblemError:
    """Return the error for a head, chunk size or trailer that is too large."""
    return ProblemError(HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE, detail, headers=_CLOSE)


def too_many(seconds: int) -> ProblemError:
    """Return the error for a client that has too many requests waiting."""
    return ProblemError(
        HTTPStatus.TOO_MANY_REQUESTS,
        say(
            "Too many requests from this address are waiting already. Wait, then send this one "
            "again."
        ),
        headers={"Retry-After": str(seconds)},
    )


def too_busy(seconds: int) -> ProblemError:
    """Return the error for a service that has too much to do."""
    return ProblemError(
        HTTPStatus.SERVICE_UNAVAILABLE,
        say("The service has too much to do. Wait, then send this request again."),
        headers={"Retry-After": str(seconds)},
    )
