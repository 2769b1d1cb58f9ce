"""From the shape of an exercise file to an exercise that can be graded.

What pydantic cannot see is checked here, where the symbols are known: that each formula can be
read, that each row holds its joint variable in the right column, that the ranges make sense.
"""

import hashlib
import json
import math

import numpy as np

from service.catalogue.answers import Reference, part_formulas, screw_robot_formulas
from service.catalogue.checks import check_parts
from service.catalogue.exercise import Exercise, Variable
from service.catalogue.reading import TRIALS, FieldError, no_value, read_formula, trial_values
from service.catalogue.robot import (
    FormulaRow,
    Joint,
    ReferenceTable,
    Robot,
    tables_in_both_conventions,
)
from service.catalogue.schema import (
    DhTableSpec,
    ExerciseSpec,
    Formula,
    LinkTransformsSpec,
    RobotSpec,
    ScrewRobotSpec,
    SymbolSpec,
)
from service.catalogue.screw_robot import ScrewRobot
from service.expressions import Expression, Kind, Symbol, Vocabulary, read
from service.kinematics.chain import COLUMNS, A, D

QUANTITIES: dict[str, Kind] = {"a": "length", "alpha": "angle", "d": "length", "theta": "angle"}
DEFAULT_RANGES: dict[Kind, tuple[float, float]] = {
    "angle": (-math.pi, math.pi),
    "length": (0.2, 1.0),
    "number": (0.5, 2.0),
}


def compile_exercise(exercise_id: str, spec: ExerciseSpec) -> Exercise:
    """The exercise that ``spec`` describes. Raises FieldError where a value cannot stand."""
    joints = _joints(spec.robot) if spec.robot is not None else ()
    variables = _variables(joints, spec.symbols)
    vocabulary = _vocabulary(variables)
    reference = _reference(spec.robot, joints, vocabulary, variables)
    formulas = part_formulas(spec.parts, reference, vocabulary, variables)
    for i, part in enumerate(spec.parts):
        if not isinstance(part, DhTableSpec | LinkTransformsSpec) or part.convention == "either":
            continue
        if isinstance(reference, Robot) and part.convention not in reference.tables:
            raise FieldError(
                f"parts[{i}].convention",
                f"the robot has no {part.convention.value} table: its row 1 moves the base frame, "
                f"and a standard table begins on the axis of joint 1",
            )
    check_parts(spec.checks, spec.parts)
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
    )


def _length_scale(variables: tuple[Variable, ...], reference: Robot | ScrewRobot | None) -> float:
    """The longest length: of the letters, and of the numbers that the reference's table has."""
    lengths = [max(abs(v.low), abs(v.high)) for v in variables if v.kind == "length"]
    if isinstance(reference, Robot):
        nothing = {variable.name: np.zeros(1) for variable in variables}
        table = np.abs(reference.tables[reference.convention].values(nothing, 1)[:, [A, D]])
        lengths.extend(table[table > 0].tolist())
    return float(max(lengths, default=1.0))


def _version(spec: ExerciseSpec) -> str:
    """A digest of the file's content; comments, layout and checks do not change it.

    What the file leaves to the default is left out, so that a new field of the schema does not
    give every exercise a new version.
    """
    told = spec.model_dump(mode="json", exclude_defaults=True, exclude={"checks"})
    content = json.dumps(told, sort_keys=True)
    return hashlib.blake2b(content.encode(), digest_size=6).hexdigest()


def _joints(robot: RobotSpec | ScrewRobotSpec) -> tuple[Joint, ...]:
    """The joints, numbered as their variables are (a wrist's joints may begin at 4)."""
    first = 1
    digits = "".join(character for character in robot.joints[0] if character.isdigit())
    if digits:
        first = int(digits)
    return tuple(
        Joint(index=first + i, variable=name, prismatic=letter == "P")
        for i, (name, letter) in enumerate(zip(robot.joints, robot.structure, strict=True))
    )


def _variables(joints: tuple[Joint, ...], symbols: dict[str, SymbolSpec]) -> tuple[Variable, ...]:
    """All letters: the joint variables first, then the symbols in the file's order.

    A symbol entry with a joint variable's name says more about that joint (range, description).
    """
    joint_names = {joint.variable for joint in joints}
    of_joints = [_joint_variable(joint, symbols.get(joint.variable)) for joint in joints]
    others = [
        _variable(name, symbol) for name, symbol in symbols.items() if name not in joint_names
    ]
    return (*of_joints, *others)


def _joint_variable(joint: Joint, symbol: SymbolSpec | None) -> Variable:
    kind: Kind = "length" if joint.prismatic else "angle"
    if symbol is None:
        motion = "displacement" if joint.prismatic else "angle"
        symbol = SymbolSpec(kind=kind, description=f"joint {motion} of joint {joint.index}")
    elif symbol.kind != kind:
        raise FieldError(
            f"symbols.{joint.variable}.kind",
            f"is {symbol.kind!r}, but joint {joint.index} "
            f"{'slides' if joint.prismatic else 'turns'}; write {kind!r}",
        )
    return _variable(joint.variable, symbol, joint.index)


def _variable(name: str, symbol: SymbolSpec, joint: int | None = None) -> Variable:
    low, high = _range(f"symbols.{name}.range", symbol)
    unit = symbol.unit or {"angle": "rad", "length": "m", "number": ""}[symbol.kind]
    return Variable(name, symbol.kind, unit, symbol.description, low, high, joint)


def _range(field: str, symbol: SymbolSpec) -> tuple[float, float]:
    if symbol.range is None:
        return DEFAULT_RANGES[symbol.kind]
    constants = Vocabulary([])
    low, high = (
        float(read_formula(f"{field}[{i}]", bound, constants, symbol.kind).evaluate({}))
        for i, bound in enumerate(symbol.range)
    )
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise FieldError(field, f"must rise from low to high, not from {low:g} to {high:g}")
    return low, high


def _vocabulary(variables: tuple[Variable, ...]) -> Vocabulary:
    taken = {variable.name for variable in variables}
    symbols = [
        Symbol(
            name=variable.name,
            kind=variable.kind,
            aliases=_joint_aliases(variable, taken),
            joint=variable.joint,
        )
        for variable in variables
    ]
    try:
        return Vocabulary(symbols)
    except ValueError as error:
        raise FieldError("symbols", str(error)) from error


def _joint_aliases(variable: Variable, taken: set[str]) -> tuple[str, ...]:
    """The usual names of a joint variable, less those that the exercise gives to another symbol."""
    if variable.joint is None:
        return ()
    letters = ("q", "d") if variable.kind == "length" else ("q", "theta", "th")
    names = (f"{letter}{variable.joint}" for letter in letters)
    return tuple(name for name in names if name not in taken)


def _reference(
    spec: RobotSpec | ScrewRobotSpec | None,
    joints: tuple[Joint, ...],
    vocabulary: Vocabulary,
    variables: tuple[Variable, ...],
) -> Reference | None:
    if spec is None:
        return None
    if isinstance(spec, RobotSpec):
        robot = _robot(spec, joints, vocabulary)
        _check_defined(robot.tables[spec.convention], variables)
        return robot
    home, axes = screw_robot_formulas(spec, vocabulary, variables)
    return ScrewRobot(spec.structure, joints, home, axes)


def _check_defined(table: ReferenceTable, variables: tuple[Variable, ...]) -> None:
    """Every cell has a value wherever the symbols' ranges reach. Raises FieldError."""
    numbers = table.values(trial_values(variables), TRIALS)
    for i, j in np.argwhere(~np.isfinite(numbers).all(axis=-1)).tolist():
        raise FieldError(f"robot.table[{i}].{COLUMNS[j]}", no_value(table.rows[i][j]))


def _robot(spec: RobotSpec, joints: tuple[Joint, ...], vocabulary: Vocabulary) -> Robot:
    rows = tuple(_row(i, cells, joints, vocabulary) for i, cells in enumerate(spec.table))
    zero = read(0, vocabulary)
    return Robot(
        structure=spec.structure,
        convention=spec.convention,
        joints=joints,
        tables=tables_in_both_conventions(joints, rows, spec.convention, zero),
    )


def _row(
    i: int,
    cells: tuple[Formula, Formula, Formula, Formula],
    joints: tuple[Joint, ...],
    vocabulary: Vocabulary,
) -> FormulaRow:
    field = f"robot.table[{i}]"
    a, alpha, d, theta = (
        read_formula(f"{field}.{column}", cell, vocabulary, QUANTITIES[column])
        for column, cell in zip(COLUMNS, cells, strict=True)
    )
    row = (a, alpha, d, theta)
    moving = joints[i] if i < len(joints) else None
    variables = {joint.variable for joint in joints}
    for column, formula in zip(COLUMNS, row, strict=True):
        expected = {moving.variable} if moving and moving.column == column else set()
        if formula.symbols & variables != expected:
            wanted = f"must hold {moving.variable}" if expected and moving else "must be constant"
            raise FieldError(f"{field}.{column}", f"{wanted}, but reads {formula.text()}")
    if moving is not None:
        _check_moves_once(f"{field}.{moving.column}", row[COLUMNS.index(moving.column)], moving)
    return row


def _check_moves_once(field: str, formula: Expression, joint: Joint) -> None:
    """A joint variable enters its cell as +q: the reference fixes the sense of each joint."""
    at = np.array([0.0, 0.7, -1.3])
    values = {name: np.full(3, 0.4) for name in formula.symbols} | {joint.variable: at}
    cell = formula.evaluate(values)
    if not np.allclose(cell - np.asarray(cell)[0], at):
        raise FieldError(
            field, f"must be {joint.variable} plus a constant, but reads {formula.text()}"
        )
