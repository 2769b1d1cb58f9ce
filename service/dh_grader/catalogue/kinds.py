"""The answer kinds in exercise files: one subclass of ``PartSpec`` for each kind.

They say what a part asks and check that it can be asked. Judging is in ``grading/kinds``.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, Annotated, ClassVar, Final, Literal, TypeAlias, get_type_hints

import numpy as np
from pydantic import Field, StringConstraints, model_validator

from dh_grader.catalogue.part import (
    AnswerShape,
    ListShape,
    MatrixShape,
    PartSpec,
    PosePartSpec,
    TablePartSpec,
    choices,
    list_shape,
    matrix_shape,
    numbered,
)
from dh_grader.catalogue.robot import (
    EXACT,
    ROTATION,
    FieldError,
    Joint,
    Reference,
    ReferenceTable,
    Robot,
    WrittenFormulas,
    check_rotation,
    check_transform,
    list_of,
    matrix_of,
    screws_of,
    transform_of,
)
from dh_grader.catalogue.schema_fields import (
    Formula,
    GivenOrFree,
    Homogeneous,
    NotBool,
    Screw,
    StrictModel,
    Text,
    Triple,
    advice,
)
from dh_grader.expressions import Kind
from dh_grader.kinematics import COLUMNS, Convention, Numbers, dh1_residual, dh2_residual
from dh_grader.translations import say, template

# --- Answer kind ``vector``: a list of values, such as (p_x, p_y, φ)


class ComponentSpec(StrictModel):
    """One component of a vector."""

    name: Text
    """The name of the component."""
    quantity: Kind
    """The quantity: an angle, a length or a plain number."""
    expected: Formula
    """The right value."""


class VectorSpec(PartSpec):
    """A list of values, each a length, an angle or a number, such as (p_x, p_y, φ)."""

    answer_fields: ClassVar[tuple[str, ...]] = ("components",)

    kind: Literal["vector"]
    components: Annotated[list[ComponentSpec], Field(min_length=1, max_length=12)]
    """The values in order."""

    def formulas(self) -> WrittenFormulas:
        """The formula of each component's right value."""
        return list_of(
            "components[{j}].expected",
            [component.expected for component in self.components],
            [component.quantity for component in self.components],
        )

    def shape(self, _: Reference | None) -> ListShape:
        """The shape of the list of components."""
        return list_shape((each.name, each.quantity) for each in self.components)


# --- Answer kind ``transform``: a homogeneous transform, such as the pose of the end effector


class TransformSpec(PosePartSpec):
    """A homogeneous transform, 4×4; by default the pose of the tool in the base frame."""

    can_be_followed: ClassVar[bool] = True

    kind: Literal["transform"]
    expected: Homogeneous | None = None
    """The entries of the transform, row by row, instead of the robot's pose."""

    def formulas(self) -> WrittenFormulas | None:
        """The entries, if the file gives them."""
        return None if self.expected is None else transform_of("expected", self.expected)

    def shape(self, _: Reference | None) -> MatrixShape:
        """The shape of a 4×4 matrix."""
        return matrix_shape(4, 4)


# --- Answer kind ``screw_axes``: the screw axis of each joint


class ScrewAxesShape(AnswerShape):
    """The shape of a list of screw axes (ω; v): one six-vector for each row."""

    posted: ClassVar[str] = "a list of six-vectors (ω; v)"

    form: Literal["screw_axes"] = "screw_axes"
    columns: list[str]
    rows: list[str]
    frame: Literal["space", "body"]
    directions: GivenOrFree

    def _clauses(self) -> Iterator[str]:
        numbers = f"{len(self.columns)} numbers (ω; v)"
        yield f"a list of screw axes, {numbers} for each of {', '.join(self.rows)}"
        yield f"{self.frame} frame"
        yield from choices(directions=self.directions)


class ScrewAxesSpec(PartSpec):
    """The screw axis (ω; v) of each joint with all joint variables 0."""

    kind: Literal["screw_axes"]
    frame: Literal["space", "body"]
    """The frame of the axes: the base frame ("space") or the tool frame ("body")."""
    directions: GivenOrFree = "given"
    """The directions of the axes: with "free", an axis may be reversed."""
    expected: Annotated[list[Screw], Field(min_length=1, max_length=12)] | None = None
    """The right axes, instead of those of the robot."""

    def formulas(self) -> WrittenFormulas | None:
        """The axes, if the file gives them."""
        return None if self.expected is None else screws_of("expected", self.expected)

    def numbers(self, joints: Sequence[Joint]) -> range:
        """The numbers of the required axes: those of the joints, or from 1 for given axes."""
        first = 1 if self.expected or not joints else joints[0].index
        return range(first, first + len(self.expected or joints))

    def shape(self, reference: Reference | None) -> ScrewAxesShape:
        """The shape of a list of six-vectors."""
        numbers = self.numbers(reference.joints if reference else ())
        return ScrewAxesShape(
            columns=numbered(6),
            rows=[str(number) for number in numbers],
            frame=self.frame,
            directions=self.directions,
        )


# --- Answer kind ``rotation``: a rotation matrix


class StepSpec(StrictModel):
    """One step of a composite rotation."""

    axis: Literal["x", "y", "z"]
    """The axis of the step."""
    angle: Formula
    """The angle of the step."""
    about: Literal["fixed", "moving"] = "moving"
    """The frame of the axis: the fixed or the moving one."""


class RotationSpec(PosePartSpec):
    """A rotation matrix, 3×3: of a pose of the robot, or given by its entries or by steps."""

    answer_fields: ClassVar[tuple[str, ...]] = ("expected", "steps")

    kind: Literal["rotation"]
    expected: tuple[Triple, Triple, Triple] | None = None
    """The entries of the rotation, row by row, instead of the robot's rotation or ``steps``."""
    steps: Annotated[list[StepSpec], Field(min_length=1, max_length=6)] | None = None
    """The steps of the rotation in order, instead of the robot's rotation or ``expected``."""

    def formulas(self) -> WrittenFormulas | None:
        """The entries or the angles of the steps, if the file gives them."""
        if self.expected is not None:
            return matrix_of("expected", self.expected, ROTATION, check_rotation)
        if self.steps is not None:
            angles = [step.angle for step in self.steps]
            return list_of("steps[{j}].angle", angles, ["angle"] * len(angles))
        return None

    def shape(self, _: Reference | None) -> MatrixShape:
        """The shape of a 3×3 matrix."""
        return matrix_shape(3, 3)


# --- Answer kind ``position``: the coordinates of a point, such as the end effector's


class PositionSpec(PosePartSpec):
    """The coordinates of a point: a frame's origin, or a point given in the file."""

    kind: Literal["position"]
    coordinates: Annotated[
        str,
        StringConstraints(pattern=r"^(x?y?z?)$", min_length=2),
        advice(template('write the coordinates that are asked for, such as "xy" or "xyz"')),
    ] = "xyz"
    """The required coordinates in order."""
    expected: list[Formula] | None = None
    """The right coordinates, instead of those of the robot."""

    def formulas(self) -> WrittenFormulas | None:
        """The coordinates, if the file gives them."""
        if self.expected is None:
            return None
        return list_of("expected[{j}]", self.expected, ["length"] * len(self.expected))

    def shape(self, _: Reference | None) -> ListShape:
        """The shape of the answer: a list of lengths."""
        return list_shape((letter, "length") for letter in self.coordinates)

    @model_validator(mode="after")
    def _one_for_each(self) -> "PositionSpec":
        if self.expected is not None and len(self.expected) != len(self.coordinates):
            raise ValueError(
                say(
                    "expected has {count} entries, but coordinates are {coordinates!r}; write "
                    "one for each",
                    count=len(self.expected),
                    coordinates=self.coordinates,
                )
            )
        return self


# --- Answer kind ``matrix``: any matrix, such as a Jacobian


class MatrixSpec(PartSpec):
    """Any matrix up to 6×6."""

    kind: Literal["matrix"]
    expected: Annotated[
        list[Annotated[list[Formula], Field(min_length=1, max_length=6)]],
        Field(min_length=1, max_length=6),
    ]
    """The entries, row by row."""
    quantity: Kind | list[Kind] = "number"
    """The quantity of the entries (angle, length or plain number): one word for all, or one for
    each column."""

    @property
    def quantities(self) -> tuple[tuple[Kind, ...], ...]:
        """The quantity of each entry: a length, an angle or a number."""
        columns = len(self.expected[0])
        row = (self.quantity,) * columns if isinstance(self.quantity, str) else self.quantity
        return (tuple(row),) * len(self.expected)

    def formulas(self) -> WrittenFormulas:
        """The formulas of the matrix's entries."""
        return matrix_of("expected", self.expected, self.quantities)

    def shape(self, _: Reference | None) -> MatrixShape:
        """The shape of the expected matrix."""
        return matrix_shape(len(self.expected), len(self.expected[0]))

    @model_validator(mode="after")
    def _is_rectangular(self) -> "MatrixSpec":
        columns = len(self.expected[0])
        for i, row in enumerate(self.expected):
            if len(row) != columns:
                raise ValueError(
                    say(
                        "row {number} of expected has {count} entries, row 1 has {columns}; write "
                        "rows of one length",
                        number=i + 1,
                        count=len(row),
                        columns=columns,
                    )
                )
        if not isinstance(self.quantity, str) and len(self.quantity) != columns:
            raise ValueError(
                say(
                    "quantity names {count} columns, but expected has {columns}; write one for "
                    "all or one for each column",
                    count=len(self.quantity),
                    columns=columns,
                )
            )
        return self


# --- Answer kind ``link_transforms``: the transform of each row of a table


class LinkTransformsShape(AnswerShape):
    """A list of 4×4 matrices, one for each row of the table; report rows are "A1.1" and so on."""

    posted: ClassVar[str] = "a list of matrices"

    form: Literal["link_transforms"] = "link_transforms"
    matrices: list[str]
    rows: list[str]
    columns: list[str]
    convention: Convention
    frames: GivenOrFree

    def _clauses(self) -> Iterator[str]:
        size = f"{len(self.rows)} rows and {len(self.columns)} columns"
        yield f"a list of the matrices {', '.join(self.matrices)}, each of {size}"
        yield f"{self.convention} convention"
        yield from choices(frames=self.frames)


class LinkTransformsSpec(TablePartSpec):
    """The link transforms A_1 … A_n, one for each row of the robot's table."""

    holds_links: ClassVar[bool] = True

    kind: Literal["link_transforms"]
    convention: Convention
    """"standard" (distal) or "modified" (proximal)."""
    frames: GivenOrFree = "given"
    """The link frames: "free" accepts the transforms of any valid table, or, if the part follows a
    table, of the student's own."""

    def shape(self, reference: Reference | None) -> LinkTransformsShape:
        """The shape: the names of the matrices and their size."""
        assert isinstance(reference, Robot)
        return LinkTransformsShape(
            matrices=[f"A{row}" for row in reference.tables[self.convention].labels],
            rows=numbered(4),
            columns=numbered(4),
            convention=self.convention,
            frames=self.frames,
        )


# --- Answer kind ``frames``: the frames that the student places on the joint axes


# The labels of a frame's cells.
COORDINATES = ("origin_x", "origin_y", "origin_z")
FRAME_CELLS = ("axis", "z", *COORDINATES, "x")


class FramesShape(AnswerShape):
    """The shape of a list of frames on joint axes, described in the base frame."""

    posted: ClassVar[str] = '`[{"axis": 2, "z": "+y", "origin": ["0", "d1", "0"], "x": "+x"}, …]`'

    form: Literal["frames"] = "frames"
    columns: list[str]
    rows: list[str]
    joints: list[str]
    convention: Convention

    def _clauses(self) -> Iterator[str]:
        rows = ", ".join(self.rows)
        yield f"a row for each of the frames {rows}: its joint axis, z, origin and x"
        yield "in the base frame"
        yield f"{self.convention} convention"
        yield "with all joint variables 0"


class FramesSpec(TablePartSpec):
    """The frames on the joint axes, between the base frame and the tool frame.

    Directions and points are in the base frame, with all joint variables 0. Every choice by the
    rules of the convention is right. The base frame and the tool frame are given.
    """

    kind: Literal["frames"]
    convention: Convention
    """"standard" (distal): z of frame i is along the axis of joint i + 1. "modified" (proximal): z
    of frame i is along the axis of joint i."""

    def check_reference(self, field: str, reference: Reference | None) -> None:
        """Raise FieldError unless the robot has frames to place, all on joint axes."""
        super().check_reference(field, reference)
        assert isinstance(reference, Robot)
        fixed = len(reference.tables[self.convention].rows) - len(reference.joints)
        if fixed > (self.convention is Convention.MODIFIED):
            raise FieldError(
                f"{field}.convention",
                say(
                    "the robot's {convention} table has a fixed row whose frame is on no joint "
                    "axis; ask for the frames of the other convention",
                    convention=self.convention.value,
                ),
            )
        if not frame_labels(reference, self.convention):
            raise FieldError(f"{field}.kind", say("the robot has no frame between base and tool"))

    def shape(self, reference: Reference | None) -> FramesShape:
        """The shape of a list of frames."""
        assert isinstance(reference, Robot)
        return FramesShape(
            columns=list(FRAME_CELLS),
            rows=frame_labels(reference, self.convention),
            joints=[str(joint.index) for joint in reference.joints],
            convention=self.convention,
        )


def frame_labels(robot: Robot, convention: Convention) -> list[str]:
    """Return the numbers of the frames between the base frame and the tool frame."""
    first = robot.joints[0].index
    rows = len(robot.tables[convention].rows)
    return [str(first + i) for i in range(rows - 1)]


# --- Answer kind ``euler_angles``: three angles that describe a rotation


class EulerAnglesSpec(PosePartSpec):
    """Three angles that describe a rotation; every triple for the same rotation is right."""

    pasted_as = "angles"

    kind: Literal["euler_angles"]
    sequence: Literal[
        "RPY", "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ"
    ]
    """The axes in the order of the rotations. "RPY" is Rz(α) Ry(β) Rx(γ), answered as α, β, γ: the
    same as "ZYX" about moving axes."""
    axes: Literal["moving", "fixed"] = "moving"
    """The frame of the axes: the moving or the fixed one."""
    expected: Triple | None = None
    """One right triple of angles, instead of the robot's orientation."""

    @property
    def turns(self) -> str:
        """The letters of the three rotation axes, such as "ZYX"."""
        return "ZYX" if self.sequence == "RPY" else self.sequence

    def formulas(self) -> WrittenFormulas | None:
        """The angles, if the file gives them."""
        if self.expected is None:
            return None
        return list_of("expected[{j}]", self.expected, ["angle"] * 3)

    def shape(self, _: Reference | None) -> ListShape:
        """The shape of a list of three angles about the axes."""
        listed = list_shape((f"about {axis.lower()}", "angle") for axis in self.turns)
        return listed.model_copy(update={"sequence": self.sequence, "axes": self.axes})

    @model_validator(mode="after")
    def _rpy_is_about_moving_axes(self) -> "EulerAnglesSpec":
        if self.sequence == "RPY" and self.axes == "fixed":
            raise ValueError(
                say(
                    'sequence "RPY" is answered as Rz(α) Ry(β) Rx(γ); write sequence = "XYZ" '
                    'with axes = "fixed" for roll, pitch, yaw in this order'
                )
            )
        return self


# --- Answer kind ``dh_table``: a Denavit-Hartenberg table of the robot


# The meaning of an empty cell: unread, or 0.
EmptyCells: TypeAlias = Literal["unread", "zero"]

_CHOICES = {"frames", "base", "tool", "directions"}


class DhTableShape(AnswerShape):
    """The shape of a table, and which of its frames are given or free."""

    posted: ClassVar[str] = '`{"rows": [{"a", "alpha", "d", "theta"}, …]}`'

    form: Literal["dh_table"] = "dh_table"
    columns: list[str]
    rows: list[str] = Field(
        description="Row labels in order: joint numbers, `e` for the end effector. If either "
        "convention is accepted, those of the longer table."
    )
    convention: Convention | Literal["either"]
    frames: GivenOrFree
    base: GivenOrFree
    tool: GivenOrFree
    directions: GivenOrFree
    empty_cells: EmptyCells
    given: dict[str, list[str]] = Field(
        default_factory=dict,
        description="The cells of the given rows, by row label, in the order of the columns. An "
        "answer may leave these rows out; they earn nothing.",
    )

    def _clauses(self) -> Iterator[str]:
        rows, columns = ", ".join(self.rows), ", ".join(self.columns)
        yield f"a table with the rows {rows} and the columns {columns}"
        yield f"{self.convention} convention"
        yield from choices(**self.model_dump(include=_CHOICES))
        if self.given:
            named = "row" if len(self.given) == 1 else "rows"
            yield f"{named} {', '.join(self.given)} given"
        if self.empty_cells == "zero":
            yield "empty cells are 0"


class DhTableSpec(TablePartSpec):
    """The Denavit-Hartenberg table of the robot.

    If ``frames`` are free, the base frame, the tool frame and the positive directions of the joints
    may be free, too.
    """

    pasted_as = "table"

    kind: Literal["dh_table"]
    convention: Convention | Literal["either"]
    """"standard" (distal) or "modified" (proximal). With "either", the answer names its
    convention, or else the one that fits it best is used."""
    frames: GivenOrFree = "given"
    """The link frames: "given" accepts only those of the reference, "free" every valid choice."""
    base: GivenOrFree = "given"
    """The base frame: "given" or "free"."""
    tool: GivenOrFree = "given"
    """The tool frame: "given" or "free"."""
    directions: GivenOrFree = "given"
    """The positive directions of the joints: "given" or "free"."""
    empty_cells: EmptyCells = "unread"
    """The meaning of an empty cell or a dash: "unread" earns nothing, "zero" means 0."""
    given: tuple[Annotated[int, Field(ge=1, strict=True), NotBool], ...] = ()
    """The rows that are given, counted from 1, such as [1, 2]. The form shows them filled in. They
    earn nothing: the other rows share the points."""

    def check_reference(self, field: str, reference: Reference | None) -> None:
        """Raise FieldError if the file gives a row that the robot's table does not have."""
        super().check_reference(field, reference)
        if not self.given:
            return
        assert isinstance(reference, Robot)
        if self.convention is not reference.convention:
            raise FieldError(
                f"{field}.given",
                say(
                    "are rows of the robot's own table, which is {convention}; write convention "
                    '= "{convention}"',
                    convention=reference.convention.value,
                ),
            )
        rows = len(reference.tables[reference.convention].rows)
        if max(self.given) > rows or len(self.given) == rows:
            raise FieldError(
                f"{field}.given",
                say("leave at least one of the {rows} rows to the student", rows=rows),
            )

    def shape(self, reference: Reference | None) -> DhTableShape:
        """The shape of the table in the convention of the part."""
        assert isinstance(reference, Robot)
        labels = self.asked_table(reference).labels
        chosen = self.model_dump(include=_CHOICES)
        return DhTableShape(
            columns=list(COLUMNS),
            rows=list(labels),
            convention=self.convention,
            empty_cells=self.empty_cells,
            given=self._given_cells(reference),
            **chosen,
        )

    def asked_table(self, robot: Robot) -> ReferenceTable:
        """Return the robot's table in the part's convention."""
        if isinstance(self.convention, Convention):
            return robot.tables[self.convention]
        # The part accepts both conventions.
        return max(robot.tables.values(), key=lambda table: len(table.rows))

    def _given_cells(self, robot: Robot) -> dict[str, list[str]]:
        table = robot.tables[robot.convention]
        return {
            table.labels[i - 1]: [cell.source for cell in table.rows[i - 1]] for i in self.given
        }

    @model_validator(mode="after")
    def _given_rows_have_given_frames(self) -> "DhTableSpec":
        if list(self.given) != sorted(set(self.given)):
            raise ValueError(say("write each number in given once, in order"))
        if self.given and self.frames == "free":
            raise ValueError(
                say('given rows need frames = "given", because they say where frames lie')
            )
        return self

    @model_validator(mode="after")
    def _choices_go_together(self) -> "DhTableSpec":
        free = [name for name in ("base", "tool", "directions") if getattr(self, name) == "free"]
        if self.frames == "given" and free:
            raise ValueError(
                say(
                    '{name} = "free" says nothing where frames = "given"; write frames = "free" '
                    "or leave {name} out",
                    name=free[0],
                )
            )
        return self


# --- Answer kind ``find_slip``: the one mistake (slip) in a given Denavit-Hartenberg table


# The codes of the misconceptions that a table can be given.
SlipName: TypeAlias = Literal[
    "sign",
    "distance_left_out",
    "distance_extra",
    "degrees_as_radians",
    "radians_as_degrees",
    "quarter_turn",
    "half_turn",
    "unknown_symbol",
    "joint_variable_absent",
    "joint_variable_missing",
    "joint_variable_sign",
    "joint_variable_index",
    "joint_variable_doubled",
    "joint_variable_column",
    "joint_variable_extra",
    "wrong_quantity",
    "columns_swapped",
    "column_sign",
    "row_order",
    "lengths_exchanged",
    "link_columns_shifted",
    "other_convention",
    "joint_numbering",
    "joint_numbering_by_kind",
]
_LARGEST = 999_999


class FindSlipShape(AnswerShape):
    """The shape of the answer: a mark on the slip, and the table without it."""

    posted: ClassVar[str] = (
        '`{"marked": "2.alpha", "table": {"rows": [{"a", "alpha", "d", "theta"}, …]}}`'
    )

    form: Literal["find_slip"] = "find_slip"
    columns: list[str]
    rows: list[str] = Field(
        description="Row labels in order: joint numbers, `e` for the end effector."
    )
    convention: Convention
    frames: GivenOrFree
    given: list[list[str]] = Field([], description="The table with one slip, row by row.")

    def _clauses(self) -> Iterator[str]:
        rows, columns = ", ".join(self.rows), ", ".join(self.columns)
        yield f"a mark on the slip in a table with the rows {rows} and the columns {columns}"
        yield "the table without the slip"
        yield f"{self.convention} convention"
        yield from choices(frames=self.frames)
        if self.given:
            yield f"given is {' / '.join(', '.join(row) for row in self.given)}"


class FindSlipSpec(TablePartSpec):
    """A Denavit-Hartenberg table with one slip, which the student marks and mends.

    The marked cells are worth half of the points, the mended table the other half.
    """

    pasted_as = "table"

    kind: Literal["find_slip"]
    convention: Convention
    """"standard" (distal) or "modified" (proximal)."""
    seed: Annotated[int, Field(ge=0, le=_LARGEST, strict=True), NotBool] = 0
    """The number that draws the slip. Another seed draws another slip."""
    slip: SlipName | None = None
    """The code of the misconception that the table shows, such as "sign". Without it, the seed
    draws one of all that fit the robot."""
    frames: GivenOrFree = "free"
    """The link frames of the mended table: "free" accepts every valid choice, "given" only those
    of the reference."""

    @property
    def table(self) -> DhTableSpec:
        """Return an equivalent part of the kind ``dh_table``."""
        return DhTableSpec(
            id=self.id,
            title=self.title,
            points=self.points,
            kind="dh_table",
            convention=self.convention,
            frames=self.frames,
        )

    def shape(self, reference: Reference | None) -> FindSlipShape:
        """Return the shape of an answer, without the cells of the given table."""
        assert isinstance(reference, Robot)
        return FindSlipShape(
            columns=list(COLUMNS),
            rows=list(reference.tables[self.convention].labels),
            convention=self.convention,
            frames=self.frames,
        )

    @model_validator(mode="after")
    def _is_marked_by_halves(self) -> "FindSlipSpec":
        if self.marking not in ("content", "whole"):
            raise ValueError(
                say(
                    'marking = "{marking}" is not possible here, because marking and mending are '
                    'each worth half; leave marking out or write marking = "whole"',
                    marking=self.marking,
                )
            )
        return self


# --- Answer kind ``dh_row``: the DH row of a transform, or "none" if it has no row


class DhRowShape(AnswerShape):
    """The shape of a DH row; `{"none": true}` means that the transform has no row."""

    posted: ClassVar[str] = (
        '`{"a", "alpha", "d", "theta"}`, or `{"none": true}` where the transform has none'
    )

    form: Literal["dh_row"] = "dh_row"
    columns: list[str]
    convention: Convention

    def _clauses(self) -> Iterator[str]:
        yield f"one row with {', '.join(self.columns)}, or none"
        yield f"{self.convention} convention"


class DhRowSpec(PartSpec):
    """The DH row of a given transform, or "none" if it has no row."""

    answer_fields: ClassVar[tuple[str, ...]] = ("transform",)
    # Two transforms without a row have equal answers, but are different tasks.
    compared_by_formulas: ClassVar[bool] = True

    kind: Literal["dh_row"]
    convention: Convention = Convention.STANDARD
    """"standard" (distal) or "modified" (proximal)."""
    transform: Homogeneous
    """The entries of the transform, row by row."""

    def formulas(self) -> WrittenFormulas:
        """The formulas of the transform's entries."""
        return replace(transform_of("transform", self.transform), check=self._check)

    def _check(self, field: str, numbers: Numbers) -> None:
        check_transform(field, numbers)
        transform = np.moveaxis(numbers, -1, 0)
        for condition in (dh1_residual, dh2_residual):
            residual = condition(transform, self.convention)
            holds = np.abs(residual) < EXACT
            if holds.any() and not holds.all():
                raise FieldError(
                    field, say("has a DH row for some values of its symbols and none for others")
                )

    def shape(self, _: Reference | None) -> DhRowShape:
        """Return the shape of an answer: one row, or "none"."""
        return DhRowShape(columns=list(COLUMNS), convention=self.convention)


# --- The answer kinds in exercise files: the subclass of ``PartSpec`` of each kind


SPECS: Final[Mapping[str, type[PartSpec]]] = {
    "dh_row": DhRowSpec,
    "dh_table": DhTableSpec,
    "euler_angles": EulerAnglesSpec,
    "find_slip": FindSlipSpec,
    "frames": FramesSpec,
    "link_transforms": LinkTransformsSpec,
    "matrix": MatrixSpec,
    "position": PositionSpec,
    "rotation": RotationSpec,
    "screw_axes": ScrewAxesSpec,
    "transform": TransformSpec,
    "vector": VectorSpec,
}

_SHAPES: Final[Mapping[str, type[AnswerShape]]] = {
    kind: get_type_hints(spec.shape)["return"] for kind, spec in SPECS.items()
}

if TYPE_CHECKING:
    AnyPartSpec = PartSpec
    AnyShape = AnswerShape
else:
    # Discriminated by kind, so that faults are reported for the intended model only.
    AnyPartSpec = Annotated[reduce(or_, SPECS.values()), Field(discriminator="kind")]
    AnyShape = Annotated[reduce(or_, dict.fromkeys(_SHAPES.values())), Field(discriminator="form")]


def posted_forms() -> str:
    """Describe the JSON form of each kind of answer: "`transform`: a list of rows, …"."""
    kinds: dict[str, list[str]] = {}
    for kind, shape in _SHAPES.items():
        kinds.setdefault(shape.posted, []).append(f"`{kind}`")
    return "; ".join(f"{', '.join(names)}: {form}" for form, names in kinds.items())
