"""The language of the reader who sends a request."""

from typing import Final

from starlette.requests import HTTPConnection
from starlette.responses import Response

from service.translations import Language, accepted_language, language_named

# The field of a query that chooses a language, and the cookie that keeps the choice.
LANGUAGE_FIELD: Final = "lang"
LANGUAGE_COOKIE: Final = "dh_grader_language"
_A_YEAR: Final = 365 * 24 * 3600


def language_of(request: HTTPConnection, usual: str | None = None) -> Language:
    """Return the reader's language: from the query, the cookie, or ``Accept-Language``.

    ``usual`` is a known language of the reader, for example from a learning platform.
    """
    # The first that names a known language decides; the default is English.
    return (
        language_named(request.query_params.get(LANGUAGE_FIELD))
        or language_named(request.cookies.get(LANGUAGE_COOKIE))
        or language_named(usual)
        or accepted_language(request.headers.get("accept-language"))
    )


def keep_language(request: HTTPConnection, response: Response) -> None:
    """Store the language that the query chooses, if any, in a cookie."""
    if chosen := language_named(request.query_params.get(LANGUAGE_FIELD)):
        response.set_cookie(
            LANGUAGE_COOKIE,
            chosen.code,
            max_age=_A_YEAR,
            path=request.scope.get("root_path") or "/",
            secure=request.url.scheme == "https",
            httponly=True,
            samesite="lax",
        )
