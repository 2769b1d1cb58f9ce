"""Read the body of a request and validate it as an instance of a pydantic model."""

from email.message import Message
from http import HTTPStatus
from itertools import islice
from typing import TypeVar

from fastapi import Request
from pydantic import BaseModel, ValidationError

from service.api.http.lookup import Location
from service.api.http.problems import MAX_ERRORS, ProblemError, invalid
from service.submissions.strict_json import MalformedError, read_json
from service.translations import say

M = TypeVar("M", bound=BaseModel)


async def read_body(model: type[M], request: Request) -> M:
    """Return the request's JSON body as an instance of ``model``. Raises ProblemError."""
    # JSON is accepted with any Content-Type, because forms and scripts often omit this header. That
    # is safe: a cookie gives rights only to requests of the service's own pages.
    try:
        value = read_json(await request.body())
    except MalformedError as error:
        raise _malformed(error, request.headers.get("content-type", "")) from error
    return validated(model, value)


def validated(model: type[M], value: object, at: Location = ()) -> M:
    """Return ``value``, a part of a request body, as an instance of ``model``.

    ``at`` is the path of ``value`` in the body. Raises ProblemError.
    """
    try:
        return model.model_validate(_with_few_unknown(model, value))
    except ValidationError as error:
        details = error.errors(include_url=False, include_input=False)
        placed = [{**detail, "loc": (*at, *detail["loc"])} for detail in details]
        raise invalid(placed, list(model.model_fields), at) from error


def _with_few_unknown(model: type[BaseModel], value: object) -> object:
    # An error response lists at most MAX_ERRORS errors, so further unknown fields are removed.
    known = model.model_fields
    if not isinstance(value, dict) or len(value) <= len(known) + MAX_ERRORS:
        return value
    unknown = islice((key for key in value if key not in known), MAX_ERRORS)
    return {key: value[key] for key in (*filter(value.__contains__, known), *unknown)}


def _malformed(error: MalformedError, content_type: str) -> ProblemError:
    if content_type and not _is_json(content_type):
        return ProblemError(
            HTTPStatus.UNSUPPORTED_MEDIA_TYPE,
            say("The body is not JSON; send a JSON object, as application/json."),
        )
    place = {} if error.line is None else {"line": error.line, "column": error.column or 1}
    return ProblemError(
        HTTPStatus.BAD_REQUEST,
        str(error),
        "malformed-json",
        say("The body cannot be read"),
        [{"detail": error.reason, **place}],
    )


def _is_json(content_type: str) -> bool:
    header = Message()
    header["content-type"] = content_type
    return header.get_content_subtype().rpartition("+")[2] == "json"
