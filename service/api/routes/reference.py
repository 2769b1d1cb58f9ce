"""The page /docs: the OpenAPI document for people, who can also try the operations.

Swagger UI draws the page. This service also serves its files, which are those of the npm package
swagger-ui-dist: the page works without the internet, and its policy forbids the browser to load
anything from elsewhere.
"""

from http import HTTPStatus
from pathlib import Path
from typing import Final

from fastapi import APIRouter
from starlette.responses import HTMLResponse, Response

from service.api.http.chunked_response import ChunkedResponse
from service.api.http.problems import ProblemError

FOLDER: Final = Path(__file__).parent / "swagger_ui"
_SCRIPT: Final = "swagger-ui-5.35.0.js"
_STYLE: Final = "swagger-ui-5.35.0.css"
_START: Final = "start.js"

# Addresses are relative, so that the page also works below a prefix of a proxy.
_PAGE: Final = f"""\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>DH Grader: the interface</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="docs/{_STYLE}">
</head>
<body>
<div id="interface"></div>
<noscript>
This page needs scripts; <a href="openapi.json">the document itself</a> does not.
</noscript>
<script src="docs/{_SCRIPT}"></script>
<script src="docs/{_START}"></script>
</body>
</html>
"""
_POLICY: Final = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
# The media type and caching of each file. A file with a version in its name never changes.
_FOR_EVER: Final = "public, max-age=31536000, immutable"
_FILES: Final = {
    _SCRIPT: ("text/javascript", _FOR_EVER),
    _STYLE: ("text/css", _FOR_EVER),
    _START: ("text/javascript", "no-cache"),
}


def routes() -> APIRouter:
    """Return the routes of the page and its files."""
    router = APIRouter(include_in_schema=False)
    contents = {name: (FOLDER / name).read_bytes() for name in _FILES}

    @router.get("/docs")
    async def page() -> HTMLResponse:
        """Return the page."""
        return HTMLResponse(_PAGE, headers={"Content-Security-Policy": _POLICY})

    @router.get("/docs/{name}")
    async def file(name: str) -> Response:
        """Return a script or style of the page."""
        if name not in _FILES:
            raise ProblemError(HTTPStatus.NOT_FOUND, "The page /docs has no such file.")
        media_type, caching = _FILES[name]
        headers = {"Cache-Control": caching}
        return ChunkedResponse(contents[name], headers=headers, media_type=media_type)

    return router
