"""The route that shows how a text is read, while the student still types."""

from typing import Final, Literal

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from service.api.bodies import body_as
from service.api.lookup import Catalogue, require_exercise, require_parts
from service.api.openapi import posting
from service.api.problems import invalid
from service.catalogue import Exercise
from service.expressions import ExpressionError, Kind, Symbol, Vocabulary, joint_variable, read
from service.grading.reading.preview import preview_pasted

JOINTS: Final = range(1, 10)

# For a text that belongs to no exercise: the letters of a robotics textbook's formulas.
GENERIC: Final = Vocabulary(
    [
        *(joint_variable(i) for i in JOINTS),
        *(Symbol(f"alpha{i}", "angle") for i in JOINTS),
        *(Symbol(f"{letter}{i}", "length") for letter in "adl" for i in JOINTS),
    ]
)


class PreviewRequest(BaseModel):
    """A text, and the place that it is for."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    text: str = Field(
        description="One entry as the student writes it, or a pasted table or matrix."
    )
    exercise: str | None = Field(
        None,
        description="The exercise whose symbols the text may use. Without it: joint angles theta1 "
        "(or q1) to theta9, link twists alpha1 to alpha9, lengths a1, d1, l1 to a9, d9, l9.",
    )
    part: str | None = Field(None, description="The part that the text is for; needs `exercise`.")
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="What a bare number means where an angle is asked for."
    )
    quantity: Kind = Field(
        "number", description="What is asked for there; matters for a bare number in degrees."
    )


class PreviewNote(BaseModel):
    """Something worth knowing about how the text was read; ``span`` is [from, to) in it."""

    # Its fields are picked from the reader's notes and errors.
    model_config = ConfigDict(from_attributes=True)

    code: str
    message: str
    span: tuple[int, int]


class PreviewError(PreviewNote):
    """The reason why the text cannot be read."""

    suggestion: str | None = Field(None, description="The whole text, repaired.")


class PreviewCell(BaseModel):
    """The reading of one cell of a pasted table or matrix; labels are those of a report."""

    model_config = ConfigDict(from_attributes=True)

    row: str
    column: str
    span: tuple[int, int] = Field(description="[from, to) in the pasted text.")
    typed: str
    text: str
    latex: str
    mathml: str
    symbols: list[str]
    notes: list[PreviewNote]
    error: PreviewError | None = Field(None, validation_alias="problem")


class PreviewAnswer(BaseModel):
    """The reading of the text, or the reason why it cannot be read.

    Of one entry there is `text`, `latex`, `mathml` and `symbols`, or only `error`. Of a pasted
    table or matrix there are `rows` of cells; `ok` then says that every cell was read.
    """

    ok: bool
    rows: list[list[PreviewCell]] | None = Field(
        None, description="The cells of a pasted table or matrix; needs `exercise` and `part`."
    )
    text: str | None = None
    latex: str | None = None
    mathml: str | None = None
    symbols: list[str] | None = Field(None, description="The symbols used, by canonical name.")
    notes: list[PreviewNote] | None = None
    error: PreviewError | None = None


def preview(body: PreviewRequest, vocabulary: Vocabulary) -> PreviewAnswer:
    """The reading of the text in this vocabulary."""
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


# Characters between the cells of a table or matrix, which no single entry holds.
_BETWEEN_CELLS: Final = frozenset("\n\t;|&<[,")


def preview_grid(body: PreviewRequest, exercise: Exercise, part: str) -> PreviewAnswer:
    """The reading of a whole pasted table or matrix, cell by cell."""
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


def routes(catalogue: Catalogue) -> APIRouter:
    """The route that previews."""
    router = APIRouter(prefix="/v1", tags=["preview"])

    @router.post(
        "/preview",
        operation_id="preview",
        summary="Show how a text is read",
        response_description="The reading of the text, or the reason why it cannot be read.",
        **posting(PreviewRequest, PreviewAnswer, "preview"),
    )
    async def preview_text(request: Request) -> Response:
        """Show how a text is read: normal text, LaTeX, MathML; or why not, and the text repaired.

        With `exercise` and `part` the text may also be a whole pasted table or matrix.
        """
        body = await body_as(PreviewRequest, request)
        exercise = _exercise(catalogue, body)
        shown = preview(body, exercise.vocabulary if exercise else GENERIC)
        if not shown.ok and exercise and body.part and _BETWEEN_CELLS & set(body.text):
            grid = preview_grid(body, exercise, body.part)
            # A text that is no grid either is better explained as the one entry that it may be.
            shown = grid if grid.rows or "\n" in body.text else shown
        content = shown.model_dump_json(exclude_none=True)
        return Response(content, media_type="application/json")

    return router


def _exercise(catalogue: Catalogue, body: PreviewRequest) -> Exercise | None:
    if body.exercise is None and body.part is not None:
        message = "A part belongs to an exercise; name the exercise as well"
        raise invalid([{"type": "alone", "loc": ("part",), "msg": message}])
    exercise = None if body.exercise is None else require_exercise(catalogue, body.exercise)
    if exercise is not None and body.part is not None:
        require_parts(exercise, [(body.part, ("part",))])
    return exercise
