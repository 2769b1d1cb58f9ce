"""A compiled exercise (vocabulary, robot, parts), and how it is compiled from a valid file.

The models of the file are in ``schema.py`` and ``kinds.py``; ``load.py`` finds the files.
"""

import hashlib
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from gettext import NullTranslations
from typing import Final

import numpy as np

from dh_grader.catalogue.part import PartSpec
from dh_grader.catalogue.robot import (
    EXACT,
    ROW_QUANTITIES,
    FieldError,
    FormulaField,
    FormulaGrid,
    FormulaReader,
    FormulaRow,
    Joint,
    Reference,
    Robot,
    ScrewRobot,
    Variable,
    fields_of,
    screws_of,
    tables_in_both_conventions,
    transform_of,
)
from dh_grader.catalogue.schema import (
    CheckSpec,
    ExerciseSpec,
    PartTextsSpec,
    RobotSpec,
    ScrewRobotSpec,
    SymbolSpec,
    TranslationSpec,
    ViewSpec,
    check_translations,
)
from dh_grader.catalogue.schema_fields import (
    NOT_GRADING,
    AttemptsSpec,
    ExerciseLevel,
    FeedbackLevel,
    Four,
)
from dh_grader.catalogue.varying import Vary
from dh_grader.expressions import Expression, Kind, Symbol, Vocabulary
from dh_grader.kinematics import COLUMNS, A, Convention, D
from dh_grader.translations import ENGLISH, Language, Sentence, say, template, told

# --- A compiled exercise: its vocabulary, its reference robot, and its parts


_ANY_TIME: Final = AttemptsSpec()
_UNTRANSLATED: Final = TranslationSpec()
_UNTRANSLATED_PART: Final = PartTextsSpec()


@dataclass(frozen=True, slots=True)
class Exercise:
    """An exercise of the catalogue, or a variant with changed numbers."""

    id: str
    # The version changes with every field that affects grading.
    version: str
    title: str
    source: str
    statement: str
    variables: tuple[Variable, ...]
    vocabulary: Vocabulary
    # The robot, if any.
    reference: Reference | None
    # The answers that the file gives, by part id.
    formulas: Mapping[str, FormulaGrid]
    parts: tuple[PartSpec, ...]
    # The longest length, to which small differences are compared.
    length_scale: float
    checks: tuple[CheckSpec, ...] = ()
    # The highest feedback level of each attempt; the last level is for all later attempts.
    feedback_by_attempt: tuple[FeedbackLevel, ...] = (FeedbackLevel.HINTS,)
    attempts: AttemptsSpec = _ANY_TIME
    # The viewpoint of the figure.
    view: ViewSpec | None = None
    level: ExerciseLevel | None = None
    order: int | None = None
    minutes: int | None = None
    summary: str = ""
    keywords: tuple[str, ...] = ()
    # The values of the variants, if the exercise has variants.
    vary: Vary | None = None
    # The seed of a variant, whose id is ``<exercise>~<seed>`` unless the seed is hidden.
    seed: str = ""
    translations: Mapping[str, TranslationSpec] = field(default_factory=dict)
    # Translations of the exercise by language code, memoized.
    told: dict[str, "Exercise"] = field(default_factory=dict, init=False, repr=False, compare=False)

    @property
    def plain_id(self) -> str:
        """The id without the seed of a variant: ``arm`` for the variant ``arm~7``."""
        return self.id.partition("~")[0]

    @property
    def conventions(self) -> tuple[Convention, ...]:
        """The Denavit-Hartenberg conventions that the parts ask for, without duplicates."""
        asked = {getattr(part, "convention", None) for part in self.parts}
        return tuple(each for each in Convention if not asked.isdisjoint({each, "either"}))

    @property
    def feedback(self) -> FeedbackLevel:
        """The highest feedback level for a first attempt or an unrecorded answer."""
        return self.feedback_by_attempt[0]

    def feedback_at(self, ordinal: int) -> FeedbackLevel:
        """The highest feedback level for attempt number ``ordinal``, counted from 1."""
        return self.feedback_by_attempt[min(ordinal, len(self.feedback_by_attempt)) - 1]

    @property
    def robot(self) -> Robot:
        """The robot, if the file gives it by a table. Otherwise raises LookupError."""
        if not isinstance(self.reference, Robot):
            raise LookupError(f"exercise {self.id!r} has no robot with a table")
        return self.reference

    @property
    def symbols(self) -> frozenset[str]:
        """The names of the exercise's variables and symbols, as they are declared."""
        return frozenset(variable.name for variable in self.variables)

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The robot's joints; empty without a robot."""
        return self.reference.joints if self.reference else ()

    @property
    def structure(self) -> str | None:
        """The letters of the robot's joints, such as "RRP"; None without a robot."""
        return self.reference.structure if self.reference else None

    def part(self, part_id: str) -> PartSpec | None:
        """The part with this id, or None."""
        return next((part for part in self.parts if part.id == part_id), None)

    def fields(self) -> Iterator[FormulaField]:
        """Yield each formula of the file with its field and quantity (length, angle or number)."""
        if self.reference is not None:
            yield from self.reference.fields()
        for i, part in enumerate(self.parts):
            written = part.formulas()
            if written is not None:
                path, grid = f"parts[{i}].{written.path}", self.formulas[part.id]
                yield from fields_of(path, grid, written.quantities)


def in_language(exercise: Exercise, language: Language) -> Exercise:
    """Return the exercise in a language. Texts without a translation do not change."""
    if language == ENGLISH:
        return exercise
    if language.code not in exercise.told:
        exercise.told[language.code] = _translated(exercise, language)
    return exercise.told[language.code]


def _translated(exercise: Exercise, language: Language) -> Exercise:
    texts = exercise.translations.get(language.code, _UNTRANSLATED)
    translation = language.translation
    variables = (
        replace(
            each, description=texts.symbols.get(each.name) or told(each.description, translation)
        )
        for each in exercise.variables
    )
    return replace(
        exercise,
        title=texts.title or told(exercise.title, translation),
        source=told(exercise.source, translation),
        summary=texts.summary or told(exercise.summary, translation),
        statement=texts.statement or told(exercise.statement, translation),
        variables=tuple(variables),
        parts=tuple(
            _translated_part(part, texts.parts.get(part.id, _UNTRANSLATED_PART), translation)
            for part in exercise.parts
        ),
    )


def _translated_part(
    part: PartSpec, texts: PartTextsSpec, translation: NullTranslations | None
) -> PartSpec:
    sentences = {
        name: told(text, translation)
        for name, text in (("title", part.title), ("prompt", part.prompt))
        if isinstance(text, Sentence)
    }
    return part.model_copy(update=sentences | texts.model_dump(exclude_none=True))


# --- Compile the validated content of a file into an exercise


DEFAULT_RANGES: dict[Kind, tuple[float, float]] = {
    "angle": (-math.pi, math.pi),
    "length": (0.2, 1.0),
    "number": (0.5, 2.0),
}


def compile_exercise(exercise_id: str, spec: ExerciseSpec) -> Exercise:
    """Return the exercise that ``spec`` describes. Raises FieldError for an invalid value."""
    joints = _joints(spec.robot) if spec.robot is not None else ()
    variables = _variables(joints, spec.symbols)
    vocabulary = _vocabulary(variables, decimal_comma=spec.decimal_comma)
    reader = FormulaReader(vocabulary, variables)
    reference: Reference | None = None
    if isinstance(spec.robot, RobotSpec):
        reference = _robot(spec.robot, joints, reader)
    elif spec.robot is not None:
        reference = _screw_robot(spec.robot, joints, reader)
    formulas = _formulas(spec.parts, reference, reader)
    _check_checks(spec.checks, spec.parts)
    check_translations(spec)
    return Exercise(
        id=exercise_id,
        version=_version(spec),
        title=spec.title,
        source=spec.source,
        statement=spec.statement,
        variables=variables,
        vocabulary=vocabulary,
        reference=reference,
        formulas=formulas,
        parts=tuple(spec.parts),
        length_scale=_length_scale(variables, reference),
        checks=tuple(spec.checks),
        feedback_by_attempt=_levels(spec.feedback),
        attempts=spec.attempts,
        view=spec.view,
        level=spec.level,
        order=spec.order,
        minutes=spec.minutes,
        summary=spec.summary,
        keywords=tuple(spec.keywords),
        translations=spec.translations,
    )


def _formulas(
    parts: Sequence[PartSpec], reference: Reference | None, reader: FormulaReader
) -> Mapping[str, FormulaGrid]:
    found: dict[str, FormulaGrid] = {}
    for i, part in enumerate(parts):
        written = part.formulas()
        if written is None:
            part.check_reference(f"parts[{i}]", reference)
        else:
            found[part.id] = reader.grid(written, f"parts[{i}].")
    return found


def _check_checks(checks: Sequence[CheckSpec], parts: Sequence[PartSpec]) -> None:
    most = {part.id: part.points for part in parts}
    for i, check in enumerate(checks):
        for key, named in (("answers", check.answers), ("expect", check.expect)):
            for name in named:
                if name not in most:
                    known = ", ".join(most)
                    raise FieldError(
                        f"checks[{i}].{key}.{name}",
                        say("there is no such part; write one of {known}", known=known),
                    )
        for name, expected in check.expect.items():
            if expected.points is not None and expected.points > most[name]:
                raise FieldError(
                    f"checks[{i}].expect.{name}.points",
                    say(
                        "is more than the part's {most} points; write {most} or less",
                        most=f"{most[name]:g}",
                    ),
                )


def _length_scale(variables: tuple[Variable, ...], reference: Reference | None) -> float:
    lengths = [max(abs(v.low), abs(v.high)) for v in variables if v.kind == "length"]
    if isinstance(reference, Robot):
        nothing = {variable.name: np.zeros(1) for variable in variables}
        table = np.abs(reference.tables[reference.convention].values(nothing, 1)[:, [A, D]])
        lengths.extend(table[table > 0].tolist())
    return float(max(lengths, default=1.0))


def _levels(feedback: FeedbackLevel | list[FeedbackLevel]) -> tuple[FeedbackLevel, ...]:
    return tuple(feedback) if isinstance(feedback, list) else (feedback,)


def _version(spec: ExerciseSpec) -> str:
    """Return the digest of all fields that affect grading."""
    # Default values are left out, so a new field of the schema changes no exercise's version.
    written = spec.model_dump(mode="json", exclude_defaults=True, exclude=set(NOT_GRADING))
    content = json.dumps(written, sort_keys=True)
    return hashlib.blake2b(content.encode(), digest_size=6).hexdigest()


def _joints(robot: RobotSpec | ScrewRobotSpec) -> tuple[Joint, ...]:
    digits = "".join(character for character in robot.joints[0] if character.isdigit())
    named = zip(robot.joints, robot.structure, strict=True)
    return tuple(
        Joint(index, name, prismatic=letter == "P")
        for index, (name, letter) in enumerate(named, int(digits or 1))
    )


def _variables(joints: tuple[Joint, ...], symbols: dict[str, SymbolSpec]) -> tuple[Variable, ...]:
    joint_names = {joint.variable for joint in joints}
    # A symbol named like a joint variable sets that joint's range and description.
    of_joints = [_joint_variable(joint, symbols.get(joint.variable)) for joint in joints]
    others = [
        _variable(name, symbol) for name, symbol in symbols.items() if name not in joint_names
    ]
    return (*of_joints, *others)


def _joint_variable(joint: Joint, symbol: SymbolSpec | None) -> Variable:
    kind: Kind = "length" if joint.prismatic else "angle"
    if symbol is None:
        meaning = (
            say("joint displacement of joint {joint}", joint=joint.index)
            if joint.prismatic
            else say("joint angle of joint {joint}", joint=joint.index)
        )
        described = SymbolSpec(kind=kind, description=meaning)
        return _variable(joint.variable, described, joint.index)
    if symbol.kind != kind:
        fault = (
            template("is {given!r}, but joint {joint} slides; write {kind!r}")
            if joint.prismatic
            else template("is {given!r}, but joint {joint} turns; write {kind!r}")
        )
        raise FieldError(
            f"symbols.{joint.variable}.kind",
            say(fault, given=symbol.kind, joint=joint.index, kind=kind),
        )
    return _variable(joint.variable, symbol, joint.index)


def _variable(name: str, symbol: SymbolSpec, joint: int | None = None) -> Variable:
    low, high = _range(f"symbols.{name}.range", symbol)
    unit = symbol.unit or {"angle": "rad", "length": "m", "number": ""}[symbol.kind]
    return Variable(name, symbol.kind, unit, symbol.description, low, high, joint)


def _range(field: str, symbol: SymbolSpec) -> tuple[float, float]:
    if symbol.range is None:
        return DEFAULT_RANGES[symbol.kind]
    constants = FormulaReader(Vocabulary([]), ())
    low, high = (
        float(constants.read(f"{field}[{i}]", bound, symbol.kind).evaluate({}))
        for i, bound in enumerate(symbol.range)
    )
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise FieldError(
            field,
            say(
                "must rise from low to high, not from {low} to {high}",
                low=f"{low:g}",
                high=f"{high:g}",
            ),
        )
    return low, high


def _vocabulary(variables: tuple[Variable, ...], *, decimal_comma: bool) -> Vocabulary:
    taken = {variable.name for variable in variables}
    symbols = [Symbol(v.name, v.kind, _joint_aliases(v, taken), v.joint) for v in variables]
    try:
        return Vocabulary(symbols, decimal_comma=decimal_comma)
    except ValueError as error:
        raise FieldError("symbols", error.args[0]) from error


def _joint_aliases(variable: Variable, taken: set[str]) -> tuple[str, ...]:
    if variable.joint is None:
        return ()
    letters = ("q", "d") if variable.kind == "length" else ("q", "theta", "th")
    names = (f"{letter}{variable.joint}" for letter in letters)
    return tuple(name for name in names if name not in taken)


def _robot(spec: RobotSpec, joints: tuple[Joint, ...], reader: FormulaReader) -> Robot:
    rows = tuple(_row(i, cells, joints, reader) for i, cells in enumerate(spec.table))
    reader.trial_numbers(rows, lambda i, j: f"robot.table[{i}].{COLUMNS[j]}")
    zero = reader.read("robot.table", 0, "number")
    tables = tables_in_both_conventions(joints, rows, spec.convention, zero)
    return Robot(spec.structure, spec.convention, joints, tables)


def _screw_robot(
    spec: ScrewRobotSpec, joints: tuple[Joint, ...], reader: FormulaReader
) -> ScrewRobot:
    home = reader.grid(transform_of("robot.home", spec.home))
    axes = reader.grid(screws_of("robot.screws", spec.screws))
    omega = reader.trial_numbers(axes, lambda i, _: f"robot.screws[{i}]")[:, :3]
    turns = np.abs(omega).max(axis=(1, 2)) > EXACT
    for i, (joint, turning) in enumerate(zip(joints, turns.tolist(), strict=True)):
        if turning == joint.prismatic:
            fault = (
                template("turns, but structure {structure!r} says that joint {joint} slides")
                if turning
                else template("slides, but structure {structure!r} says that joint {joint} turns")
            )
            raise FieldError(
                f"robot.screws[{i}]", say(fault, structure=spec.structure, joint=i + 1)
            )
    return ScrewRobot(spec.structure, joints, home, axes)


def _row(i: int, cells: Four, joints: tuple[Joint, ...], reader: FormulaReader) -> FormulaRow:
    field = f"robot.table[{i}]"
    a, alpha, d, theta = row = [
        reader.read(f"{field}.{column}", cell, quantity)
        for column, cell, quantity in zip(COLUMNS, cells, ROW_QUANTITIES, strict=True)
    ]
    moving = joints[i] if i < len(joints) else None
    variables = {joint.variable for joint in joints}
    for column, formula in zip(COLUMNS, row, strict=True):
        expected = {moving.variable} if moving and moving.column == column else set()
        if formula.symbols & variables != expected:
            reason = (
                say(
                    "must hold {variable}, but reads {formula}",
                    variable=moving.variable,
                    formula=formula.text(),
                )
                if expected and moving
                else say("must be constant, but reads {formula}", formula=formula.text())
            )
            raise FieldError(f"{field}.{column}", reason)
    if moving is not None:
        _check_moves_once(f"{field}.{moving.column}", row[COLUMNS.index(moving.column)], moving)
    return a, alpha, d, theta


def _check_moves_once(field: str, formula: Expression, joint: Joint) -> None:
    at = np.array([0.0, 0.7, -1.3])
    values = {name: np.full(3, 0.4) for name in formula.symbols} | {joint.variable: at}
    cell = formula.evaluate(values)
    # The factor must be +1, because the reference defines the positive directions.
    if not np.allclose(cell - np.asarray(cell)[0], at):
        raise FieldError(
            field,
            say(
                "must be {variable} plus a constant, but reads {formula}",
                variable=joint.variable,
                formula=formula.text(),
            ),
        )
