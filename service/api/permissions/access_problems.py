"""The problems of those who may not do what they ask for."""

from dataclasses import replace
from http import HTTPStatus
from typing import Final

from service.access.caller import Scope
from service.api.http.problems import ProblemError, store_down

_BEARER: Final = "Bearer"
# A browser asks for a password, which then is the key, and sends it with all that the pages ask.
# A line each: of several challenges in one line Chromium reads the first alone.
_PASSWORD: Final = ('Basic realm="A key of DH Grader as password", charset="UTF-8"', _BEARER)
_MAY: Final = {
    Scope.GRADE: "have answers graded",
    Scope.RECORD: "record attempts",
    Scope.TUTOR: "see what tutors see",
}


def key_needed(*, with_password: bool = False) -> ProblemError:
    """Nobody may do so without a key."""
    return ProblemError(
        HTTPStatus.UNAUTHORIZED,
        "This needs a key. Send it in the header Authorization: Bearer dhg_…",
        "key-needed",
        "A key is needed",
        challenges=_PASSWORD if with_password else (_BEARER,),
    )


def credential_refused(reason: str) -> ProblemError:
    """The key or token is not valid."""
    return ProblemError(
        HTTPStatus.UNAUTHORIZED,
        reason,
        "key-not-valid",
        "The key is not valid",
        challenges=(f'{_BEARER} error="invalid_token"',),
    )


def asking_for_password(problem: ProblemError) -> ProblemError:
    """The same problem, at which a browser asks for another key."""
    if problem.status is not HTTPStatus.UNAUTHORIZED:
        return problem
    return replace(problem, challenges=_PASSWORD)


def keys_unreachable() -> ProblemError:
    """The database of the keys does not answer, and this key was not used lately."""
    return store_down("The key cannot be checked: the database does not answer.")


def keys_busy() -> ProblemError:
    """Return the problem of an unknown key where too many are looked up already."""
    return ProblemError(
        HTTPStatus.SERVICE_UNAVAILABLE,
        "Too many keys are being checked. Send this request again.",
        "busy",
        "The service has a lot to do",
        headers={"Retry-After": "1"},
    )


def scope_missing(scope: Scope) -> ProblemError:
    """The key is for something else."""
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        f"This key may not {_MAY[scope]}: it has not the scope {scope}.",
        "scope-missing",
        "The key is not for this",
    )


def other_exercise() -> ProblemError:
    """The key is for other exercises."""
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        "This key or token is for certain exercises. Name one of them; others, and all at once, "
        "are not for it.",
        "other-exercise",
        "The key is for other exercises",
    )


def other_learner() -> ProblemError:
    """The token is for another learner."""
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        "This token is for one learner, and not for the one that is named here.",
        "other-learner",
        "The token is for another learner",
    )


def solutions_off() -> ProblemError:
    """Model solutions are not shown to who asks."""
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        "Model solutions are for tutors, and this service does not show them. To have them "
        "shown to whoever can reach it, start it with DH_GRADER_SOLUTIONS=true; on the "
        "machine itself, use dh-grader exercises show ID --solution.",
        "solutions-off",
        "Model solutions are not shown here",
    )


def attempts_not_shown() -> ProblemError:
    """Recorded attempts are not shown to who asks."""
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        "Recorded attempts are for tutors, and this service does not show them. Ask from the "
        "machine itself, use dh-grader attempts there, or have them shown to whoever can reach "
        "the service: DH_GRADER_READ_ATTEMPTS=true.",
        "attempts-not-shown",
        "Recorded attempts are not shown here",
    )


def attempts_not_changed() -> ProblemError:
    """Recorded attempts are not changed for who asks."""
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        "Recorded attempts are changed by tutors: with a key, or where there are none from the "
        "machine itself, on a page of the service or by dh-grader attempts.",
        "attempts-not-changed",
        "Recorded attempts are not changed here",
    )


def origin_refused() -> ProblemError:
    """The page that asks is of an origin that may not."""
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        "A page of this origin may not record attempts. DH_GRADER_CORS_ORIGINS names those that "
        "may.",
        "origin-refused",
        "The page is of another origin",
    )


def too_often(seconds: int) -> ProblemError:
    """More requests than the limit of a key or of an address."""
    return ProblemError(
        HTTPStatus.TOO_MANY_REQUESTS,
        f"These are more requests than are allowed. Come again in {seconds} seconds.",
        "too-often",
        "Too many requests",
        headers={"Retry-After": str(seconds)},
    )


def learner_makes_token() -> ProblemError:
    """A token cannot make others."""
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        "A token makes no tokens; this needs a key.",
        "scope-missing",
        "The token is not for this",
    )


def tokens_not_made() -> ProblemError:
    """No key has been shown, because the service needs none."""
    return ProblemError(
        HTTPStatus.NOT_FOUND,
        "A token is made by the holder of a key, and this service needs no keys.",
        "tokens-not-made",
        "No tokens are made here",
    )
