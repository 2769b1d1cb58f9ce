"""Compile the validated content of an exercise file into an exercise that can be graded.

The compiler also checks formulas, joint variables and ranges, which pydantic cannot check.
"""

import hashlib
import json
import math
from collections.abc import Mapping, Sequence

import numpy as np

from dh_grader.catalogue.exercise import Exercise
from dh_grader.catalogue.part import PartSpec
from dh_grader.catalogue.robot import (
    EXACT,
    ROW_QUANTITIES,
    FieldError,
    FormulaGrid,
    FormulaReader,
    FormulaRow,
    Joint,
    Reference,
    Robot,
    ScrewRobot,
    Variable,
    screws_of,
    tables_in_both_conventions,
    transform_of,
)
from dh_grader.catalogue.schema import (
    CheckSpec,
    ExerciseSpec,
    RobotSpec,
    ScrewRobotSpec,
    SymbolSpec,
    check_translations,
)
from dh_grader.catalogue.schema_fields import FeedbackLevel, Four
from dh_grader.expressions import Expression, Kind, Symbol, Vocabulary
from dh_grader.kinematics import COLUMNS, A, D
from dh_grader.translations import say, template

DEFAULT_RANGES: dict[Kind, tuple[float, float]] = {
    "angle": (-math.pi, math.pi),
    "length": (0.2, 1.0),
    "number": (0.5, 2.0),
}
# The fields of a file that do not affect grading.
_CATALOGUE = {"level", "order", "minutes", "summary", "keywords"}
_NOT_GRADING = {"checks", "feedback", "attempts", "view", "translations", *_CATALOGUE}


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
        for field, named in (("answers", check.answers), ("expect", check.expect)):
            for name in named:
                if name not in most:
                    known = ", ".join(most)
                    raise FieldError(
                        f"checks[{i}].{field}.{name}",
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
    written = spec.model_dump(mode="json", exclude_defaults=True, exclude=_NOT_GRADING)
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
