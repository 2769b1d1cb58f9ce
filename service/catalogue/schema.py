"""The shape of an exercise file: what a tutor may write, checked by pydantic.

A formula is text in the students' own notation (``"l1 + 0.1"``, ``"-90deg"``); that it can be read
is checked in ``compile.py``, where the exercise's symbols are known.
"""

from typing import Annotated, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    StrictInt,
    StringConstraints,
    Tag,
    model_validator,
)

from service.catalogue.check_schema import CheckSpec as CheckSpec
from service.expressions import Kind
from service.kinematics.dh import Convention


def _no_truth_value(value: object) -> object:
    if isinstance(value, bool):
        raise ValueError(f"is {str(value).lower()}; write a number or a formula")
    return value


_NotBool = BeforeValidator(_no_truth_value)
Formula = Annotated[str | float, _NotBool]
Text = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1)]
Identifier = Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9]*(?:[-_][a-z0-9]+)*$")]
Freedom = Literal["given", "free"]
Axis = Literal["x", "y", "z"]
Frame = Literal["base", "tool"] | Annotated[StrictInt, Field(ge=0)]

Triple = tuple[Formula, Formula, Formula]
Four = tuple[Formula, Formula, Formula, Formula]
Homogeneous = tuple[Four, Four, Four, Four]
Screw = tuple[Formula, Formula, Formula, Formula, Formula, Formula]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class SymbolSpec(_Strict):
    """A letter that may stand in an answer, and the range that its values are drawn from."""

    kind: Kind
    description: Text
    unit: str = ""
    range: tuple[Formula, Formula] | None = None


class RobotSpec(_Strict):
    """The reference mechanism as a table; ``table`` has one row [a, alpha, d, theta] per joint.

    One row more than joints is the fixed end-effector row "e".
    """

    structure: Annotated[str, StringConstraints(pattern=r"^[RP]{1,10}$")]
    convention: Convention
    joints: Annotated[list[Text], Field(min_length=1)]
    table: list[Four]

    @model_validator(mode="after")
    def _fits_together(self) -> "RobotSpec":
        joints = len(self.structure)
        if len(self.joints) != joints:
            raise ValueError(
                f"joints names {len(self.joints)} variables, but structure {self.structure!r} "
                f"has {joints} joints; write one variable for each"
            )
        if len(self.table) not in (joints, joints + 1):
            raise ValueError(
                f"table has {len(self.table)} rows; write {joints} (one for each joint) "
                f"or {joints + 1} (with a fixed end-effector row)"
            )
        return self


class ScrewRobotSpec(_Strict):
    """The reference mechanism by its product of exponentials.

    ``home`` is the pose M of the tool with all joint variables 0, ``screws`` holds the axis (ω; v)
    of each joint there, seen from the base (the space frame).
    """

    structure: Annotated[str, StringConstraints(pattern=r"^[RP]{1,10}$")]
    joints: Annotated[list[Text], Field(min_length=1)]
    home: Homogeneous
    screws: list[Screw]

    @model_validator(mode="after")
    def _fits_together(self) -> "ScrewRobotSpec":
        joints = len(self.structure)
        for name, count in (("joints", len(self.joints)), ("screws", len(self.screws))):
            if count != joints:
                raise ValueError(
                    f"{name} has {count} entries, but structure {self.structure!r} has {joints} "
                    f"joints; write one for each"
                )
        return self


def _how_the_robot_is_given(robot: object) -> str:
    by_screws = isinstance(robot, ScrewRobotSpec) or (
        isinstance(robot, dict) and not robot.keys().isdisjoint({"screws", "home"})
    )
    return "screws" if by_screws else "table"


# The key that is written decides, so that a fault is told of the one form that was meant.
AnyRobotSpec = Annotated[
    Annotated[RobotSpec, Tag("table")] | Annotated[ScrewRobotSpec, Tag("screws")],
    Discriminator(_how_the_robot_is_given),
]


class _PartSpec(_Strict):
    """What every part has.

    ``follows`` names an earlier part: what is wrong, but right for the student's own answer there,
    earns its points, if that answer earned at least the share ``follows_from`` of its own.
    """

    id: Identifier
    title: Text
    prompt: str = ""
    points: Annotated[float, Field(gt=0, le=1000), _NotBool] = 1.0
    all_or_nothing: bool = False
    follows: Identifier | None = None
    follows_from: Annotated[float, Field(ge=0, le=1), _NotBool] = 0.5


class DhTableSpec(_PartSpec):
    """A Denavit-Hartenberg table of the robot.

    ``frames`` says whose choice the frames on the joints are. Where they are free, ``base`` and
    ``tool`` say the same of the first and the last frame, ``directions`` of each joint's positive
    sense. With the convention "either" the answer says which it uses.
    """

    kind: Literal["dh_table"]
    convention: Convention | Literal["either"]
    frames: Freedom = "given"
    base: Freedom = "given"
    tool: Freedom = "given"
    directions: Freedom = "given"

    @model_validator(mode="after")
    def _freedoms_go_together(self) -> "DhTableSpec":
        free = [name for name in ("base", "tool", "directions") if getattr(self, name) == "free"]
        if self.frames == "given" and free:
            raise ValueError(
                f'{free[0]} = "free" says nothing where frames = "given"; '
                f'write frames = "free" or leave {free[0]} out'
            )
        return self


class LinkTransformsSpec(_PartSpec):
    """The link transforms A_1 … A_n that the rows of a table stand for.

    Where ``frames`` are free they may belong to any valid table; to the student's own, where the
    part follows a table.
    """

    kind: Literal["link_transforms"]
    convention: Convention
    frames: Freedom = "given"


class _PoseSpec(_PartSpec):
    """Something that a pose of the robot has: that of frame ``to`` seen from frame ``from``.

    A frame is "base", "tool" or a number of the robot's own table. ``home`` takes all joint
    variables as 0. A part of another robot, or of none, gives its answer as ``expected``.
    """

    start: Frame = Field("base", alias="from")
    to: Frame = "tool"
    home: bool = False

    @property
    def given_as(self) -> str | None:
        """The field that holds the answer itself; None where it is the robot's pose."""
        return next((name for name in ("expected", "steps") if getattr(self, name, None)), None)

    @model_validator(mode="after")
    def _is_given_once(self) -> "_PoseSpec":
        given = [name for name in ("expected", "steps") if getattr(self, name, None)]
        names = {"start": "from", "to": "to", "home": "home"}
        given += [name for field, name in names.items() if field in self.model_fields_set]
        if len(given) > 1 and given[0] in ("expected", "steps"):
            raise ValueError(f"{given[0]} says what is right; leave {given[1]} out")
        return self


class TransformSpec(_PoseSpec):
    """A homogeneous transform; without more, from the base frame to the end-effector frame."""

    kind: Literal["transform"]
    expected: Homogeneous | None = None


class StepSpec(_Strict):
    """One turn of a composite rotation, about an axis of the fixed or of the moving frame."""

    axis: Axis
    angle: Formula
    about: Literal["fixed", "moving"] = "moving"


class RotationSpec(_PoseSpec):
    """A rotation matrix, 3×3: of a pose, by its entries, or by the turns that it is made of."""

    kind: Literal["rotation"]
    expected: tuple[Triple, Triple, Triple] | None = None
    steps: Annotated[list[StepSpec], Field(min_length=1, max_length=6)] | None = None


class PositionSpec(_PoseSpec):
    """The coordinates of a point: of a frame's origin, or ``expected``."""

    kind: Literal["position"]
    coordinates: Annotated[str, StringConstraints(pattern=r"^(x?y?z?)$", min_length=2)] = "xyz"
    expected: list[Formula] | None = None

    @model_validator(mode="after")
    def _one_for_each(self) -> "PositionSpec":
        if self.expected is not None and len(self.expected) != len(self.coordinates):
            raise ValueError(
                f"expected has {len(self.expected)} entries, but coordinates are "
                f"{self.coordinates!r}; write one for each"
            )
        return self


class EulerAnglesSpec(_PoseSpec):
    """Three angles that describe a rotation, in the order in which ``sequence`` names the axes.

    "RPY" is Rz(α) Ry(β) Rx(γ), answered as α, β, γ: the same as "ZYX" about moving axes.
    ``expected`` is one triple that is right; all others of the same rotation are right, too.
    """

    kind: Literal["euler_angles"]
    sequence: Literal[
        "RPY", "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ"
    ]
    axes: Literal["moving", "fixed"] = "moving"
    expected: Triple | None = None

    @property
    def turns(self) -> str:
        """The sequence by its three axes."""
        return "ZYX" if self.sequence == "RPY" else self.sequence

    @model_validator(mode="after")
    def _rpy_is_about_moving_axes(self) -> "EulerAnglesSpec":
        if self.sequence == "RPY" and self.axes == "fixed":
            raise ValueError(
                'sequence "RPY" is answered as Rz(α) Ry(β) Rx(γ); write sequence = "XYZ" with '
                'axes = "fixed" for roll, pitch, yaw in this order'
            )
        return self


class MatrixSpec(_PartSpec):
    """A matrix of any meaning, up to 6×6; ``quantity`` is what its entries are, or each column."""

    kind: Literal["matrix"]
    expected: Annotated[
        list[Annotated[list[Formula], Field(min_length=1, max_length=6)]],
        Field(min_length=1, max_length=6),
    ]
    quantity: Kind | list[Kind] = "number"

    @property
    def quantities(self) -> tuple[tuple[Kind, ...], ...]:
        """What each entry is."""
        columns = len(self.expected[0])
        row = (self.quantity,) * columns if isinstance(self.quantity, str) else self.quantity
        return (tuple(row),) * len(self.expected)

    @model_validator(mode="after")
    def _is_rectangular(self) -> "MatrixSpec":
        columns = len(self.expected[0])
        for i, row in enumerate(self.expected):
            if len(row) != columns:
                raise ValueError(
                    f"row {i + 1} of expected has {len(row)} entries, row 1 has {columns}; write "
                    f"rows of one length"
                )
        if not isinstance(self.quantity, str) and len(self.quantity) != columns:
            raise ValueError(
                f"quantity names {len(self.quantity)} columns, but expected has {columns}; write "
                f"one for all or one for each column"
            )
        return self


class ComponentSpec(_Strict):
    """One component of a vector: what it is called, what it is, and what is right."""

    name: Text
    quantity: Kind
    expected: Formula


class VectorSpec(_PartSpec):
    """A list of values, each a length, an angle or a number, such as (p_x, p_y, φ)."""

    kind: Literal["vector"]
    components: Annotated[list[ComponentSpec], Field(min_length=1, max_length=12)]


class ScrewAxesSpec(_PartSpec):
    """The screw axis (ω; v) of each joint with all joint variables 0.

    ``frame`` says whether it is seen from the base ("space") or from the tool ("body"). Where
    ``directions`` are free, an axis may be reversed. Without a robot the axes are ``expected``.
    """

    kind: Literal["screw_axes"]
    frame: Literal["space", "body"]
    directions: Freedom = "given"
    expected: Annotated[list[Screw], Field(min_length=1, max_length=12)] | None = None


class DhRowSpec(_PartSpec):
    """The row of a transform in the DH table, or that it has none."""

    kind: Literal["dh_row"]
    convention: Convention = Convention.STANDARD
    transform: Homogeneous


PartSpec = Annotated[
    DhTableSpec
    | LinkTransformsSpec
    | TransformSpec
    | RotationSpec
    | MatrixSpec
    | PositionSpec
    | VectorSpec
    | EulerAnglesSpec
    | ScrewAxesSpec
    | DhRowSpec,
    Field(discriminator="kind"),
]


# The kinds whose answer is a chain that a later part can follow from.
CARRYING = ("dh_table", "link_transforms", "transform")


class ExerciseSpec(_Strict):
    """One exercise file."""

    title: Text
    source: Text
    statement: Text
    robot: AnyRobotSpec | None = None
    symbols: dict[Text, SymbolSpec] = {}
    parts: Annotated[list[PartSpec], Field(min_length=1)]
    checks: list[CheckSpec] = []

    @model_validator(mode="after")
    def _part_ids_are_unique(self) -> "ExerciseSpec":
        ids = [part.id for part in self.parts]
        repeated = sorted({part_id for part_id in ids if ids.count(part_id) > 1})
        if repeated:
            raise ValueError(f"two parts share the id {repeated[0]!r}; give each its own")
        return self

    @model_validator(mode="after")
    def _parts_follow_earlier_ones(self) -> "ExerciseSpec":
        earlier: dict[str, str] = {}
        for part in self.parts:
            if part.follows is not None and earlier.get(part.follows) not in CARRYING:
                raise ValueError(
                    f"part {part.id!r} follows {part.follows!r}, which is no earlier part of kind "
                    f"{', '.join(CARRYING)}; name one, or leave follows out"
                )
            earlier[part.id] = part.kind
        return self
