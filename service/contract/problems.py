"""RFC 9457 problem details: the body of every unsuccessful response."""

from typing import Final

from pydantic import BaseModel, Field

MEDIA_TYPE: Final = "application/problem+json"
# The prefix of a problem's name in its ``type``.
TYPE_PREFIX: Final = "urn:dh-grader:problem:"


class Reason(BaseModel):
    """One of the reasons of a problem."""

    detail: str
    pointer: str | None = Field(
        None, description="The place in the body as a JSON pointer (RFC 6901), or the parameter."
    )
    line: int | None = None
    column: int | None = None


class ProblemDocument(BaseModel):
    """RFC 9457 problem details."""

    type: str = Field(description="`about:blank`, or a stable URN for programs.")
    title: str
    status: int
    detail: str
    instance: str = Field(description="The path of the request.")
    request_id: str | None = Field(
        None, description="The id of the request, also in the header X-Request-ID and in the log."
    )
    errors: list[Reason] | None = None
