"""RFC 9457 problem details: the body of every unsuccessful response."""

from collections.abc import Mapping
from typing import Final, NamedTuple

from pydantic import BaseModel, Field

MEDIA_TYPE: Final = "application/problem+json"
# The prefix of a problem's name in its ``type``.
TYPE_PREFIX: Final = "urn:dh-grader:problem:"


class ProblemType(NamedTuple):
    """A type of problems: its HTTP status, and its meaning in one clause.

    ``is_general`` marks the type of all problems with this status that have no name of their own.
    """

    status: int
    meaning: str
    is_general: bool = False


# All types of problems by name, the general ones first. ``docs/problems.md`` is made from them.
PROBLEM_TYPES: Final[Mapping[str, ProblemType]] = {
    "bad-request": ProblemType(
        400, "the request ended before its body was complete", is_general=True
    ),
    "not-allowed": ProblemType(
        403, "this caller may not do this; `detail` says why", is_general=True
    ),
    "not-found": ProblemType(404, "nothing is at this address", is_general=True),
    "method-not-allowed": ProblemType(
        405,
        "this address does not take the method; the header `Allow` names the methods",
        is_general=True,
    ),
    "too-late": ProblemType(408, "the request did not arrive in time", is_general=True),
    "address-too-long": ProblemType(414, "the address has too many characters", is_general=True),
    "not-json": ProblemType(415, "the body says that it is not JSON", is_general=True),
    "too-many-waiting": ProblemType(
        429,
        "too many requests from this address are waiting; try again after `Retry-After` seconds",
        is_general=True,
    ),
    "headers-too-large": ProblemType(
        431, "the request has too many or too long headers", is_general=True
    ),
    "failed": ProblemType(500, "the service failed; the log has the reason", is_general=True),
    "unavailable": ProblemType(
        503,
        "the service has too much to do, is ending, or lacks something; try again",
        is_general=True,
    ),
    "refused": ProblemType(400, "any other refusal; `status` and `detail` say more"),
    "malformed-request": ProblemType(400, "the bytes are no HTTP request"),
    "malformed-json": ProblemType(400, "the body is no JSON; `errors` has line and column"),
    "body-too-large": ProblemType(413, "the body is larger than 256 KiB"),
    "invalid-request": ProblemType(
        422, "a field or parameter is missing, unknown or invalid; `errors` has each of them"
    ),
    "store-down": ProblemType(
        503, "the database does not respond; try again after `Retry-After` seconds"
    ),
    "busy": ProblemType(503, "other work waits already; try again after `Retry-After` seconds"),
    "key-needed": ProblemType(401, "send a key"),
    "key-not-valid": ProblemType(
        401, "the key or token has expired, was revoked, is misspelt or unknown"
    ),
    "scope-missing": ProblemType(403, "the scopes of the key do not allow this"),
    "other-exercise": ProblemType(403, "the key or token is for other exercises"),
    "other-course": ProblemType(403, "the key or link is for one course"),
    "learner-needed": ProblemType(403, "this needs the link or the token of a learner"),
    "other-learner": ProblemType(403, "the token is for another learner"),
    "solutions-off": ProblemType(403, "the service does not show you model solutions"),
    "attempts-not-shown": ProblemType(403, "the service does not show you recorded attempts"),
    "attempts-not-changed": ProblemType(
        403, "the service does not let you change recorded attempts"
    ),
    "origin-refused": ProblemType(403, "a page of this origin may not record attempts"),
    "metrics-off": ProblemType(403, "the service does not show you metrics"),
    "tokens-not-made": ProblemType(404, "the service needs no keys, so it makes no tokens"),
    "batch-too-large": ProblemType(
        422, "the batch has more submissions than the limit allows at once"
    ),
    "too-often": ProblemType(429, "too many requests; try again after `Retry-After` seconds"),
    "unknown-exercise": ProblemType(404, "there is no exercise with this id"),
    "unknown-part": ProblemType(422, "the exercise has no part with this id"),
    "no-figure": ProblemType(404, "the exercise has no figure"),
    "no-exercises": ProblemType(503, "no exercise can be used, so the service is not ready"),
    "no-hints": ProblemType(403, "reports on this exercise have no messages, so no hints"),
    "no-hint": ProblemType(404, "the report on these answers has no such message or step"),
    "earlier-step-first": ProblemType(403, "take the earlier steps of the hint first"),
    "try-first": ProblemType(403, "hand in another answer before the next step of the hint"),
    "no-practice": ProblemType(403, "an assignment does not let the learner practise now"),
    "hints-have-a-price": ProblemType(
        403, "hints have a price for this learner; take them for a recorded attempt"
    ),
    "solution-not-shown": ProblemType(403, "the model solution is not shown now"),
    "attempts-not-recorded": ProblemType(404, "the service has no database"),
    "unknown-attempt": ProblemType(404, "there is no attempt with this id"),
    "not-open": ProblemType(403, "the exercise or the assignment is not open yet"),
    "closed": ProblemType(403, "the exercise or the assignment is closed"),
    "no-attempts-left": ProblemType(403, "the learner has used all attempts"),
    "idempotency-key-reused": ProblemType(422, "the key belongs to another attempt"),
    "exercise-fails": ProblemType(409, "the exercise file has a fault, so nothing is regraded"),
    "unknown-course": ProblemType(404, "there is no course with this id"),
    "unknown-assignment": ProblemType(404, "the course has no assignment with this id"),
    "unknown-learner": ProblemType(404, "the course has no such learner"),
    "not-assigned": ProblemType(404, "the exercise is not part of the assignment"),
    "has-attempts": ProblemType(409, "attempts are recorded there"),
    "already-there": ProblemType(409, "there is one with this id already"),
    "unusable": ProblemType(422, "the request cannot be used; `detail` says why"),
    "unusable-files": ProblemType(422, "the files of a class cannot be used"),
    "unusable-exercise": ProblemType(422, "the exercise file cannot be used"),
    "unusable-robot": ProblemType(422, "no exercise can be made from the robot"),
    "checks-too-long": ProblemType(422, "the checks of the exercise took too long"),
    "not-saved": ProblemType(409, "the file was not saved"),
}
_GENERAL: Final = {each.status: name for name, each in PROBLEM_TYPES.items() if each.is_general}


def general_name(status: int) -> str:
    """Return the name of the type of a problem that has no name of its own."""
    return _GENERAL.get(status) or ("refused" if status < 500 else "failed")


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

    type: str = Field(
        description="A stable URN for programs, such as `urn:dh-grader:problem:not-found`; "
        "docs/problems.md lists all of them."
    )
    title: str
    status: int
    detail: str
    instance: str = Field(description="The path of the request.")
    request_id: str | None = Field(
        None, description="The id of the request, also in the header X-Request-ID and in the log."
    )
    errors: list[Reason] | None = None
