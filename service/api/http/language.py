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
    """Return the language of the query (``?lang=de``), the cookie or ``Accept-Language``.

    The first of these three that names a language of the service decides. If none does, the
    language is English. ``usual`` is the reader's language elsewhere, such as on a platform.
    ``usual`` has priority over ``Accept-Language``, but not over the cookie.
    """
    return (
        language_named(request.query_params.get(LANGUAGE_FIELD))
        or language_named(request.cookies.get(LANGUAGE_COOKIE))
        or language_named(usual)
        or accepted_language(request.headers.get("accept-language"))
    )


def keep_language(request: HTTPConnection, response: Response) -> None:
    """If the query of the request chooses a language, store the language in a cookie."""
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
