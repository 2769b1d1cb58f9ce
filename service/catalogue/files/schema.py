"""The shape of an exercise file, checked by pydantic."""

from typing import Annotated, Literal

from pydantic import (
    Discriminator,
    Field,
    JsonValue,
    StrictBool,
    StringConstraints,
    Tag,
    model_validator,
)

from service.catalogue.attempts import AttemptsSpec
from service.catalogue.feedback_level import FeedbackLevel
from service.catalogue.files.fields import (
    Formula,
    Four,
    Homogeneous,
    LooseText,
    Screw,
    StrictModel,
    Text,
    advice,
)
from service.catalogue.parts import SPECS, AnyPartSpec
from service.expressions import Kind
from service.kinematics.dh import Convention

Structure = Annotated[
    str,
    StringConstraints(pattern=r"^[RP]{1,10}$"),
    advice("write one letter for each joint, R if it turns and P if it slides, at most 10"),
]
Joints = Annotated[list[Text], Field(min_length=1)]


class SymbolSpec(StrictModel):
    """A letter that may stand in an answer, and the range that its values are drawn from.

    A joint variable needs no entry, but may have one that says more about it.
    """

    kind: Kind
    """Whether it is an angle, a length or a plain number."""
    description: Text
    """Its meaning, as students see it."""
    unit: LooseText = ""
    """Its unit, as students see it; without one "rad" for an angle and "m" for a length."""
    range: tuple[Formula, Formula] | None = None
    """The least and the greatest test value; without it −π to π for an angle, 0.2 to 1 for a
    length, 0.5 to 2 for a number."""


class RobotSpec(StrictModel):
    """The reference robot by its Denavit-Hartenberg table."""

    structure: Structure
    """One letter for each joint: R turns, P slides; at most 10."""
    convention: Convention
    """The convention of the table: "standard" (distal) or "modified" (proximal)."""
    joints: Joints
    """The joint variables in order. A number in the first is the number of the first joint."""
    table: list[Four]
    """A row [a, alpha, d, theta] for each joint, and one more where a fixed tool row "e" follows.
    The joint variable stands in theta (R) or d (P), alone or plus a constant; every other cell is
    constant."""

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


class ScrewRobotSpec(StrictModel):
    """The reference robot by its product of exponentials."""

    structure: Structure
    """One letter for each joint: R turns, P slides; at most 10."""
    joints: Joints
    """The joint variables in order. A number in the first is the number of the first joint."""
    home: Homogeneous
    """The pose of the tool in the base frame with all joint variables 0, 4×4, row by row."""
    screws: list[Screw]
    """The screw axis (ω; v) of each joint with all joint variables 0, seen from the base frame
    (the space frame)."""

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


def _form_of(robot: object) -> str:
    by_screws = isinstance(robot, ScrewRobotSpec) or (
        isinstance(robot, dict) and not robot.keys().isdisjoint({"screws", "home"})
    )
    return "screws" if by_screws else "table"


# The key that is written decides, so that a fault is reported for the intended form only.
AnyRobotSpec = Annotated[
    Annotated[RobotSpec, Tag("table")] | Annotated[ScrewRobotSpec, Tag("screws")],
    Discriminator(_form_of),
]


class ExpectSpec(StrictModel):
    """The result that one part must get: at least one key; a key left out allows any value."""

    points: Annotated[float, Field(ge=0, strict=True)] | None = None
    """The points that it must get."""
    verdict: Literal["correct", "partial", "incorrect", "unreadable", "missing"] | None = None
    """The verdict that it must get."""
    codes: list[Text] | None = None
    """The codes that must be among those of the messages."""
    follow_through: StrictBool | None = None
    """Whether it must earn its points as following from the student's own earlier answer."""

    @model_validator(mode="after")
    def _expects_something(self) -> "ExpectSpec":
        if not self.model_fields_set:
            raise ValueError("expects nothing; write points, verdict, codes or follow_through")
        return self


class CheckSpec(StrictModel):
    """One answer to the exercise, graded whenever the file is checked."""

    title: Text
    """A few words on what is tried."""
    kind: Literal["right", "equivalent", "wrong"]
    """"right" and "equivalent" must get full marks unless ``expect`` says otherwise; "wrong" must
    lose some, as ``expect`` says."""
    answers: Annotated[dict[str, JsonValue], Field(min_length=1)]
    """An answer for each part answered, by the part's id, as a submission has it; a table or
    matrix may be pasted text."""
    angle_unit: Literal["radians", "degrees"] = "radians"
    """The unit of bare numbers where an angle is asked for."""
    expect: dict[str, ExpectSpec] = Field({})
    """The result that a part must get, by the part's id."""

    @model_validator(mode="after")
    def _says_what_is_wrong(self) -> "CheckSpec":
        if self.kind == "wrong" and not self.expect:
            raise ValueError(
                "a wrong answer needs an expectation, or it may be wrong for another reason than "
                'you think; write expect.PART = { points = …, verdict = "…", codes = ["…"] }'
            )
        return self


class ViewSpec(StrictModel):
    """Where the figure is seen from; without it from where the mechanism is plainest."""

    azimuth: Annotated[float, Field(ge=-360, le=360, allow_inf_nan=False)]
    """Degrees about z0 from x0 to the viewer: -60 has x0 point to the right, 30 has y0."""
    elevation: Annotated[float, Field(ge=-85, le=85, allow_inf_nan=False)]
    """Degrees by which the viewer is above the plane of x0 and y0."""


class ExerciseSpec(StrictModel):
    """One exercise file."""

    title: Text
    """The title of the exercise."""
    source: Text
    """Where the exercise comes from, with a page; students see it."""
    statement: Text
    """All that a student has to know, without a figure. Markdown; ``$…$`` is LaTeX maths."""
    robot: AnyRobotSpec | None = None
    """The reference robot; without one every part holds its answer."""
    symbols: dict[Text, SymbolSpec] = Field({})
    """The letters that may stand in an answer, by their names."""
    feedback: FeedbackLevel | Annotated[list[FeedbackLevel], Field(min_length=1)] = (
        FeedbackLevel.HINTS
    )
    """The most that a student is told: "full" (hints and corrections), "hints" (what to look at,
    never the value), "verdicts" (right and wrong, and what could not be read) or "score" (bare
    marks, and what could not be read). Where attempts are recorded it may be a list, one level for
    each attempt, the last one for all later ones; whoever grades without recording gets the
    first."""
    attempts: AttemptsSpec = AttemptsSpec()
    """How often and until when recorded attempts are taken: a table ``[attempts]``."""
    view: ViewSpec | None = None
    """Where the figure of the robot is seen from."""
    parts: Annotated[list[AnyPartSpec], Field(min_length=1)]
    """The questions, one ``[[parts]]`` for each."""
    checks: list[CheckSpec] = Field([])
    """Answers to try whenever the file is checked, one ``[[checks]]`` for each."""

    @model_validator(mode="after")
    def _parts_fit_together(self) -> "ExerciseSpec":
        ids = [part.id for part in self.parts]
        repeated = sorted({part_id for part_id in ids if ids.count(part_id) > 1})
        if repeated:
            raise ValueError(f"two parts share the id {repeated[0]!r}; give each its own")
        if self.view is not None and self.robot is None:
            raise ValueError("view says where the robot is seen from; leave it out without a robot")
        earlier: set[str] = set()
        for part in self.parts:
            if part.follows is not None and part.follows not in earlier:
                kinds = [kind for kind, spec in SPECS.items() if spec.can_be_followed]
                raise ValueError(
                    f"part {part.id!r} follows {part.follows!r}, which is no earlier part of kind "
                    f"{', '.join(kinds)}; name one, or leave follows out"
                )
            if part.can_be_followed:
                earlier.add(part.id)
        return self
