"""Make the text of an exercise file for a robot."""

import json
import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from service.importing.home_statement import (
    HomeRobot,
    Letters,
    home_statement,
    number_text,
    tool_label,
)
from service.kinematics.chain import ALPHA, COLUMNS, THETA, A, D, Row, Table, modified_rows
from service.kinematics.dh import Convention

_WIDTH = 104
_POINTS_OF_A_ROW = 2
_MINUTES_A_ROW = 6
_INDUSTRIAL = 6
# x1 turns over between row 1 and row 2.
_ROWS_TO_TURN = 2
_MEANINGS = {"a": "distance between two axes", "d": "distance along an axis"}


@dataclass(frozen=True)
class Draft:
    """The author's choices for a new exercise."""

    title: str
    source: str
    convention: Convention = Convention.STANDARD
    remarks: Sequence[str] = field(default_factory=tuple)


def letters_for(table: Table) -> Letters:
    """Return a letter for each length of a standard table that is not 0."""
    return {
        (i, j): f"{COLUMNS[j]}{i + 1}"
        for i, row in enumerate(table)
        for j in (A, D)
        if number_text(float(row[j])) != "0"
    }


def exercise_text(robot: HomeRobot, draft: Draft) -> str:
    """Return an exercise file that asks for the table and the pose of the robot."""
    robot = replace(robot, letters=without_clashes(robot))
    statement = home_statement(robot, draft.convention)
    rows = rows_in(robot, draft.convention)
    joints = variable_names(robot.structure)
    joint_count, tool = len(robot.structure), tool_label(robot, draft.convention)
    points = _POINTS_OF_A_ROW * len(rows)
    asked = "one row for each joint" + (
        ", and a row e for the tool frame" if len(rows) > joint_count else ""
    )
    remarks = "".join(f"# {_plain(remark)}\n" for remark in draft.remarks)
    return f"""{remarks}title = {_string(draft.title)}
source = {_string(draft.source)}
level = "{_level(robot)}"
minutes = {_MINUTES_A_ROW * len(rows)}
summary = {_string(_summary(robot))}

statement = \"\"\"
{_wrapped(statement)}
\"\"\"

[robot]
structure = {_string(robot.structure)}
convention = {_string(draft.convention.value)}
joints = {json.dumps(joints)}
table = [
    # a, alpha, d, theta
{_table(rows)}
]
{_symbols(robot)}
[[parts]]
id = "table"
kind = "dh_table"
title = "Denavit-Hartenberg table"
prompt = "Give the {draft.convention.value} DH table, {asked}."
points = {points}
convention = {_string(draft.convention.value)}
frames = "free"

[[parts]]
id = "pose"
kind = "transform"
title = "Pose of the tool"
prompt = "Give the homogeneous transform from frame {{0}} to frame {{{tool}}}."
points = {points}
follows = "table"

[[checks]]
title = "The table of this file"
kind = "right"
answers.table = {_answer(rows)}
{_equivalent_check(robot, draft.convention)}"""


def _answer(rows: Sequence[Row[str]]) -> str:
    lines = ["a, alpha, d, theta", *(", ".join(row) for row in rows)]
    return '"""\n' + "\n".join(lines) + '\n"""'


def _equivalent_check(robot: HomeRobot, convention: Convention) -> str:
    """Return a check with another valid table, in which x1 is reversed."""
    # This table is valid, too.
    if len(robot.table) < _ROWS_TO_TURN:
        return ""
    table = robot.table.copy()
    table[0, [A, ALPHA]] *= -1
    table[0, THETA] += math.pi
    table[1, THETA] -= math.pi
    rows = rows_in(replace(robot, table=table), convention)
    return f"""
[[checks]]
title = "The same robot with x1 turned over"
kind = "equivalent"
answers.table = {_answer(rows)}
"""


def rows_in(robot: HomeRobot, convention: Convention) -> list[Row[str]]:
    """Return the cells of the robot's DH table in a convention, as texts."""
    rows = _rows(robot)
    if convention is Convention.MODIFIED:
        rows = modified_rows(rows, "0")
        if set(rows[-1]) == {"0"}:
            rows.pop()
    return rows


def _level(robot: HomeRobot) -> str:
    return "industrial" if len(robot.structure) >= _INDUSTRIAL else "arms"


def _summary(robot: HomeRobot) -> str:
    lengths = "lengths as letters" if robot.letters else "lengths in metres"
    return f"{len(robot.structure)} joints ({robot.structure}), {lengths}."


def variable_names(structure: str) -> list[str]:
    """Return the names of the joint variables, such as theta1 and d2 for RP."""
    return [f"{'d' if kind == 'P' else 'theta'}{i}" for i, kind in enumerate(structure, 1)]


def without_clashes(robot: HomeRobot) -> Letters:
    """Return the letters of the robot's lengths; for a sliding joint, h3 instead of d3."""
    # d3 is the joint variable.
    sliding = {i for i, kind in enumerate(robot.structure) if kind == "P"}
    return {
        cell: f"h{cell[0] + 1}" if cell[0] in sliding and cell[1] == D else name
        for cell, name in robot.letters.items()
    }


def _rows(robot: HomeRobot) -> list[Row[str]]:
    variables = variable_names(robot.structure)
    rows = []
    for i, row in enumerate(robot.table):
        cells = [
            _length(robot, i, A), angle_text(float(row[ALPHA])),
            _length(robot, i, D), angle_text(float(row[THETA])),
        ]  # fmt: skip
        if i < len(variables):
            column = D if robot.structure[i] == "P" else THETA
            cells[column] = _moving(variables[i], cells[column])
        a, alpha, d, theta = cells
        rows.append((a, alpha, d, theta))
    return rows


def _length(robot: HomeRobot, i: int, j: int) -> str:
    value = float(robot.table[i, j])
    letter = robot.letters.get((i, j))
    if letter is None:
        return number_text(value)
    return f"-{letter}" if value < 0 else letter


def _moving(variable: str, constant: str) -> str:
    if constant == "0":
        return variable
    sign, size = ("-", constant[1:]) if constant.startswith("-") else ("+", constant)
    return f"{variable} {sign} {size}"


def angle_text(angle: float) -> str:
    """Return an angle in degrees.

    >>> angle_text(math.pi / 2), angle_text(-1e-12)
    ('90deg', '0')
    """
    text = number_text(math.degrees(angle))
    return text if text == "0" else f"{text}deg"


def _table(rows: Sequence[Row[str]]) -> str:
    quoted = [[_string(cell) for cell in row] for row in rows]
    widths = [max(len(row[j]) + 1 for row in quoted) for j in range(len(COLUMNS))]
    lines = [
        "".join(f"{cell + ',':{width}} " for cell, width in zip(row[:-1], widths, strict=False))
        + row[-1]
        for row in quoted
    ]
    return "\n".join(f"    [{line}]," for line in lines)


def _symbols(robot: HomeRobot) -> str:
    """Return the section ``[symbols]`` of an exercise file."""
    # It has the variables of sliding joints and the letters, with ranges.
    lines = []
    for i, kind in enumerate(robot.structure, 1):
        if kind == "P":
            lines.append(
                f'd{i} = {{ kind = "length", unit = "m", range = [0.1, 0.6], '
                f'description = "displacement of joint {i}" }}'
            )
    for name, length in robot.lengths().items():
        low, high = (number_text(round(factor * length, 4)) for factor in (0.7, 1.3))
        meaning = _MEANINGS["a" if name.startswith("a") else "d"]
        if robot.real:
            meaning += f" ({number_text(length)} m on the real robot)"
        lines.append(
            f'{name} = {{ kind = "length", unit = "m", range = [{low}, {high}], '
            f'description = "{meaning}" }}'
        )
    return "\n[symbols]\n" + "\n".join(lines) + "\n" if lines else ""


def _wrapped(statement: str) -> str:
    blocks = []
    for block in statement.split("\n\n"):
        lines = block.split("\n")
        blocks.append(
            "\n".join(
                textwrap.fill(line, _WIDTH, subsequent_indent="  " if line[:2] == "- " else "")
                for line in lines
            )
        )
    return "\n\n".join(blocks)


def _string(text: str) -> str:
    """Return a TOML string."""
    return json.dumps(_plain(text), ensure_ascii=False)


def _plain(text: str) -> str:
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())
