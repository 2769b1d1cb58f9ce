"""The routes that show how the grader reads a text while a student is typing."""

from functools import partial
from typing import Final

from fastapi import APIRouter, Request, Response

from service.api.courses.own_variant import OwnVariants, of_assignment
from service.api.document.openapi import posting
from service.api.http.bodies import read_body
from service.api.http.language import language_of
from service.api.http.lookup import Catalogue, require_exercise, require_parts
from service.api.http.problems import invalid
from service.api.http.told_answer import in_languages, told_json
from service.api.permissions.access import Access, require_reach
from service.api.turns import run_in_turns
from service.catalogue import Exercise
from service.contract.preview import (
    PreviewAnswer,
    PreviewManyRequest,
    PreviewManyResponse,
    PreviewRequest,
)
from service.expressions import ExpressionError, Symbol, Vocabulary, joint_variable, read
from service.grading.reading.preview import CellPreview, preview_entries, preview_pasted
from service.translations import Language, say

JOINTS: Final = range(1, 10)

# For a text without an exercise: the symbols of formulas in robotics textbooks.
GENERIC: Final = Vocabulary(
    [
        *(joint_variable(i) for i in JOINTS),
        *(Symbol(f"alpha{i}", "angle") for i in JOINTS),
        *(Symbol(f"{letter}{i}", "length") for letter in "adl" for i in JOINTS),
    ],
    of_books=True,
)


def preview(body: PreviewRequest, vocabulary: Vocabulary) -> PreviewAnswer:
    """Return how the grader reads the text; ``vocabulary`` has the known symbols."""
    try:
        expression = read(body.text, vocabulary, quantity=body.quantity, angle_unit=body.angle_unit)
    except ExpressionError as error:
        return PreviewAnswer.model_validate({"ok": False, "error": error})
    return PreviewAnswer.model_validate(
        {
            "ok": True,
            "text": expression.text(),
            "latex": expression.latex(),
            "mathml": expression.mathml(),
            "symbols": sorted(expression.symbols),
            "notes": expression.notes,
        }
    )


def preview_many(body: PreviewManyRequest, exercise: Exercise) -> PreviewManyResponse:
    """Return how the grader reads several texts, within the limits of one submission."""
    entries = [(entry.text, entry.quantity) for entry in body.entries]
    cells = preview_entries(entries, exercise, body.part, body.angle_unit)
    return PreviewManyResponse(results=[_answer(cell) for cell in cells])


def _answer(cell: CellPreview) -> PreviewAnswer:
    if cell.problem:
        return PreviewAnswer.model_validate({"ok": False, "error": cell.problem})
    read = {name: getattr(cell, name) for name in ("text", "latex", "mathml", "symbols", "notes")}
    return PreviewAnswer.model_validate({"ok": True, **read})


# Characters between the cells of a table or matrix. A single entry has none of them.
_BETWEEN_CELLS: Final = frozenset("\n\t;|&<[,")


def preview_grid(body: PreviewRequest, exercise: Exercise, part: str) -> PreviewAnswer:
    """Return how the grader reads each cell of a pasted table or matrix."""
    pasted = preview_pasted(body.text, exercise, part, body.angle_unit)
    symbols = {name for row in pasted.rows for cell in row for name in cell.symbols}
    return PreviewAnswer.model_validate(
        {
            "ok": pasted.ok,
            "rows": pasted.rows or None,
            "symbols": sorted(symbols),
            "notes": pasted.notes,
            "error": pasted.problem,
        }
    )


def _shown(body: PreviewRequest, exercise: Exercise | None, language: Language) -> str:
    shown = preview(body, exercise.vocabulary if exercise else GENERIC)
    if not shown.ok and exercise and body.part and _BETWEEN_CELLS & set(body.text):
        grid = preview_grid(body, exercise, body.part)
        # If the text is not a grid either, the problem of the single entry explains it better.
        is_script = grid.error is not None and grid.error.code == "unread_script"
        shown = grid if grid.rows or is_script or "\n" in body.text else shown
    return shown.model_dump_json(exclude_none=True, context=language.translation)


def routes(catalogue: Catalogue, access: Access, own: OwnVariants) -> APIRouter:
    """Return the routes that preview answers."""
    router = APIRouter(prefix="/v1", tags=["preview"])

    @router.post(
        "/preview",
        operation_id="preview",
        summary="Show how a text is read",
        response_description="The reading of the text, or the reason why it cannot be read.",
        **in_languages(of_assignment(posting(PreviewRequest, PreviewAnswer, "preview"))),
    )
    async def preview_text(request: Request) -> Response:
        """Show how a text is read: as plain text, LaTeX and MathML.

        If it cannot be read, the answer has the reason and the repaired text. With
        `exercise` and `part` the text may also be a whole pasted table or matrix.
        """
        body = await read_body(PreviewRequest, request)
        require_reach(access.caller(request), body.exercise)
        exercise = _exercise(catalogue, body)
        if exercise is not None:
            exercise = await own.of(request, exercise)
        language = language_of(request)
        content = await run_in_turns(request, partial(_shown, body, exercise, language))
        return told_json(content, language)

    @router.post(
        "/previews",
        operation_id="previewMany",
        summary="Show how the entries of a part are read",
        response_description="The reading of each entry, in their order.",
        **in_languages(
            of_assignment(posting(PreviewManyRequest, PreviewManyResponse, "preview-many"))
        ),
    )
    async def preview_entries_of_part(request: Request) -> Response:
        """Show how several entries of one part are read, each on its own.

        They are read as a grading reads them: in a table, a star marks the variable of a
        joint. Entries beyond the work that one submission may cost are returned only as
        text.
        """
        body = await read_body(PreviewManyRequest, request)
        require_reach(access.caller(request), body.exercise)
        exercise = await own.of(request, require_exercise(catalogue, body.exercise))
        require_parts(exercise, [(body.part, ("part",))])
        shown = await run_in_turns(request, partial(preview_many, body, exercise))
        language = language_of(request)
        content = shown.model_dump_json(exclude_none=True, context=language.translation)
        return told_json(content, language)

    return router


def _exercise(catalogue: Catalogue, body: PreviewRequest) -> Exercise | None:
    if body.exercise is None and body.part is not None:
        message = say("A part belongs to an exercise; name the exercise as well.")
        raise invalid([{"type": "alone", "loc": ("part",), "msg": message}])
    exercise = None if body.exercise is None else require_exercise(catalogue, body.exercise)
    if exercise is not None and body.part is not None:
        require_parts(exercise, [(body.part, ("part",))])
    return exercise
