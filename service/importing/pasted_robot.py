"""Read a pasted DH table as a robot."""

import numpy as np

from service.expressions import Expression, evaluate_all
from service.figures.tables.scope import DrawingScope, free_scope
from service.figures.tables.table_frames import table_to_draw
from service.grading.feedback import UnreadableAnswerError
from service.grading.reading.tables.table import StudentTable
from service.grading.work_budget import WorkBudget
from service.importing.home_statement import HomeRobot
from service.kinematics.chain import ALPHA, COLUMNS, THETA, A, D, standard_rows
from service.kinematics.dh import Convention
from service.translations import joined, say

_MOST_JOINTS = 10
_LETTER_LENGTHS = {"a": 0.5, "d": 0.3}


class UnusableTableError(ValueError):
    """The table cannot become an exercise; the message says why."""


def robot_of_table(text: str, convention: Convention) -> HomeRobot:
    """Return the robot of a table in any format that students may paste.

    A length is a number, or a letter with an optional sign. Raises UnusableTableError.
    """
    # No two lengths have the same letter.
    rows = len(_read(text, free_scope("R")).rows)
    joints = min(rows, _MOST_JOINTS)
    first = _read(text, free_scope("R" * joints))
    kinds = [_kind(first, i) for i in range(joints)]
    fixed = [i for i, kind in enumerate(kinds) if kind is None]
    if fixed and (fixed != [rows - 1] or rows == 1):
        raise UnusableTableError(say("row {row} has no joint variable", row=fixed[0] + 1))
    if rows - len(fixed) > _MOST_JOINTS:
        raise UnusableTableError(say("the table has more than {most} joints", most=_MOST_JOINTS))
    structure = "".join(kind for kind in kinds if kind)
    scope = free_scope(structure)
    table = _read(text, scope)
    cells = [[_constant(table, i, j, scope) for j in range(len(COLUMNS))] for i in range(rows)]
    numbers = np.array([[value for value, _ in row] for row in cells])
    letters = {
        (i, j): name for i, row in enumerate(cells) for j, (_, name) in enumerate(row) if name
    }
    if convention is Convention.MODIFIED:
        if np.abs(numbers[0, [A, ALPHA]]).max() > 0:
            raise UnusableTableError(
                say("a and alpha of row 1 must be 0: frame {{0}} lies on joint 1")
            )
        numbers = np.array(standard_rows([tuple(row) for row in numbers], 0.0))
        letters = {(i - 1 if j in (A, ALPHA) else i, j): name for (i, j), name in letters.items()}
    repeated = len(set(letters.values())) < len(letters)
    if repeated:
        raise UnusableTableError(
            say("a letter is in two cells; give each length a letter of its own")
        )
    return HomeRobot(numbers, structure, letters)


def _read(text: str, scope: DrawingScope) -> StudentTable:
    try:
        return table_to_draw(text, scope, WorkBudget())
    except UnreadableAnswerError as error:
        raise UnusableTableError(error.finding.hint) from None


def _kind(table: StudentTable, i: int) -> str | None:
    variable = f"theta{i + 1}"
    _, _, d, theta = table.rows[i].entries
    if theta.expression is not None and variable in theta.expression.symbols:
        return "R"
    slides = d.expression is None or d.expression.symbols & {f"d{i + 1}", variable}
    return "P" if slides else None


def _constant(table: StudentTable, i: int, j: int, scope: DrawingScope) -> tuple[float, str | None]:
    place = say("row {row}, column {column}", row=i + 1, column=COLUMNS[j])
    entry = table.rows[i].entries[j]
    if entry.expression is None:
        reason = entry.findings[0].hint if entry.findings else say("nothing is written here")
        raise UnusableTableError(joined(": ", [place, reason]))
    moving = {joint.variable for joint in scope.joints[i : i + 1]}
    own = moving if j in (D, THETA) else set[str]()
    others = sorted(entry.expression.symbols - own)
    at_zero, at_one = _values(entry.expression, others)
    if not others:
        return at_zero, None
    if len(others) > 1 or j in (ALPHA, THETA) or at_zero or abs(at_one) != 1:
        reason = say("write a number, or one letter with its sign")
        raise UnusableTableError(joined(": ", [place, reason]))
    return float(np.sign(at_one)) * _LETTER_LENGTHS[COLUMNS[j]], others[0]


def _values(formula: Expression, names: list[str]) -> tuple[float, float]:
    values = {name: np.array([0.0, float(name in names)]) for name in formula.symbols}
    [found] = evaluate_all([formula], values, {})
    at_zero, at_one = np.broadcast_to(np.asarray(found, dtype=np.float64), 2)
    return float(at_zero), float(at_one)
