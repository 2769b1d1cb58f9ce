"""The routes that show without grading: previews of a text, frames of a table, and figures."""

import base64
import hashlib
from collections import OrderedDict
from collections.abc import Hashable, Iterator, Mapping, Sequence, Set
from functools import cache, partial
from http import HTTPStatus
from typing import Annotated, Any, Final

import numpy as np
from fastapi import APIRouter, Query, Request, Response

from dh_grader.api.document import posting, refusals
from dh_grader.api.grading_gates import OwnVariants, of_assignment
from dh_grader.api.http import (
    Catalogue,
    ExerciseId,
    Location,
    MemoizedResults,
    ProblemError,
    exercise_or_404,
    in_languages,
    invalid,
    language_of,
    read_body,
    require_exercise,
    require_parts,
    run_in_turns,
    told_json,
)
from dh_grader.api.permissions import Access, require_reach
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.kinds import FramesSpec
from dh_grader.catalogue.schema_fields import FeedbackLevel
from dh_grader.contract.frames import (
    ConvertedRow,
    DrawnConfiguration,
    DrawnMechanism,
    FramesAnswer,
    FramesAsPlaced,
    FramesOfTable,
    FramesRequest,
    LostFreedom,
    MovingJoint,
    PlacedToDraw,
    PreviewAnswer,
    PreviewError,
    PreviewManyRequest,
    PreviewManyResponse,
    PreviewRequest,
    PrintedFormula,
    TableInFormulas,
    TableToDraw,
    UnreadCell,
)
from dh_grader.expressions import (
    Expression,
    ExpressionError,
    Symbol,
    Vocabulary,
    joint_variable,
    read,
)
from dh_grader.figures import default_view, exercise_figure, subject_of
from dh_grader.figures.drawing import Theme, style_sheet
from dh_grader.figures.mechanism import (
    Configuration,
    MovableMechanism,
    View,
    as_samples,
    given_frames,
    mechanism_of,
)
from dh_grader.figures.table_figure import (
    DrawingScope,
    SeenMechanism,
    TableFormulas,
    TableFrames,
    WrittenChain,
    free_scope,
    placed_frames,
    table_figure,
    table_formulas,
    table_frames,
    table_to_draw,
)
from dh_grader.grading.reading import CellPreview, preview_entries, preview_pasted
from dh_grader.grading.report import Finding, UnreadableAnswerError, WorkBudget
from dh_grader.kinematics import Matrices, Numbers
from dh_grader.slices import checkpoint
from dh_grader.translations import Language, Sentence, say, say_count

# --- Previews: how the grader reads a text while a student is typing


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
# Characters between the cells of a table or matrix. A single entry has none of them.
_BETWEEN_CELLS: Final = frozenset("\n\t;|&<[,")


def preview_routes(catalogue: Catalogue, access: Access, own: OwnVariants) -> APIRouter:
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


def _shown(body: PreviewRequest, exercise: Exercise | None, language: Language) -> str:
    shown = preview(body, exercise.vocabulary if exercise else GENERIC)
    if not shown.ok and exercise and body.part and _BETWEEN_CELLS & set(body.text):
        grid = preview_grid(body, exercise, body.part)
        # If the text is not a grid either, the problem of the single entry explains it better.
        is_script = grid.error is not None and grid.error.code == "unread_script"
        shown = grid if grid.rows or is_script or "\n" in body.text else shown
    return shown.model_dump_json(exclude_none=True, context=language.translation)


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


# --- Frames: where to draw the frames of a DH table and the links of a robot


_MOST_MECHANISMS: Final = 64


def frames_routes(catalogue: Catalogue, access: Access, own: OwnVariants) -> APIRouter:
    """Return the route that computes frames."""
    router = APIRouter(prefix="/v1", tags=["drawing"])
    mechanisms = _Mechanisms()

    @router.post(
        "/frames",
        operation_id="getFrames",
        summary="Compute the places of frames and links",
        response_description="Coordinates to draw with.",
        **in_languages(of_assignment(posting(FramesRequest, FramesAnswer, "frames"))),
    )
    async def frames(request: Request) -> Response:
        """Compute the frames of a table and the links of an exercise's mechanism.

        A table may be wrong or incomplete: its frames end at the first row that cannot be
        read. The mechanism does not contain the answer of the exercise: no parameters and no
        frames but those that the exercise gives, only what a picture shows.
        """
        body = await read_body(FramesRequest, request)
        require_reach(access.caller(request), body.exercise)
        exercise = None
        if body.exercise is not None:
            exercise = await own.of(request, require_exercise(catalogue, body.exercise))
        answer = await run_in_turns(request, partial(_answered, exercise, body, mechanisms))
        language = language_of(request)
        content = answer.model_dump_json(exclude_none=True, context=language.translation)
        return told_json(content, language)

    return router


class _Mechanisms:
    # A dragged slider uses a mechanism many times.
    def __init__(self) -> None:
        self._mechanisms: OrderedDict[Hashable, tuple[MovableMechanism, View]] = OrderedDict()

    def of(self, exercise: Exercise, numbers: Mapping[str, float]) -> tuple[MovableMechanism, View]:
        key = (exercise.id, exercise.version, exercise.view, *numbers.values())
        if key not in self._mechanisms:
            subject = subject_of(exercise)
            mechanism = mechanism_of(subject.reference, numbers)
            self._mechanisms[key] = mechanism, subject.view or default_view(mechanism, numbers)
            while len(self._mechanisms) > _MOST_MECHANISMS:
                self._mechanisms.popitem(last=False)
        self._mechanisms.move_to_end(key)
        return self._mechanisms[key]


def _answered(
    exercise: Exercise | None, body: FramesRequest, mechanisms: _Mechanisms
) -> FramesAnswer:
    scope = _scope(exercise, body)
    constants = [variable.name for variable in scope.variables if variable.joint is None]
    if unknown := sorted(body.symbols.keys() - set(constants)):
        raise _refused(("symbols", unknown[0]), say("There is no such symbol."))
    numbers = scope.numbers(body.symbols)
    amounts = _amounts(body, scope, numbers)
    table = mechanism = written = seen = None
    used: Set[str] = set(constants)
    if body.table is not None:
        table, found = _table(body.table, body, scope, numbers, amounts)
        if found is not None:
            written = WrittenChain(found.frames[0], found.row_joints, body.table.convention)
        # Without an exercise, only the symbols that the table uses.
        used = used if exercise else found.symbols if found else set()
        checkpoint()
    placed = None
    if body.placed is not None:
        placed = _placed(body.placed, exercise, body, numbers, amounts)
    if exercise is not None:
        movable, view = mechanisms.of(exercise, numbers)
        shown = movable.at(amounts)
        mechanism = _mechanism(exercise, movable, view, shown, numbers, amounts)
        seen = SeenMechanism(movable, shown[0], view)
        checkpoint()
    return FramesAnswer(
        symbols={name: numbers[name] for name in constants if name in used},
        joints=list(_joints(scope, numbers)),
        table=table,
        placed=placed,
        mechanism=mechanism,
        figure=table_figure(written, seen, body.figure)
        if body.figure and (written or seen)
        else None,
    )


def _scope(exercise: Exercise | None, body: FramesRequest) -> DrawingScope:
    structure = body.table.structure if body.table else None
    if exercise is not None and body.table is not None and body.table.formulas:
        message = say("Formulas are given of a table without an exercise.")
        raise _refused(("table", "formulas"), message)
    if exercise is not None:
        if exercise.reference is None:
            message = say("The exercise {exercise} has no robot to draw.", exercise=exercise.id)
            raise _refused(("exercise",), message)
        if structure is not None and structure != exercise.structure:
            message = say(
                "The joints of {exercise} are {structure}; leave this out.",
                exercise=exercise.id,
                structure=str(exercise.structure),
            )
            raise _refused(("table", "structure"), message)
        return DrawingScope.of(exercise)
    if body.table is None:
        raise _refused((), say("Name an exercise, give a table, or both."))
    if structure is None:
        message = say("Write one letter for each joint, R if it turns and P if it slides.")
        raise _refused(("table", "structure"), message)
    return free_scope(structure)


def _refused(place: Location, message: Sentence) -> ProblemError:
    return invalid([{"type": "unfit", "loc": place, "msg": message}])


def _amounts(body: FramesRequest, scope: DrawingScope, numbers: Mapping[str, float]) -> Numbers:
    # Return an array of shape (poses, joints).
    if body.joints is None:
        return np.array([[numbers[joint.variable] for joint in scope.joints]])
    for i, values in enumerate(body.joints):
        if len(values) != len(scope.joints):
            message = say_count(
                "The robot has {count} joint; write a number for it.",
                "The robot has {count} joints; write a number for each.",
                count=len(scope.joints),
            )
            raise _refused(("joints", i), message)
    return np.array(body.joints)


def _joints(scope: DrawingScope, numbers: Mapping[str, float]) -> Iterator[MovingJoint]:
    ranges = {variable.name: variable for variable in scope.variables}
    for joint in scope.joints:
        variable = ranges[joint.variable]
        yield MovingJoint(
            joint=joint.index,
            variable=joint.variable,
            kind="P" if joint.prismatic else "R",
            low=variable.low,
            high=variable.high,
            home=numbers[joint.variable],
        )


def _table(
    table: TableToDraw,
    body: FramesRequest,
    scope: DrawingScope,
    numbers: Mapping[str, float],
    amounts: Numbers,
) -> tuple[FramesOfTable, TableFrames | None]:
    # If the table cannot be read, the response has the reason, and the drawing is None.
    budget = WorkBudget.of_drawing(with_figure=body.figure is not None)
    try:
        written = table_to_draw(table.rows, scope, budget, body.angle_unit)
    except UnreadableAnswerError as error:
        reason = _error(error.finding)
        nothing = FramesOfTable(
            complete=False,
            frames=[],
            values=[],
            row_joints=[],
            unread=[],
            error=reason,
            lost_freedoms=[],
        )
        return nothing, None
    found = table_frames(written, table.convention, scope, numbers, amounts)
    formulas = None
    if table.formulas:
        formulas = _printed(table_formulas(written, table.convention, scope, budget))
    drawn = FramesOfTable(
        complete=found.complete,
        frames=_plain(found.frames),
        # Not rounded: a long link would magnify the error of a rounded angle.
        values=(found.values + 0.0).tolist(),
        row_joints=[joint.index if joint else 0 for joint in found.row_joints],
        unread=[
            UnreadCell(row=cell.row, column=cell.column, error=_error(cell.finding))
            for cell in found.unread
        ],
        degrees_of_freedom=found.freedoms,
        lost_freedoms=[LostFreedom.model_validate(each) for each in found.lost],
        formulas=formulas,
    )
    return drawn, found


def _placed(
    placed: PlacedToDraw,
    exercise: Exercise | None,
    body: FramesRequest,
    numbers: Mapping[str, float],
    amounts: Numbers,
) -> FramesAsPlaced:
    part = exercise.part(placed.part) if exercise else None
    if exercise is None or not isinstance(part, FramesSpec):
        message = say("Name an exercise, and a part of it that asks for frames.")
        raise _refused(("placed", "part"), message)
    budget = WorkBudget.of_drawing(with_figure=body.figure is not None)
    try:
        found = placed_frames(
            placed.rows, part, exercise, numbers, amounts, budget, body.angle_unit
        )
    except UnreadableAnswerError as error:
        return FramesAsPlaced(labels=[], frames=[], left_out=[], error=_error(error.finding))
    return FramesAsPlaced(
        labels=list(found.labels),
        frames=_plain(found.frames),
        left_out=[
            UnreadCell(row=cell.row, column=cell.column, error=_error(cell.finding))
            for cell in found.left_out
        ],
    )


def _printed(found: TableFormulas) -> TableInFormulas:
    # Most cells of the converted table are cells of the table itself, in other places.
    formula = cache(_formula)
    converted = [
        ConvertedRow(label=row.label, cells=[formula(cell) for cell in row.cells])
        for row in found.converted
    ]
    return TableInFormulas(
        cells=[[formula(cell) for cell in row] for row in found.cells],
        converted=converted or None,
        pose=[[formula(entry) for entry in row] for row in found.pose] or None,
    )


def _formula(expression: Expression | None) -> PrintedFormula:
    checkpoint()
    if expression is None:
        return PrintedFormula(text="", latex="", mathml="")
    return PrintedFormula(
        text=expression.text(), latex=expression.latex(), mathml=expression.mathml()
    )


def _error(finding: Finding) -> PreviewError:
    return PreviewError(
        code=finding.code,
        message=finding.hint,
        span=finding.span or (0, 0),
        suggestion=finding.suggestion,
    )


def _mechanism(
    exercise: Exercise,
    mechanism: MovableMechanism,
    view: View,
    shown: Sequence[Configuration],
    numbers: Mapping[str, float],
    amounts: Numbers,
) -> DrawnMechanism:
    given = given_frames(exercise)
    values = as_samples(numbers, len(amounts)) | {
        joint.variable: amounts[:, i] for i, joint in enumerate(exercise.joints)
    }
    frames = np.moveaxis(given.at(values, len(amounts)), 1, 0)
    hidden = exercise.attempts.limit is not None or exercise.feedback is FeedbackLevel.SCORE
    return DrawnMechanism(
        size=mechanism.size,
        azimuth=view.azimuth,
        elevation=view.elevation,
        frames=list(given.labels),
        comparable=not hidden and given.numbers[:1] == (0,) and given.numbers[-1:] == (-1,),
        configurations=[
            _configuration(each, poses) for each, poses in zip(shown, frames, strict=True)
        ],
    )


def _configuration(shown: Configuration, frames: Matrices) -> DrawnConfiguration:
    return DrawnConfiguration(
        centres=_plain(shown.centres),
        axes=_plain(shown.axes),
        links=[_plain(link) for link in shown.links],
        base=_plain(shown.base),
        base_normal=_plain(shown.base_normal),
        tool=_plain(shown.tool),
        tool_direction=_plain(shown.tool_direction),
        frames=_plain(frames),
    )


def _plain(numbers: Numbers) -> Any:
    # The numbers are rounded to 12 decimals, and have no negative 0.
    return (np.round(numbers, 12) + 0.0).tolist()


# --- Figures: the drawing of an exercise's mechanism


_THEME: Final = Query(
    description="`light`, `dark`, or `auto`, as the reader's system wants. Prints are always light."
)
_REFUSED: Final = refusals(
    HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND, HTTPStatus.UNPROCESSABLE_ENTITY
)


class SvgResponse(Response):
    """A response with a drawing in SVG."""

    media_type = "image/svg+xml"


def figures_routes(catalogue: Catalogue, own: OwnVariants) -> APIRouter:
    """Return the route that draws figures."""
    router = APIRouter(prefix="/v1/exercises", tags=["exercises"])
    figures = MemoizedResults()

    @router.get(
        "/{exercise_id}/figure.svg",
        operation_id="getFigure",
        summary="Draw the mechanism",
        response_class=SvgResponse,
        response_description="The drawing.",
        **of_assignment({"responses": _REFUSED}),
    )
    async def draw_figure(
        exercise_id: ExerciseId, request: Request, theme: Annotated[Theme, _THEME] = Theme.AUTO
    ) -> Response:
        """Draw the robot of an exercise: joints, links, given frames, lengths, joint variables.

        The figure shows no frame that the student may choose, and no number that the statement
        does not name. The angles of all joints are 0, and sliding joints are extended. An exercise
        without a robot has no figure.
        """
        exercise = await own.of(request, exercise_or_404(catalogue, exercise_id))
        if exercise.reference is None:
            raise ProblemError(
                HTTPStatus.NOT_FOUND,
                say("The exercise {exercise} has no robot to draw.", exercise=exercise.id),
                "no-figure",
                say("The exercise has no figure"),
            )
        key = (exercise.id, exercise.version, exercise.title, exercise.view, theme)
        content = await figures.of(key, lambda: exercise_figure(exercise, theme).encode())
        return SvgResponse(content, headers=figure_headers(theme))

    return router


def figure_headers(theme: Theme) -> dict[str, str]:
    """Return the HTTP headers of a figure; any page may show the figure."""
    digest = base64.b64encode(hashlib.sha256(style_sheet(theme).encode()).digest()).decode()
    policy = f"default-src 'none'; style-src 'sha256-{digest}'; frame-ancestors 'self'"
    return {
        "Content-Security-Policy": policy,
        "Cross-Origin-Resource-Policy": "cross-origin",
        "Cache-Control": "no-cache",
    }
