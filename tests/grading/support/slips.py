"""Generate all kinds of slips in a table cell, with the codes of their messages."""

from collections.abc import Iterator
from dataclasses import dataclass

from dh_grader.grading import Verdict

from tests.grading.support.robots import COLUMNS, EXACT, AngleUnit, Robot

A, ALPHA, D, THETA = range(4)


@dataclass(frozen=True)
class Slip:
    """A wrong text in one cell, and the code of its message."""

    robot: Robot
    row: int
    column: int
    kind: str
    text: str
    code: str
    verdict: Verdict = Verdict.INCORRECT
    angle_unit: AngleUnit = "radians"

    def __str__(self) -> str:
        place = f"{self.robot.labels[self.row]}.{COLUMNS[self.column]}"
        return f"{self.robot.exercise} {place} {self.kind}"


def slips(robot: Robot, i: int, j: int) -> Iterator[Slip]:
    """Yield all slips in one cell."""
    variable = robot.joints[i] if i < len(robot.joints) else None
    cell = EXACT.rows(robot)[i][j]
    for kind, text, code in _of_cell(robot, variable, j, cell):
        yield Slip(robot, i, j, kind, text, code)
    unread = f"({cell}"
    yield Slip(robot, i, j, "unreadable", unread, "unbalanced_bracket", Verdict.UNREADABLE)
    yield Slip(robot, i, j, "empty", " ", "missing", Verdict.MISSING)
    if j == ALPHA and cell != "0":
        radians = {"pi": "3.1416", "pi/2": "1.5708", "-pi/2": "-1.5708"}[cell]
        yield Slip(robot, i, j, "radians", radians, "radians_as_degrees", angle_unit="degrees")


def _of_cell(
    robot: Robot, variable: str | None, column: int, cell: str
) -> Iterator[tuple[str, str, str]]:
    nothing_there = column in (A, D) and cell in ("0", variable)
    code = "distance_extra" if nothing_there else "value"
    yield "off by 0.05", f"{cell} + 0.05", code
    yield "a little off", f"{cell} + 0.004", code
    yield "undefined", f"{cell} + 1/0", "undefined"
    yield "nowhere real", "sqrt(-1)", "undefined"
    if cell == variable:
        yield from _of_joint_cell(robot, variable, column)
    else:
        yield from _of_constant_cell(robot, variable, column, cell)


def _of_joint_cell(robot: Robot, variable: str, column: int) -> Iterator[tuple[str, str, str]]:
    other = next(name for name in robot.joints if name != variable)
    yield "sign", f"-{variable}", "joint_variable_sign"
    yield "other joint", other, "joint_variable_index"
    yield "doubled", f"2*{variable}", "joint_variable_doubled"
    yield "missing", "0", "joint_variable_missing"
    yield "another joint too", f"{variable} + {other}", "joint_variable_extra"
    yield "not linear", f"{variable}^2", "value"
    if column == THETA:
        yield "quarter turn", f"{variable} + pi/2", "quarter_turn"
        yield "quarter turn back", f"{variable} - 90deg", "quarter_turn"
        yield "half turn", f"{variable} + pi", "half_turn"
        yield "home position", "pi/2", "joint_variable_missing"
    else:
        yield "home position", robot.lengths[0], "joint_variable_missing"
        yield "another length too", f"{variable} + {robot.lengths[0]}", "distance_extra"


def _of_constant_cell(
    robot: Robot, variable: str | None, column: int, cell: str
) -> Iterator[tuple[str, str, str]]:
    if variable:
        yield "joint variable", f"{cell} + {variable}", "joint_variable_column"
    stranger = robot.joints[1] if variable == robot.joints[0] else robot.joints[0]
    yield "other joint's variable", f"{cell} + {stranger}", "joint_variable_extra"
    if column in (A, D):
        yield from _of_length(robot, cell)
    else:
        yield from _of_angle(cell)


def _of_length(robot: Robot, cell: str) -> Iterator[tuple[str, str, str]]:
    other = next(name for name in robot.lengths if name != cell)
    if cell == "0":
        yield "a length", other, "distance_extra"
        yield "a number", "1", "distance_extra"
        yield "tiny", "0.000001", "distance_extra"
    else:
        yield "other length", other, "value"
        yield "sign", f"-{cell}", "sign"
        yield "zero", "0", "distance_left_out"
        yield "doubled", f"2*{cell}", "value"


def _of_angle(cell: str) -> Iterator[tuple[str, str, str]]:
    yield "eighth turn", f"{cell} + 45deg", "value"
    if cell == "0":
        yield "quarter turn", "90deg", "quarter_turn"
        yield "quarter turn back", "-pi/2", "quarter_turn"
        yield "half turn", "180deg", "half_turn"
    elif cell == "pi":
        yield "no turn", "0", "half_turn"
        yield "quarter turn", "pi/2", "quarter_turn"
        yield "bare degrees", "180", "degrees_as_radians"
    else:
        yield "sign", f"-({cell})", "sign"
        yield "no turn", "0", "quarter_turn"
        yield "half turn", "180°", "quarter_turn"
        yield "bare degrees", "-90" if cell.startswith("-") else "90", "degrees_as_radians"
