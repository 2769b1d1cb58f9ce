"""RFC 9457 problem details: the body of every answer that is not a success."""

from typing import Final

from pydantic import BaseModel, Field

MEDIA_TYPE: Final = "application/problem+json"
# What stands before the name of a problem in its ``type``.
TYPE_PREFIX: Final = "urn:dh-grader:problem:"


class Reason(BaseModel):
    """One of several reasons."""

    detail: str
    pointer: str | None = Field(
        None, description="Where in the body, as a JSON pointer (RFC 6901), or which parameter."
    )
    line: int | None = None
    column: int | None = None


class ProblemDocument(BaseModel):
    """RFC 9457 problem details."""

    type: str = Field(description="`about:blank`, or a stable URN that a program can tell by.")
    title: str
    status: int
    detail: str
    instance: str = Field(description="The path that was asked for.")
    request_id: str | None = Field(
        None, description="The id of the request, also in the header X-Request-ID and in the log."
    )
    errors: list[Reason] | None = None
