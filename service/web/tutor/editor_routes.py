"""The routes of the editor for exercise files."""

from functools import partial
from http import HTTPStatus
from typing import Annotated, Final

from fastapi import APIRouter, Request
from pydantic import Field
from starlette.responses import JSONResponse, Response

from service.api.http.bodies import read_body
from service.api.http.bounded_work import BoundedWork
from service.api.http.language import language_of
from service.api.http.lookup import Catalogue, exercise_or_404
from service.api.http.problems import ProblemError
from service.api.http.told_answer import told_json
from service.api.permissions.access import is_at_the_machine
from service.catalogue import CatalogueError
from service.catalogue.drafts import Drafts
from service.translations import say
from service.web.assets import Assets
from service.web.page_answer import page_answer
from service.web.page_headers import NO_STORE, PRIVATE_HEADERS
from service.web.tutor.checking import Checking
from service.web.tutor.exercise_check import CheckRequest, exercise_of
from service.web.tutor.exercise_folder import ExerciseFolder, SaveRequest
from service.web.tutor.importing.import_request import ImportRequest, imported
from service.web.tutor.tutor_pages import editor_page

_NEW: Final = "my-exercise"


class DraftRequest(CheckRequest):
    """The text of an exercise to preview.

    ``draft`` is the id of the stored draft that it replaces.
    """

    draft: Annotated[str, Field(max_length=64)] = ""


def editor_routes(
    catalogue: Catalogue,
    assets: Assets,
    folder: ExerciseFolder,
    work: BoundedWork,
    checking: Checking,
    drafts: Drafts,
) -> APIRouter:
    """Return the routes of the editor for exercise files."""
    router = APIRouter(prefix="/tutor")

    @router.get("/editor")
    async def editor(request: Request, exercise: str | None = None) -> Response:
        """Return the editor of an exercise's file, or of a new file."""
        # Imported here, because it loads an algebra system.
        from service.authoring import template

        exercise_id = exercise or _NEW
        file = folder.opened(exercise_id)
        if file is None and exercise is not None:
            exercise_or_404(catalogue, exercise)
        text, mark = (file.text, file.mark) if file else (template(exercise_id), "")
        is_copy = file is not None and not mark
        page = editor_page(
            folder.free_id(exercise_id) if is_copy else exercise_id,
            text,
            mark,
            assets,
            language_of(request),
            can_write=folder.can_write and is_at_the_machine(request),
            copied=exercise_id if is_copy else "",
        )
        return page_answer(request, page, PRIVATE_HEADERS)

    @router.post("/check")
    async def check(request: Request) -> Response:
        """Return the findings on the text of an exercise file."""
        # The text is not stored.
        body = await read_body(CheckRequest, request)
        language = language_of(request)
        content = await work.do(partial(checking.checked, body, language))
        return told_json(content, language, headers=NO_STORE)

    @router.post("/import")
    async def import_robot(request: Request) -> Response:
        """Return the text of an exercise file for an imported robot."""
        # The text is not stored.
        body = await read_body(ImportRequest, request)
        language = language_of(request)
        content = await work.do(partial(imported, body, language))
        return told_json(content, language, headers=NO_STORE)

    @router.post("/drafts")
    async def draft(request: Request) -> Response:
        """Store a draft of an exercise for the preview, and return the draft's id."""
        body = await read_body(DraftRequest, request)
        draft_id = await work.do(partial(_put, drafts, body))
        return JSONResponse({"draft": draft_id}, headers=NO_STORE)

    @router.post("/files")
    async def save(request: Request) -> Response:
        """Save an exercise file in the editor's folder."""
        if folder.can_write and not is_at_the_machine(request):
            raise ProblemError(
                HTTPStatus.FORBIDDEN,
                say("Files can be saved only from the machine of the service."),
            )
        body = await read_body(SaveRequest, request)
        mark = await work.do(partial(folder.save, body))
        return JSONResponse({"mark": mark}, headers=NO_STORE)

    return router


def _put(drafts: Drafts, body: DraftRequest) -> str:
    """Store a draft of an exercise, and return the draft's id. Raises ProblemError."""
    try:
        exercise_of(body.id, body.text)
        return drafts.put(body.text, body.draft)
    except CatalogueError as error:
        raise ProblemError(
            HTTPStatus.UNPROCESSABLE_ENTITY,
            say("The file cannot be used. Fix it first."),
            "unusable-exercise",
            say("There is nothing to preview"),
        ) from error
    except OSError as error:
        raise ProblemError(
            HTTPStatus.SERVICE_UNAVAILABLE,
            say("The service has no writable folder for temporary files. Set TMPDIR to one."),
        ) from error
