"""Return an HTML page as a response in the language of its reader."""

from collections.abc import Mapping
from http import HTTPStatus
from typing import Final

from fastapi import Request
from starlette.responses import HTMLResponse

from service.api.http.language import keep_language, language_of
from service.web.page_headers import PAGE_HEADERS

# The headers of a request that a page depends on. The menu depends on a tutor's session.
_VARY: Final = "Accept-Language, Cookie"


def page_answer(
    request: Request,
    content: bytes,
    headers: Mapping[str, str] = PAGE_HEADERS,
    status: HTTPStatus = HTTPStatus.OK,
) -> HTMLResponse:
    """Return a page as a response in the reader's language."""
    # A newly chosen language is stored.
    answer = HTMLResponse(content, status, headers=dict(headers))
    answer.headers["Content-Language"] = language_of(request).tag
    answer.headers["Vary"] = _VARY
    keep_language(request, answer)
    return answer
