"""What is to be drawn, and the numbers to draw it with."""

from typing import Annotated, Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field

from service.contract.preview import PreviewError
from service.figures.drawing.style import Theme
from service.figures.tables.table_frames import LARGEST
from service.kinematics.dh import Convention

# Joint values in one request: a second of a motion at 30 pictures a second.
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
    """A table as it would be handed in, right or wrong."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    rows: Any = Field(description='The rows, `[{"a", "alpha", "d", "theta"}, …]`, or pasted text.')
    convention: Convention = Field(
        Convention.STANDARD, description="How its rows are put together."
    )
    structure: Annotated[str, Field(pattern=r"^[RP]{1,10}$")] | None = Field(
        None,
        description="One letter for each joint, R if it turns and P if it slides; without an "
        "exercise, which has its own. Joint i moves by theta_i or d_i, or q_i in either case; "
        "a1, alpha1, d1, theta1, l1 to those of row 12 may stand in the other cells.",
    )
    formulas: bool = Field(
        False,
        description="Give the table as formulas, too: its cells, its equivalent in the other "
        "convention, and the pose. Only without an exercise.",
    )


class FramesRequest(BaseModel):
    """What is to be drawn: a table, the mechanism of an exercise, or both."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    exercise: str | None = Field(
        None, description="The exercise whose mechanism is drawn, and whose symbols a table uses."
    )
    table: TableToDraw | None = Field(None, description="The table whose frames are drawn.")
    joints: Configurations | None = Field(
        None,
        description="Values of all joint variables in order, radians and lengths, for each "
        "picture. Default: the home configuration, with sliding joints drawn out.",
    )
    symbols: Annotated[dict[str, Amount], Field(max_length=_MOST_SYMBOLS)] = Field(
        {},
        description="Numbers for other symbols, radians and lengths. Each one that is left out "
        "gets a number from its range.",
    )
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="What a bare number means in the angles of the table."
    )
    figure: Theme | None = Field(
        None,
        description="Draw the first picture, too: light, dark, or as the reader's system asks.",
    )


class MovingJoint(BaseModel):
    """A joint, and how far its variable may go: radians or lengths."""

    joint: int
    variable: str
    kind: Literal["R", "P"] = Field(description="R turns, P slides.")
    low: float
    high: float
    home: float = Field(description="Its value in the home configuration as it is drawn.")


class UnreadCell(BaseModel):
    """A cell of the table that has no number, by the labels of a report."""

    row: str
    column: str
    error: PreviewError


class LostFreedom(BaseModel):
    """Joints that do no more together than fewer would."""

    model_config = ConfigDict(from_attributes=True)

    joints: list[int]
    message: str


class PrintedFormula(BaseModel):
    """A formula, as text, LaTeX and MathML."""

    text: str
    latex: str
    mathml: str


class ConvertedRow(BaseModel):
    """A row of a converted table: a, alpha, d and theta.

    Its `label` is its number, "b" for a fixed row before the first joint, "e" for the tool's row.
    """

    label: str
    cells: list[PrintedFormula]


class TableInFormulas(BaseModel):
    """The table as formulas; what needs all cells is absent where one has no formula."""

    cells: list[list[PrintedFormula]] = Field(
        description="Empty for a cell that is not read, or too long to be printed."
    )
    converted: list[ConvertedRow] | None = Field(
        None, description="Its equivalent in the other convention."
    )
    pose: list[list[PrintedFormula]] | None = Field(
        None,
        description="The last frame in the base frame, 4×4 by rows. Absent where it is too long.",
    )


class FramesOfTable(BaseModel):
    """The frames of the table.

    They end before the first row with a cell that has no number; then `complete` is false.
    """

    complete: bool
    frames: list[list[Matrix]] = Field(
        description="For each picture every frame in the base frame, 4×4 by rows, from the base "
        "frame on."
    )
    row_joints: list[int] = Field(
        description="For each row that has a frame the joint whose variable stands in it, or 0."
    )
    unread: list[UnreadCell]
    error: PreviewError | None = Field(None, description="Why there are no rows at all.")
    degrees_of_freedom: int | None = Field(
        None, description="Those of the whole table at a generic configuration."
    )
    lost_freedoms: list[LostFreedom]
    formulas: TableInFormulas | None = Field(None, description="Only where they are asked for.")


class DrawnConfiguration(BaseModel):
    """The mechanism in one picture, in the base frame.

    A joint's `axes` are unit vectors through `centres`. Link i is a line from joint i to the next,
    the first one from the base, the last one to the tool.
    """

    centres: list[Point]
    axes: list[Point]
    links: list[list[Point]]
    base: Point
    base_normal: Point
    tool: Point
    tool_direction: Point


class DrawnMechanism(BaseModel):
    """The mechanism of the exercise: joint axes, links, base and tool. No frames."""

    size: float = Field(description="A length that the sizes of joints and links suit.")
    azimuth: float = Field(description="Where the figure is seen from: degrees about z0 from x0.")
    elevation: float = Field(description="Degrees above the plane of x0 and y0.")
    configurations: list[DrawnConfiguration]


class FramesAnswer(BaseModel):
    """Numbers to draw with. Lengths are in the exercise's unit, angles in radians."""

    symbols: dict[str, float] = Field(
        description="The number of each symbol that is no joint variable."
    )
    joints: list[MovingJoint]
    table: FramesOfTable | None = None
    mechanism: DrawnMechanism | None = None
    figure: str | None = Field(
        None, description="The first picture as SVG, where it is asked for; no names but of frames."
    )
