"""The errors for requests that the caller has no right to make."""

from collections.abc import Mapping, Sequence
from http import HTTPStatus
from typing import Final, NamedTuple

from service.access.caller import Scope
from service.api.http.problems import ProblemError
from service.translations import SentenceValue, say, template

_BEARER: Final = "Bearer"
_ALLOWS: Final = {
    Scope.GRADE: say("have answers graded"),
    Scope.RECORD: say("record attempts"),
    Scope.TUTOR: say("see what tutors see"),
}


class AccessProblem(NamedTuple):
    """The constant texts of an error, with placeholders in braces."""

    status: HTTPStatus
    title: str
    detail: str
    retry_after: str | None = None
    challenges: Sequence[str] = ()


# The problems by the ends of their types.
ACCESS_PROBLEMS: Final[Mapping[str, AccessProblem]] = {
    "key-needed": AccessProblem(
        HTTPStatus.UNAUTHORIZED,
        template("A key is needed"),
        template("This needs a key. Send it in the header Authorization: Bearer dhg_…"),
        challenges=(_BEARER,),
    ),
    "key-not-valid": AccessProblem(
        HTTPStatus.UNAUTHORIZED,
        template("The key is not valid"),
        "{reason}",
        challenges=(f'{_BEARER} error="invalid_token"',),
    ),
    "scope-missing": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("The key is not for this"),
        template("This key may not {allowed}: it has not the scope {scope}."),
    ),
    "other-exercise": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("The key is for other exercises"),
        template(
            "This key or token is for certain exercises. Name one of them; others, and all at "
            "once, are not for it."
        ),
    ),
    "other-course": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("The key is for one course"),
        template("This key or link is for one course. Others, and all at once, are not for it."),
    ),
    "learner-needed": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("This is for a learner"),
        template("This needs the personal link or the token of a learner."),
    ),
    "other-learner": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("The token is for another learner"),
        template("This token is for one learner, and not for the one that is named here."),
    ),
    "solutions-off": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("Model solutions are not shown here"),
        template(
            "Model solutions are for tutors, and this service does not show them. To show them to "
            "everybody who can reach it, start it with DH_GRADER_SOLUTIONS=true; on the machine "
            "itself, use dh-grader exercises show ID --solution."
        ),
    ),
    "attempts-not-shown": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("Recorded attempts are not shown here"),
        template(
            "Recorded attempts are for tutors, and this service does not show them. Ask from the "
            "machine itself, use dh-grader attempts there, or set DH_GRADER_READ_ATTEMPTS=true to "
            "show them to everybody who can reach the service."
        ),
    ),
    "attempts-not-changed": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("Recorded attempts are not changed here"),
        template(
            "Only tutors change recorded attempts: with a key or, while the service has no keys, "
            "from the machine itself, on a page of the service or by dh-grader attempts."
        ),
    ),
    "origin-refused": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("The page is of another origin"),
        template(
            "A page of this origin may not record attempts. DH_GRADER_CORS_ORIGINS names those "
            "that may."
        ),
    ),
    "tokens-not-made": AccessProblem(
        HTTPStatus.NOT_FOUND,
        template("No tokens are made here"),
        template("A token is made by the holder of a key, and this service needs no keys."),
    ),
    "too-often": AccessProblem(
        HTTPStatus.TOO_MANY_REQUESTS,
        template("Too many requests"),
        template("These are more requests than are allowed. Come again in {seconds} seconds."),
        retry_after="{seconds}",
    ),
    "batch-too-large": AccessProblem(
        HTTPStatus.UNPROCESSABLE_ENTITY,
        template("The batch is too large"),
        template(
            "Each submission counts as a request. {number} at once are never allowed here: send "
            "at most {most} in one request."
        ),
    ),
    "busy": AccessProblem(
        HTTPStatus.SERVICE_UNAVAILABLE,
        template("The service has a lot to do"),
        template("Too many keys are being checked. Send this request again."),
        retry_after="1",
    ),
}


def access_problem(name: str, **values: SentenceValue) -> ProblemError:
    """Return the error called ``name``, with ``values`` put into its texts."""
    status, title, detail, retry_after, challenges = ACCESS_PROBLEMS[name]
    headers = None if retry_after is None else {"Retry-After": retry_after.format_map(values)}
    return ProblemError(
        status, say(detail, **values), name, say(title), headers=headers, challenges=challenges
    )


def scope_missing(scope: Scope) -> ProblemError:
    """Return the error for a key without this scope (a right of a key)."""
    return access_problem("scope-missing", allowed=_ALLOWS[scope], scope=str(scope))


def token_for_token() -> ProblemError:
    """Return the error for a request that shows a token, not a key, to create a token."""
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        say("A token makes no tokens; this needs a key."),
        "scope-missing",
        say("The token is not for this"),
    )
