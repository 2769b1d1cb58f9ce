"""The page /docs, which documents the HTTP interface.

Swagger UI draws the page. The service has a copy of Swagger UI, so the page works without the
internet.
"""

from http import HTTPStatus
from pathlib import Path
from typing import Final

from fastapi import APIRouter
from starlette.responses import Response

from service.api.http.chunked_response import ChunkedResponse
from service.api.http.problems import ProblemError

FOLDER: Final = Path(__file__).parent / "swagger_ui"
SCRIPT: Final = "swagger-ui-5.35.0.js"
STYLE: Final = "swagger-ui-5.35.0.css"
START: Final = "start.js"

# The media type and caching of each file. A file with a version in its name never changes.
_FOR_EVER: Final = "public, max-age=31536000, immutable"
_FILES: Final = {
    SCRIPT: ("text/javascript", _FOR_EVER),
    STYLE: ("text/css", _FOR_EVER),
    START: ("text/javascript", "no-cache"),
}


def routes() -> APIRouter:
    """Return the route that serves the files for the page /docs."""
    router = APIRouter(include_in_schema=False)
    contents = {name: (FOLDER / name).read_bytes() for name in _FILES}

    @router.get("/docs/{name}")
    async def file(name: str) -> Response:
        """Return a script or style of the page."""
        if name not in _FILES:
            raise ProblemError(HTTPStatus.NOT_FOUND, "The page /docs has no such file.")
        media_type, caching = _FILES[name]
        headers = {"Cache-Control": caching}
        return ChunkedResponse(contents[name], headers=headers, media_type=media_type)

    return router
