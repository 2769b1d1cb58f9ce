"""What the catalogue shows to a course: everything about an exercise but its answers."""

from http import HTTPStatus
from typing import Literal, assert_never

from fastapi import APIRouter
from pydantic import BaseModel, Field

from service.api.lookup import Catalogue, exercise_or_404
from service.api.openapi import refusals
from service.catalogue import (
    DhRowSpec,
    DhTableSpec,
    EulerAnglesSpec,
    Exercise,
    LinkTransformsSpec,
    MatrixSpec,
    PartSpec,
    PositionSpec,
    Robot,
    RotationSpec,
    ScrewAxesSpec,
    TransformSpec,
    VectorSpec,
)
from service.catalogue.schema import Freedom
from service.expressions import Kind
from service.kinematics.chain import COLUMNS
from service.kinematics.dh import Convention


class PartSummary(BaseModel):
    """A part in the list of exercises."""

    id: str
    kind: str
    points: float


class ExerciseSummary(BaseModel):
    """An exercise in the list."""

    id: str
    title: str
    source: str
    structure: str | None = Field(
        description="The joints in order: R turns, P slides. Null where there is no robot."
    )
    parts: list[PartSummary]


class ExerciseList(BaseModel):
    """The catalogue."""

    exercises: list[ExerciseSummary]


class SymbolView(BaseModel):
    """A letter that may stand in an answer."""

    name: str
    kind: Kind
    unit: str
    description: str
    joint: int | None = Field(None, description="The joint whose variable this is.")


class DhTableShape(BaseModel):
    """What a table must look like, and whose choice its frames are."""

    columns: list[str]
    rows: list[str] = Field(
        description="Row labels in order: joint numbers, `e` for the end effector. Where either "
        "convention will do, those of the longer table."
    )
    convention: Convention | Literal["either"]
    frames: Freedom
    base: Freedom
    tool: Freedom
    directions: Freedom


class MatrixShape(BaseModel):
    """What a matrix must look like."""

    columns: list[str]
    rows: list[str]


class ComponentView(BaseModel):
    """One value of a list: what it is called and what it is."""

    name: str
    quantity: Kind


class ListShape(BaseModel):
    """What a list of values must look like; of Euler angles also the axes, in order."""

    rows: list[str]
    components: list[ComponentView]
    sequence: str | None = Field(None, description='Such as "ZYZ"; "RPY" is Rz(α) Ry(β) Rx(γ).')
    axes: Literal["moving", "fixed"] | None = None


class ScrewAxesShape(BaseModel):
    """What a list of screw axes (ω; v) must look like: one six-vector for each row."""

    columns: list[str]
    rows: list[str]
    frame: Literal["space", "body"]
    directions: Freedom


class DhRowShape(BaseModel):
    """What a DH row must look like; `{"none": true}` says that there is none."""

    columns: list[str]
    convention: Convention


class LinkTransformsShape(BaseModel):
    """A list of 4×4 matrices, one for each row of the table; report rows are "A1.1" and so on."""

    matrices: list[str]
    rows: list[str]
    columns: list[str]
    convention: str
    frames: str


Shape = DhTableShape | LinkTransformsShape | ScrewAxesShape | DhRowShape | ListShape | MatrixShape


class PartView(BaseModel):
    """A part as a student sees it before answering."""

    id: str
    title: str
    prompt: str
    kind: str
    points: float
    all_or_nothing: bool
    follows: str | None = Field(
        None,
        description="The earlier part that this one follows from; left out where there is none.",
    )
    shape: Shape


class ExerciseView(BaseModel):
    """An exercise as a student sees it before answering."""

    id: str
    version: str
    title: str
    source: str
    structure: str | None = Field(None, description="Left out where there is no robot.")
    statement: str
    symbols: list[SymbolView]
    parts: list[PartView]


def summary(exercise: Exercise) -> ExerciseSummary:
    """The exercise's line in the list."""
    return ExerciseSummary(
        id=exercise.id,
        title=exercise.title,
        source=exercise.source,
        structure=exercise.structure,
        parts=[PartSummary(id=p.id, kind=p.kind, points=p.points) for p in exercise.parts],
    )


def view(exercise: Exercise) -> ExerciseView:
    """All of the exercise but its answers."""
    return ExerciseView(
        id=exercise.id,
        version=exercise.version,
        title=exercise.title,
        source=exercise.source,
        structure=exercise.structure,
        statement=exercise.statement,
        symbols=[
            SymbolView(
                name=variable.name,
                kind=variable.kind,
                unit=variable.unit,
                description=variable.description,
                joint=variable.joint,
            )
            for variable in exercise.variables
        ],
        parts=[
            PartView(
                id=part.id,
                title=part.title,
                prompt=part.prompt,
                kind=part.kind,
                points=part.points,
                all_or_nothing=part.all_or_nothing,
                follows=part.follows,
                shape=shape(part, exercise),
            )
            for part in exercise.parts
        ],
    )


def shape(part: PartSpec, exercise: Exercise) -> Shape:
    """What the part's answer must look like."""
    match part:
        case DhTableSpec():
            return DhTableShape(
                columns=list(COLUMNS),
                rows=_table_rows(part, exercise.robot),
                convention=part.convention,
                frames=part.frames,
                base=part.base,
                tool=part.tool,
                directions=part.directions,
            )
        case LinkTransformsSpec():
            rows = exercise.robot.tables[part.convention].labels
            return LinkTransformsShape(
                matrices=[f"A{row}" for row in rows],
                rows=_numbers(4),
                columns=_numbers(4),
                convention=part.convention,
                frames=part.frames,
            )
        case TransformSpec():
            return _matrix_shape(4, 4)
        case RotationSpec():
            return _matrix_shape(3, 3)
        case MatrixSpec():
            return _matrix_shape(len(part.expected), len(part.expected[0]))
        case PositionSpec() | VectorSpec() | EulerAnglesSpec():
            return _list_shape(part)
        case ScrewAxesSpec():
            joints = [str(joint.index) for joint in exercise.joints]
            return ScrewAxesShape(
                columns=_numbers(6),
                rows=_numbers(len(part.expected)) if part.expected else joints,
                frame=part.frame,
                directions=part.directions,
            )
        case DhRowSpec():
            return DhRowShape(columns=list(COLUMNS), convention=part.convention)
        case _:
            assert_never(part)


def _numbers(count: int) -> list[str]:
    return [str(i + 1) for i in range(count)]


def _matrix_shape(rows: int, columns: int) -> MatrixShape:
    return MatrixShape(columns=_numbers(columns), rows=_numbers(rows))


def _list_shape(part: PositionSpec | VectorSpec | EulerAnglesSpec) -> ListShape:
    components: list[tuple[str, Kind]]
    match part:
        case PositionSpec():
            components = [(letter, "length") for letter in part.coordinates]
        case VectorSpec():
            components = [(each.name, each.quantity) for each in part.components]
        case EulerAnglesSpec():
            components = [(f"about {axis.lower()}", "angle") for axis in part.turns]
    shown = ListShape(
        rows=_numbers(len(components)),
        components=[ComponentView(name=name, quantity=kind) for name, kind in components],
    )
    if isinstance(part, EulerAnglesSpec):
        shown.sequence, shown.axes = part.sequence, part.axes
    return shown


def _table_rows(part: DhTableSpec, robot: Robot) -> list[str]:
    if part.convention == "either":
        return max((list(table.labels) for table in robot.tables.values()), key=len)
    return list(robot.tables[part.convention].labels)


def routes(catalogue: Catalogue) -> APIRouter:
    """The routes that show the catalogue."""
    router = APIRouter(prefix="/v1/exercises", tags=["exercises"])

    @router.get("")
    async def list_exercises() -> ExerciseList:
        """All exercises, in the order of their files' names."""
        return ExerciseList(exercises=[summary(exercise) for exercise in catalogue.values()])

    @router.get(
        "/{exercise_id}",
        responses=refusals(HTTPStatus.NOT_FOUND),
        response_model_exclude_none=True,
    )
    async def show_exercise(exercise_id: str) -> ExerciseView:
        """One exercise: its statement, its symbols, and what each part asks for."""
        return view(exercise_or_404(catalogue, exercise_id))

    return router
