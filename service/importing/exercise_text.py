"""Make the text of an exercise file for a robot."""

import json
import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from service.importing.home_statement import HomeRobot, home_statement, sum_text, tool_label
from service.importing.numbers import angle_text, exact_text, number_text
from service.kinematics.chain import ALPHA, COLUMNS, THETA, A, D, Row, modified_rows
from service.kinematics.dh import Convention

_WIDTH = 104
_POINTS_OF_A_ROW = 2
_MINUTES_A_ROW = 6
_INDUSTRIAL = 6
# Half of the last decimal that a statement shows, in metres.
_NO_LENGTH = 5e-7
# x1 turns over between row 1 and row 2.
_ROWS_TO_TURN = 2
_MEANINGS = {"a": "distance between two axes", "d": "distance along an axis"}


@dataclass(frozen=True)
class Draft:
    """The author's choices for a new exercise.

    ``typed`` has the cells of the author's own table, if it is another one than the robot's.
    """

    title: str
    source: str
    convention: Convention = Convention.STANDARD
    remarks: Sequence[str] = ()
    typed: Sequence[Row[str]] = ()


def lettered(robot: HomeRobot) -> HomeRobot:
    """Return the robot with a letter for each length that is not 0, such as a2 and d4.

    A length along the axis of a sliding joint gets h3 instead of d3, which is its variable.
    """
    table = robot.table.copy()
    letters, lengths = {}, {}
    for i, j in np.argwhere(np.abs(table) > _NO_LENGTH).tolist():
        if j not in (A, D):
            continue
        slides = j == D and robot.structure[i : i + 1] == "P"
        name = f"{'h' if slides else COLUMNS[j]}{i + 1}"
        letters[i, j] = {name: math.copysign(1.0, table[i, j])}
        lengths[name] = abs(float(table[i, j]))
        table[i, j] = 0
    return replace(robot, table=table, letters=letters, lengths=lengths)


def exercise_text(robot: HomeRobot, draft: Draft) -> str:
    """Return an exercise file that asks for the table and the pose of the robot."""
    statement = home_statement(robot, draft.convention)
    rows = rows_in(robot, draft.convention)
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
joints = {json.dumps(robot.variables)}
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
{_typed_check(draft.typed)}{_equivalent_check(robot, draft.convention)}"""


def _answer(rows: Sequence[Row[str]]) -> str:
    lines = ["a, alpha, d, theta", *(", ".join(row) for row in rows)]
    return '"""\n' + "\n".join(lines) + '\n"""'


def _typed_check(typed: Sequence[Row[str]]) -> str:
    if not typed:
        return ""
    return f"""
[[checks]]
title = "The table as it was imported"
kind = "equivalent"
answers.table = {_answer(typed)}
"""


def _equivalent_check(robot: HomeRobot, convention: Convention) -> str:
    """Return a check with another valid table, in which x1 is reversed."""
    # This table is valid, too.
    if len(robot.table) < _ROWS_TO_TURN:
        return ""
    table = robot.table.copy()
    table[0, [A, ALPHA]] *= -1
    table[0, THETA] += math.pi
    table[1, THETA] -= math.pi
    letters = dict(robot.letters)
    if (0, A) in letters:
        letters[0, A] = {name: -factor for name, factor in letters[0, A].items()}
    rows = rows_in(replace(robot, table=table, letters=letters), convention)
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
        a, alpha = robot.start
        first = sum_text(robot.letters.get((-1, A), {}), exact_text(a)), angle_text(alpha)
        rows[0] = (*first, *rows[0][2:])
        if set(rows[-1]) == {"0"}:
            rows.pop()
    return rows


def _level(robot: HomeRobot) -> str:
    return "industrial" if len(robot.structure) >= _INDUSTRIAL else "arms"


def _summary(robot: HomeRobot) -> str:
    lengths = "lengths as letters" if robot.letters else "lengths in metres"
    return f"{len(robot.structure)} joints ({robot.structure}), {lengths}."


def _rows(robot: HomeRobot) -> list[Row[str]]:
    rows = []
    for i, row in enumerate(robot.table.tolist()):
        sums: list[dict[str, float]] = [dict(robot.letters.get((i, j), {})) for j in range(4)]
        if i < len(robot.structure):
            j = D if robot.structure[i] == "P" else THETA
            sums[j] = {robot.variables[i]: 1.0, **sums[j]}
        cells = zip(sums, row, strict=True)
        a, alpha, d, theta = (
            sum_text(letters, angle_text(number) if j in (ALPHA, THETA) else exact_text(number))
            for j, (letters, number) in enumerate(cells)
        )
        rows.append((a, alpha, d, theta))
    return rows


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
    for i, kind in enumerate(robot.structure):
        if kind == "P":
            lines.append(
                f'{robot.variables[i]} = {{ kind = "length", unit = "m", range = [0.1, 0.6], '
                f'description = "displacement of joint {i + 1}" }}'
            )
    along = {name for (_, j), letters in robot.letters.items() if j == D for name in letters}
    across = {name for (_, j), letters in robot.letters.items() if j == A for name in letters}
    for name, length in robot.lengths.items():
        low, high = (exact_text(float(f"{factor * length:.3g}")) for factor in (0.7, 1.3))
        meaning = _MEANINGS["a" if name in across else "d"]
        if name in across & along:
            meaning = "length of links"
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
