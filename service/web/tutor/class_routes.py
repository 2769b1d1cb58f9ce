"""The routes of the page that grades the files of a class."""

from typing import Final

from fastapi import APIRouter, Request
from starlette.responses import HTMLResponse, Response

from service.api.http.bounded_work import BoundedWork
from service.api.http.chunked_response import ChunkedResponse
from service.api.http.language import language_of
from service.api.http.lookup import Catalogue
from service.api.http.told_answer import language_headers
from service.web.assets import Assets
from service.web.page_answer import page_answer
from service.web.page_headers import NO_STORE, PRIVATE_HEADERS, policy
from service.web.tutor.class_report import class_archive, unpacked
from service.web.tutor.tutor_pages import class_page

_HEADERS: Final = {**PRIVATE_HEADERS, "Content-Security-Policy": policy(frame_src="'self'")}


def class_routes(catalogue: Catalogue, assets: Assets, work: BoundedWork) -> APIRouter:
    """Return the routes of the page that grades the files of a class."""
    router = APIRouter(prefix="/tutor")

    @router.get("/class")
    async def class_form(request: Request) -> Response:
        """Return the form for uploading the files of a class."""
        return page_answer(request, class_page(catalogue, assets, language_of(request)), _HEADERS)

    @router.get("/class/report")
    async def class_frame() -> Response:
        """Return the empty page in which the browser shows reports."""
        # The Content-Security-Policy of the page allows the style sheets of the reports.
        from service.formats.class_page.index import STYLE as INDEX_STYLE
        from service.formats.documents.html import STYLE as REPORT_STYLE

        own = policy(
            script_src="'none'",
            connect_src="'none'",
            style_src=f"'{INDEX_STYLE.hash}' '{REPORT_STYLE.hash}'",
        )
        content = '<!doctype html><html lang="en"><head><title>Report</title></head></html>'
        return HTMLResponse(content, headers={**PRIVATE_HEADERS, "Content-Security-Policy": own})

    @router.post("/class")
    async def report(request: Request) -> Response:
        """Grade a class, and return the reports as a ZIP file."""
        # Nothing is stored.
        packed = await request.body()
        language = language_of(request)
        content = await work.do(lambda: class_archive(unpacked(packed), catalogue, language))
        headers = {**NO_STORE, **language_headers(language)}
        return ChunkedResponse(content, headers=headers, media_type="application/zip")

    return router
