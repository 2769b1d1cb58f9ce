"""The bodies of previews, and of the numbers with which a table or a mechanism is drawn.

The numbers are computed in ``dh_grader.figures``.
"""

from typing import Annotated, Any, Final, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    PlainSerializer,
    SerializationInfo,
    ValidatorFunctionWrapHandler,
    WrapValidator,
)

from dh_grader.expressions import Kind
from dh_grader.figures.drawing import Theme
from dh_grader.figures.table_figure import LARGEST
from dh_grader.kinematics import Convention
from dh_grader.translations import Sentence, told

# --- Previews, which show how a text is read while the student types


def _kept(text: Any, validated: ValidatorFunctionWrapHandler) -> Any:
    return text if isinstance(text, Sentence) else validated(text)


def _told(text: str, info: SerializationInfo) -> str:
    return told(text, info.context)


# A sentence that is told when its model is written: ``model_dump_json(context=translation)``.
ToldText = Annotated[str, WrapValidator(_kept), PlainSerializer(_told)]


class PreviewRequest(BaseModel):
    """A text and its place in an exercise."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    text: str = Field(description="One entry as typed by the student, or a pasted table or matrix.")
    exercise: str | None = Field(
        None,
        description="The exercise whose symbols the text may use. Default: joint angles theta1 "
        "(or q1) to theta9, link twists alpha1 to alpha9, lengths a1, d1, l1 to a9, d9, l9.",
    )
    part: str | None = Field(None, description="The part that it answers; requires `exercise`.")
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="The unit of angles without a unit."
    )
    quantity: Kind = Field(
        "number", description="The expected quantity; it matters for numbers in degrees."
    )


class PreviewNote(BaseModel):
    """A note on how the text was read; ``span`` is the range [from, to) in the text."""

    # The fields are read from the attributes of the reader's notes and errors.
    model_config = ConfigDict(from_attributes=True)

    code: str
    message: ToldText
    span: tuple[int, int]


class PreviewError(PreviewNote):
    """The reason why the text cannot be read."""

    suggestion: str | None = Field(None, description="The whole text after a repair.")


class PreviewCell(BaseModel):
    """The reading of one cell of a pasted table or matrix; labels are those of a report."""

    model_config = ConfigDict(from_attributes=True)

    row: str
    column: str
    span: tuple[int, int] = Field(description="[from, to) in the pasted text.")
    typed: str
    entry: str = Field(
        description="The text that has the same meaning in a single cell. It differs from `typed` "
        "if a header names a unit."
    )
    text: str
    latex: str
    mathml: str
    symbols: list[str]
    notes: list[PreviewNote]
    error: PreviewError | None = Field(None, validation_alias="problem")


class PreviewAnswer(BaseModel):
    """The reading of the text, or the reason why it cannot be read.

    For one entry it has `text`, `latex`, `mathml` and `symbols`, or only `error`. For a pasted
    table or matrix it has `rows` of cells, and `ok` is true if every cell is readable.
    """

    ok: bool
    rows: list[list[PreviewCell]] | None = Field(
        None, description="The cells of a pasted table or matrix; requires `exercise` and `part`."
    )
    text: str | None = None
    latex: str | None = None
    mathml: str | None = None
    symbols: list[str] | None = Field(None, description="The symbols used, by canonical name.")
    notes: list[PreviewNote] | None = None
    error: PreviewError | None = None


class EntryToPreview(BaseModel):
    """One of several entries and its expected quantity."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    text: str = Field(description="The entry as typed by the student.")
    quantity: Kind = Field("number", description="The expected quantity.")


# The number of entries in the link transforms of the longest robot in an exercise.
MAX_ENTRIES: Final = 192


class PreviewManyRequest(BaseModel):
    """The changed entries of one part."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    exercise: str = Field(description="The exercise whose symbols the entries may use.")
    part: str = Field(description="The part that the entries answer.")
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="The unit of angles without a unit."
    )
    entries: list[EntryToPreview] = Field(max_length=MAX_ENTRIES)


class PreviewManyResponse(BaseModel):
    """The readings in the order of the entries."""

    results: list[PreviewAnswer]


# --- Numbers with which a table or a mechanism is drawn


# The most configurations in one request: one second of a motion at 30 pictures per second.
MOST_CONFIGURATIONS: Final = 30
_MOST_SYMBOLS: Final = 100

Amount = Annotated[float, Field(ge=-LARGEST, le=LARGEST, allow_inf_nan=False)]
Configurations = Annotated[list[list[Amount]], Field(min_length=1, max_length=MOST_CONFIGURATIONS)]
Point = Annotated[list[float], Field(min_length=3, max_length=3)]
Matrix = Annotated[
    list[Annotated[list[float], Field(min_length=4, max_length=4)]],
    Field(min_length=4, max_length=4),
]


class TableToDraw(BaseModel):
    """A table as in a submission, right or wrong."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    rows: Any = Field(description='The rows, `[{"a", "alpha", "d", "theta"}, …]`, or pasted text.')
    convention: Convention = Field(Convention.STANDARD, description="The convention of the table.")
    structure: Annotated[str, Field(pattern=r"^[RP]{1,10}$")] | None = Field(
        None,
        description="One letter for each joint, R if it turns and P if it slides. Only without an "
        "exercise, which has its own. The variable of joint i is theta_i or d_i, or q_i in both "
        "cases. The other cells may contain a1, alpha1, d1, theta1, l1 up to those of row 12.",
    )
    formulas: bool = Field(
        False,
        description="If true, return the table as formulas, too: its cells, its equivalent in the "
        "other convention, and the pose. Only without an exercise.",
    )


class PlacedToDraw(BaseModel):
    """Frames as in the submission of a part of the kind `frames`, right or wrong."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    part: str = Field(description="The part of the exercise.")
    rows: Any = Field(description='The rows, `[{"axis", "z", "origin", "x"}, …]`, or pasted text.')


class FramesRequest(BaseModel):
    """A request to draw a table, the mechanism of an exercise, or both."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    exercise: str | None = Field(
        None, description="The exercise whose mechanism is drawn, and whose symbols a table uses."
    )
    table: TableToDraw | None = Field(None, description="The table whose frames are drawn.")
    placed: PlacedToDraw | None = Field(
        None, description="The placed frames that are drawn. Only with an exercise."
    )
    joints: Configurations | None = Field(
        None,
        description="Values of all joint variables in order, radians and lengths, for each "
        "picture. Default: the home configuration, with sliding joints drawn out.",
    )
    symbols: Annotated[dict[str, Amount], Field(max_length=_MOST_SYMBOLS)] = Field(
        {},
        description="Values of other symbols, radians and lengths. Default: a value in the range "
        "of each symbol.",
    )
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="The unit of angles without a unit in the table."
    )
    figure: Theme | None = Field(
        None,
        description="Draw the first picture as SVG, too: in light or dark colours, or `auto`, by "
        "the reader's system.",
    )


class MovingJoint(BaseModel):
    """A joint and the range of its variable, in radians or lengths."""

    joint: int
    variable: str
    kind: Literal["R", "P"] = Field(description="R turns, P slides.")
    low: float
    high: float
    home: float = Field(description="The value of its variable in the drawn home configuration.")


class UnreadCell(BaseModel):
    """A cell of the table without a number; labels are those of a report."""

    row: str
    column: str
    error: PreviewError


class LostFreedom(BaseModel):
    """Joints that together allow no more motions than fewer joints would."""

    model_config = ConfigDict(from_attributes=True)

    joints: list[int]
    message: ToldText


class PrintedFormula(BaseModel):
    """A formula as text, LaTeX and MathML."""

    text: str
    latex: str
    mathml: str


class ConvertedRow(BaseModel):
    """A row of a converted table: a, alpha, d and theta.

    Its `label` is its number, "b" for a fixed row before the first joint, or "e" for the tool row.
    """

    label: str
    cells: list[PrintedFormula]


class TableInFormulas(BaseModel):
    """The table as formulas. `converted` and `pose` are absent if a cell has no formula."""

    cells: list[list[PrintedFormula]] = Field(
        description="The cells; empty if a cell is unreadable or too long to be printed."
    )
    converted: list[ConvertedRow] | None = Field(
        None, description="The equivalent table in the other convention."
    )
    pose: list[list[PrintedFormula]] | None = Field(
        None,
        description="The last frame in the base frame, 4×4 by rows. Absent if it is too long.",
    )


class FramesOfTable(BaseModel):
    """The frames of the table.

    `complete` is false if a cell has no number; the frames end before the first such row.
    """

    complete: bool
    frames: list[list[Matrix]] = Field(
        description="For each picture, all frames from the base frame on, in the base frame, 4×4 "
        "by rows."
    )
    values: list[list[list[float]]] = Field(
        description="For each picture, the numbers of each row with a frame: a, alpha, d and theta."
    )
    row_joints: list[int] = Field(
        description="For each row with a frame, the joint whose variable is in the row, or 0."
    )
    unread: list[UnreadCell]
    error: PreviewError | None = Field(None, description="The reason if there are no rows at all.")
    degrees_of_freedom: int | None = Field(
        None, description="The degrees of freedom of the whole table in a generic configuration."
    )
    lost_freedoms: list[LostFreedom]
    formulas: TableInFormulas | None = Field(None, description="Only if requested.")


class FramesAsPlaced(BaseModel):
    """The placed frames that have numbers. They move with the links on which they are.

    The x axis is as the student wrote it, even if it is not perpendicular to z.
    """

    labels: list[str] = Field(description="The numbers of these frames.")
    frames: list[list[Matrix]] = Field(
        description="For each picture, these frames in the base frame, 4×4 by rows."
    )
    left_out: list[UnreadCell] = Field(
        description="Of each other frame that was begun, the first cell without a number."
    )
    error: PreviewError | None = Field(None, description="The reason if there are no rows at all.")


class DrawnConfiguration(BaseModel):
    """The mechanism in one picture, in the base frame.

    `axes` are unit vectors of the joint axes through `centres`. Link i is a line from joint i to
    the next; the first link begins at the base, and the last one ends at the tool. `frames` are
    the given frames, as named in the mechanism.
    """

    centres: list[Point]
    axes: list[Point]
    links: list[list[Point]]
    base: Point
    base_normal: Point
    tool: Point
    tool_direction: Point
    frames: list[Matrix]


class DrawnMechanism(BaseModel):
    """The mechanism of the exercise: joint axes, links, base, tool, and the given frames."""

    size: float = Field(description="A reference length for the sizes of drawn joints and links.")
    azimuth: float = Field(description="The direction to the viewer: degrees about z0 from x0.")
    elevation: float = Field(description="The viewer's elevation above the x0-y0 plane in degrees.")
    frames: list[str] = Field(
        description="The labels of the frames that the exercise gives: `0` for {0}."
    )
    comparable: bool = Field(
        description="True if the last frame of a table may be compared with the tool frame: the "
        "exercise gives base and tool, and neither limits attempts nor tells only a score."
    )
    configurations: list[DrawnConfiguration]


class FramesAnswer(BaseModel):
    """The numbers of the drawing. Lengths are in the exercise's unit, angles in radians."""

    symbols: dict[str, float] = Field(
        description="The values of all symbols that are not joint variables."
    )
    joints: list[MovingJoint]
    table: FramesOfTable | None = None
    placed: FramesAsPlaced | None = None
    mechanism: DrawnMechanism | None = None
    figure: str | None = Field(
        None,
        description="The first picture as SVG, if requested; only frames have labels.",
    )
