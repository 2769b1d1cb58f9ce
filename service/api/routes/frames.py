"""The route that computes where to draw the frames of a DH table and the links of a robot."""

from collections import OrderedDict
from collections.abc import Hashable, Iterator, Mapping, Sequence, Set
from functools import cache, partial
from typing import Any, Final

import numpy as np
from fastapi import APIRouter, Request, Response

from service.api.courses.own_variant import OwnVariants, of_assignment
from service.api.document.openapi import posting
from service.api.http.bodies import read_body
from service.api.http.language import language_of
from service.api.http.lookup import Catalogue, Location, require_exercise
from service.api.http.problems import ProblemError, invalid
from service.api.http.told_answer import in_languages, told_json
from service.api.permissions.access import Access, require_reach
from service.api.turns import run_in_turns
from service.catalogue import Exercise
from service.catalogue.feedback_level import FeedbackLevel
from service.catalogue.parts.frames import FramesSpec
from service.contract.frames import (
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
    PrintedFormula,
    TableInFormulas,
    TableToDraw,
    UnreadCell,
)
from service.contract.preview import PreviewError
from service.expressions import Expression
from service.figures.figure import default_view, subject_of
from service.figures.geometry.given_frames import given_frames
from service.figures.geometry.mechanism import (
    Configuration,
    MovableMechanism,
    as_samples,
    mechanism_of,
)
from service.figures.geometry.view import View
from service.figures.table_figure import SeenMechanism, WrittenChain, table_figure
from service.figures.tables.placed_frames import placed_frames
from service.figures.tables.scope import DrawingScope, free_scope
from service.figures.tables.table_formulas import TableFormulas, table_formulas
from service.figures.tables.table_frames import TableFrames, table_frames, table_to_draw
from service.grading.feedback import Finding, UnreadableAnswerError
from service.grading.work_budget import WorkBudget
from service.kinematics.transforms import Matrices, Numbers
from service.time_slices import checkpoint
from service.translations import Sentence, say, say_count

_MOST_MECHANISMS: Final = 64


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


def routes(catalogue: Catalogue, access: Access, own: OwnVariants) -> APIRouter:
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
