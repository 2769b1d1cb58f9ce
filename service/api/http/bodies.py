"""Reading a request's body once, straight into its model."""

from email.message import Message
from http import HTTPStatus
from itertools import islice
from typing import TypeVar

from fastapi import Request
from pydantic import BaseModel, ValidationError

from service.api.http.lookup import Location
from service.api.http.problems import MAX_ERRORS, ProblemError, invalid
from service.submissions.strict_json import MalformedError, read_json

M = TypeVar("M", bound=BaseModel)


async def body_as(model: type[M], request: Request) -> M:
    """The body as this model; any Content-Type will do where it can be read as JSON.

    Forms and scripts that forget the header are common, and nothing here acts on a cookie that
    another site could borrow. Raises ProblemError: 400 for a body that is no JSON, 415 where the
    header claims another type, 422 for another shape.
    """
    try:
        value = read_json(await request.body())
    except MalformedError as error:
        raise _malformed(error, request.headers.get("content-type", "")) from error
    return checked(model, value)


def checked(model: type[M], value: object, at: Location = ()) -> M:
    """A value of a body as this model; ``at`` is its place in the body.

    Raises ProblemError: 422 for another shape.
    """
    try:
        return model.model_validate(_with_few_unknown(model, value))
    except ValidationError as error:
        details = error.errors(include_url=False, include_input=False)
        placed = [{**detail, "loc": (*at, *detail["loc"])} for detail in details]
        raise invalid(placed, list(model.model_fields)) from error


def _with_few_unknown(model: type[BaseModel], value: object) -> object:
    """The value with no more unknown fields than are told; it is refused in any case."""
    known = model.model_fields
    if not isinstance(value, dict) or len(value) <= len(known) + MAX_ERRORS:
        return value
    unknown = islice((key for key in value if key not in known), MAX_ERRORS)
    return {key: value[key] for key in (*filter(value.__contains__, known), *unknown)}


def _malformed(error: MalformedError, content_type: str) -> ProblemError:
    if content_type and not _is_json(content_type):
        return ProblemError(
            HTTPStatus.UNSUPPORTED_MEDIA_TYPE,
            "The body is not JSON; send a JSON object, as application/json.",
        )
    place = {} if error.line is None else {"line": error.line, "column": error.column or 1}
    return ProblemError(
        HTTPStatus.BAD_REQUEST,
        str(error),
        "malformed-json",
        "The body cannot be read",
        [{"detail": error.reason, **place}],
    )


def _is_json(content_type: str) -> bool:
    header = Message()
    header["content-type"] = content_type
    return header.get_content_subtype().rpartition("+")[2] == "json"
