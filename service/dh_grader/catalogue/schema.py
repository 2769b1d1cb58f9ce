"""The pydantic models of an exercise file, and the check of its translations."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Annotated, Final, Literal

from pydantic import (
    Discriminator,
    Field,
    JsonValue,
    StrictBool,
    StringConstraints,
    Tag,
    model_validator,
)

from dh_grader.catalogue.kinds import SPECS, AnyPartSpec
from dh_grader.catalogue.robot import FieldError
from dh_grader.catalogue.schema_fields import (
    AttemptsSpec,
    ExerciseLevel,
    FeedbackLevel,
    Formula,
    Four,
    Homogeneous,
    LooseText,
    Screw,
    StrictModel,
    Text,
    advice,
)
from dh_grader.expressions import Kind
from dh_grader.kinematics import Convention
from dh_grader.regex import regex
from dh_grader.translations import say, template

# --- The pydantic models of an exercise file


Structure = Annotated[
    str,
    StringConstraints(pattern=r"^[RP]{1,10}$"),
    advice(
        template("write one letter for each joint, R if it turns and P if it slides, at most 10")
    ),
]
Joints = Annotated[list[Text], Field(min_length=1)]


class SymbolSpec(StrictModel):
    """A symbol that answers may contain, and the range of its test values.

    A joint variable needs no entry, but may have one to set its range and description.
    """

    kind: Kind
    """The quantity of the symbol: an angle, a length or a plain number."""
    description: Text
    """The meaning that students see."""
    unit: LooseText = ""
    """The unit that students see. Default: "rad" for an angle and "m" for a length."""
    range: tuple[Formula, Formula] | None = None
    """The least and the greatest test value. Default: −π to π for an angle, 0.2 to 1 for a
    length, 0.5 to 2 for a number."""


class RobotSpec(StrictModel):
    """The reference robot, given by its Denavit-Hartenberg table."""

    structure: Structure
    """One letter for each joint: R turns, P slides; at most 10."""
    convention: Convention
    """The convention of the table: "standard" (distal) or "modified" (proximal)."""
    joints: Joints
    """The joint variables in order. A number in the first is the number of the first joint."""
    table: list[Four]
    """A row [a, alpha, d, theta] for each joint, and optionally a fixed tool row "e". The joint
    variable is in theta (R) or d (P), alone or plus a constant; all other cells are constant."""

    @model_validator(mode="after")
    def _fits_together(self) -> "RobotSpec":
        joints = len(self.structure)
        if len(self.joints) != joints:
            raise ValueError(
                say(
                    "joints names {count} variables, but structure {structure!r} has {joints} "
                    "joints; write one variable for each",
                    count=len(self.joints),
                    structure=self.structure,
                    joints=joints,
                )
            )
        if len(self.table) not in (joints, joints + 1):
            raise ValueError(
                say(
                    "table has {count} rows; write {joints} (one for each joint) or {more} (with "
                    "a fixed end-effector row)",
                    count=len(self.table),
                    joints=joints,
                    more=joints + 1,
                )
            )
        return self


class ScrewRobotSpec(StrictModel):
    """The reference robot, given by its product of exponentials."""

    structure: Structure
    """One letter for each joint: R turns, P slides; at most 10."""
    joints: Joints
    """The joint variables in order. A number in the first is the number of the first joint."""
    home: Homogeneous
    """The pose of the tool in the base frame with all joint variables 0, 4×4, row by row."""
    screws: list[Screw]
    """The screw axis (ω; v) of each joint with all joint variables 0, in the base frame (space
    frame)."""

    @model_validator(mode="after")
    def _fits_together(self) -> "ScrewRobotSpec":
        joints = len(self.structure)
        for name, count in (("joints", len(self.joints)), ("screws", len(self.screws))):
            if count != joints:
                raise ValueError(
                    say(
                        "{name} has {count} entries, but structure {structure!r} has {joints} "
                        "joints; write one for each",
                        name=name,
                        count=count,
                        structure=self.structure,
                        joints=joints,
                    )
                )
        return self


def _form_of(robot: object) -> str:
    by_screws = isinstance(robot, ScrewRobotSpec) or (
        isinstance(robot, dict) and not robot.keys().isdisjoint({"screws", "home"})
    )
    return "screws" if by_screws else "table"


# The keys in the file select the model, so that faults are reported for the intended form only.
AnyRobotSpec = Annotated[
    Annotated[RobotSpec, Tag("table")] | Annotated[ScrewRobotSpec, Tag("screws")],
    Discriminator(_form_of),
]


class ExpectSpec(StrictModel):
    """The result that one part must get. At least one key is required; others allow any value."""

    points: Annotated[float, Field(ge=0, strict=True)] | None = None
    """The points of the part."""
    verdict: Literal["correct", "partial", "incorrect", "unreadable", "missing"] | None = None
    """The verdict of the part."""
    codes: list[Text] | None = None
    """Codes that messages of the part must have."""
    follow_through: StrictBool | None = None
    """True if the part must earn its points because it follows from the student's own earlier
    answer; false if it must not."""

    @model_validator(mode="after")
    def _expects_something(self) -> "ExpectSpec":
        if not self.model_fields_set:
            raise ValueError(say("expects nothing; write points, verdict, codes or follow_through"))
        return self


class CheckSpec(StrictModel):
    """An answer that is graded whenever the file is checked."""

    title: Text
    """A short description of the check."""
    kind: Literal["right", "equivalent", "wrong"]
    """"right" and "equivalent" must get full marks unless ``expect`` says otherwise; "wrong" must
    lose some, as ``expect`` says."""
    answers: Annotated[dict[str, JsonValue], Field(min_length=1)]
    """The answers by part id, as in a submission; a table or matrix may be pasted text."""
    angle_unit: Literal["radians", "degrees"] = "radians"
    """The unit of angles without a unit."""
    expect: dict[str, ExpectSpec] = Field({})
    """The expected results by part id."""

    @model_validator(mode="after")
    def _says_what_is_wrong(self) -> "CheckSpec":
        if self.kind == "wrong" and not self.expect:
            raise ValueError(
                say(
                    "a wrong answer needs an expectation, or it may be wrong for another reason "
                    'than you think; write expect.PART = {{ points = …, verdict = "…", codes = '
                    '["…"] }}'
                )
            )
        return self


class ViewSpec(StrictModel):
    """The viewpoint of the figure. Default: the direction that shows the mechanism best."""

    azimuth: Annotated[float, Field(ge=-360, le=360, allow_inf_nan=False)]
    """Degrees about z0 from x0 to the viewer. With -60, x0 points to the right; with 30, y0."""
    elevation: Annotated[float, Field(ge=-85, le=85, allow_inf_nan=False)]
    """The viewer's elevation above the plane of x0 and y0, in degrees."""


class PartTextsSpec(StrictModel):
    """The texts of a part in another language. Missing texts are shown in English."""

    title: Text | None = None
    """The title that students see."""
    prompt: Text | None = None
    """The task in one or more sentences."""


class TranslationSpec(StrictModel):
    """The texts of the exercise in another language. Missing texts are shown in English."""

    title: Text | None = None
    """The title of the exercise."""
    summary: Text | None = None
    """One line for the catalogue."""
    statement: Text | None = None
    """The whole task in words."""
    symbols: dict[Text, Text] = Field({})
    """The meanings of symbols, by name."""
    parts: dict[Text, PartTextsSpec] = Field({})
    """The texts of parts, by part id: a table ``[translations.de.parts.PART]`` for each."""


class ExerciseSpec(StrictModel):
    """One exercise file."""

    title: Text
    """The title of the exercise."""
    source: Text
    """The source of the exercise, with a page; students see it at the foot of the exercise."""
    level: ExerciseLevel | None = None
    """The level in the catalogue: "start" (Start here), "basics", "arms" or "industrial". Exercises
    without a level come last."""
    order: Annotated[int, Field(ge=1, strict=True)] | None = None
    """The place within the level. Exercises without one come last in their level."""
    minutes: Annotated[int, Field(ge=1, strict=True)] | None = None
    """The minutes that a student needs the first time."""
    summary: LooseText = ""
    """One line for the catalogue: what the robot is, or what is asked for."""
    keywords: list[Text] = Field([])
    """More words by which the search of the catalogue finds the exercise."""
    statement: Text
    """The whole task in words, so that it needs no figure. Markdown; ``$…$`` is LaTeX maths."""
    robot: AnyRobotSpec | None = None
    """The reference robot. Without one, every part gives its own answer."""
    symbols: dict[Text, SymbolSpec] = Field({})
    """The symbols that answers may contain, by name."""
    decimal_comma: StrictBool = False
    """True if answers may have a decimal comma: ``1,5`` is 1.5, and a semicolon separates the
    arguments in ``atan2(1,5; 2)``. A point is a decimal point all the same. The formulas of this
    file have points."""
    feedback: FeedbackLevel | Annotated[list[FeedbackLevel], Field(min_length=1)] = (
        FeedbackLevel.HINTS
    )
    """The highest feedback level for students: "full" (hints and corrections), "hints" (hints
    without values), "verdicts" (right and wrong entries) or "score" (only marks). All levels name
    unreadable entries. A list has a level for each recorded attempt: the last one is for all later
    attempts, and the first one also for gradings without recording."""
    attempts: AttemptsSpec = AttemptsSpec()
    """The rules for recorded attempts: a table ``[attempts]``."""
    view: ViewSpec | None = None
    """The viewpoint of the robot's figure."""
    vary: dict[Text, JsonValue] | None = None
    """What differs between variants: a table ``[vary]`` with a list of choices or a range for each
    name, and optionally ``conditions`` and ``deployed``. All texts of the file may contain a name
    in double braces."""
    parts: Annotated[list[AnyPartSpec], Field(min_length=1)]
    """The questions, one ``[[parts]]`` for each."""
    checks: list[CheckSpec] = Field([])
    """Answers that are graded whenever the file is checked, one ``[[checks]]`` for each."""
    translations: dict[Text, TranslationSpec] = Field({})
    """The texts in other languages: a table ``[translations.de]`` for German, and also "es", "fr"
    and "zh". A text has exactly the formulas ``$…$`` of the English one, in any order."""

    @model_validator(mode="after")
    def _parts_fit_together(self) -> "ExerciseSpec":
        ids = [part.id for part in self.parts]
        repeated = sorted({part_id for part_id in ids if ids.count(part_id) > 1})
        if repeated:
            raise ValueError(
                say("two parts share the id {id!r}; give each its own", id=repeated[0])
            )
        if self.view is not None and self.robot is None:
            raise ValueError(
                say("view says where the robot is seen from; leave it out without a robot")
            )
        earlier: set[str] = set()
        for part in self.parts:
            if part.follows is not None and part.follows not in earlier:
                kinds = [kind for kind, spec in SPECS.items() if spec.can_be_followed]
                raise ValueError(
                    say(
                        "part {part!r} follows {followed!r}, which is no earlier part of kind "
                        "{kinds}; name one, or leave follows out",
                        part=part.id,
                        followed=part.follows,
                        kinds=", ".join(kinds),
                    )
                )
            if part.can_be_followed:
                earlier.add(part.id)
        return self


# --- Check the texts in other languages against the English texts


LANGUAGE_CODES: Final = ("de", "es", "fr", "zh")
_FORMULA: Final = regex(r"(?<!\\)(\$\$?)(.+?)(?<!\\)\1", re.DOTALL)


def check_translations(spec: ExerciseSpec) -> None:
    """Raise FieldError for a faulty translation, for example of an unknown part."""
    for code, texts in spec.translations.items():
        field = f"translations.{code}"
        if code not in LANGUAGE_CODES:
            known = ", ".join(LANGUAGE_CODES)
            raise FieldError(
                field, say("there is no such language; write one of {known}", known=known)
            )
        _require_known(f"{field}.parts", texts.parts, [part.id for part in spec.parts])
        joints = spec.robot.joints if spec.robot else []
        _require_known(f"{field}.symbols", texts.symbols, [*joints, *spec.symbols])
        for name, original, text in _pairs(spec, texts):
            if text is not None:
                _require_same_formulas(f"{field}.{name}", original, text)


def _require_known(field: str, named: Iterable[str], known: Iterable[str]) -> None:
    names = list(known)
    for name in named:
        if name not in names:
            reason = say("there is no such name; write one of {names}", names=", ".join(names))
            raise FieldError(f"{field}.{name}", reason)


def _pairs(spec: ExerciseSpec, texts: TranslationSpec) -> Iterator[tuple[str, str, str | None]]:
    for name in ("title", "summary", "statement"):
        yield name, getattr(spec, name), getattr(texts, name)
    for part in spec.parts:
        if translated := texts.parts.get(part.id):
            yield f"parts.{part.id}.title", part.title, translated.title
            yield f"parts.{part.id}.prompt", part.prompt, translated.prompt
    for name, text in texts.symbols.items():
        if symbol := spec.symbols.get(name):
            yield f"symbols.{name}", symbol.description, text


def _require_same_formulas(field: str, original: str, text: str) -> None:
    wanted, found = _formulas(original), _formulas(text)
    if missing := list((wanted - found).elements()):
        raise FieldError(
            field,
            say("lacks the formula ${formula}$ of the English text; write it", formula=missing[0]),
        )
    if further := list((found - wanted).elements()):
        reason = say(
            "has a formula ${formula}$ that the English text lacks; leave it out",
            formula=further[0],
        )
        raise FieldError(field, reason)


def _formulas(text: str) -> Counter[str]:
    return Counter(found[2].strip() for found in _FORMULA.finditer(text))
