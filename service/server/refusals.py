"""The problems that a client meets before its request reaches a route."""

from http import HTTPStatus
from typing import Final

from fastapi import Response
from starlette.datastructures import Headers

from service.api.http.problems import ProblemError
from service.api.http.request_context import HEADER, begin_request
from service.server.limits import HEAD_PATIENCE, MAX_HEADERS, MAX_URL, PATIENCE

_CLOSE: Final = {"Connection": "close"}


def named(problem: ProblemError, path: str, headers: Headers | None = None) -> Response:
    """The answer to a request that the application does not see, under an id of its own.

    ``headers`` are those of the request, where they have come.
    """
    request = begin_request(headers.get(HEADER) if headers else None)
    answer = problem.response(path)
    answer.headers[HEADER] = request.id
    return answer


def malformed(detail: str) -> ProblemError:
    """The problem of bytes that are no request."""
    title = "This is no HTTP request"
    return ProblemError(HTTPStatus.BAD_REQUEST, detail, "malformed-request", title, headers=_CLOSE)


def late() -> ProblemError:
    """The problem of a request that did not come in time."""
    detail = (
        f"The head of a request must arrive within {HEAD_PATIENCE:.0f} seconds, and the whole "
        f"request within {PATIENCE:.0f}."
    )
    return ProblemError(HTTPStatus.REQUEST_TIMEOUT, detail, headers=_CLOSE)


def long_address() -> ProblemError:
    """The problem of an address over the limit."""
    detail = f"An address may have {MAX_URL} characters; this one has more."
    return ProblemError(HTTPStatus.REQUEST_URI_TOO_LONG, detail, headers=_CLOSE)


def many_headers() -> ProblemError:
    """The problem of headers over their number."""
    return large_frame(f"A request may have {MAX_HEADERS} headers; this one has more.")


def large_frame(detail: str) -> ProblemError:
    """The problem of a head, of trailers or of sizes of chunks over the limit."""
    return ProblemError(HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE, detail, headers=_CLOSE)


def too_many(seconds: int) -> ProblemError:
    """The problem of a client that has too many requests waiting."""
    return ProblemError(
        HTTPStatus.TOO_MANY_REQUESTS,
        "Too many requests from this address are waiting already. Wait, then send this one again.",
        headers={"Retry-After": str(seconds)},
    )


def too_busy(seconds: int) -> ProblemError:
    """The problem of a service that has too much to do."""
    return ProblemError(
        HTTPStatus.SERVICE_UNAVAILABLE,
        "The service has too much to do. Wait, then send this request again.",
        headers={"Retry-After": str(seconds)},
    )
