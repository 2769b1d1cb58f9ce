"""An exercise about the SCARA arm, in four parts."""

from collections.abc import Sequence
from typing import Any

from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Submission, Verdict, grade

SCARA = """
title = "SCARA"
source = "SHV, pp. 91-93"
statement = "As in the book."

[robot]
structure = "RRPR"
convention = "standard"
joints = ["theta1", "theta2", "d3", "theta4"]
table = [
    ["a1", "0", "0", "theta1"],
    ["a2", "180deg", "0", "theta2"],
    ["0", "0", "d3", "0"],
    ["0", "0", "d4", "theta4"],
]

[symbols]
a1 = { kind = "length", description = "link 1" }
a2 = { kind = "length", description = "link 2" }
d4 = { kind = "length", description = "tool" }

[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
points = 8
convention = "standard"
frames = "free"

[[parts]]
id = "links"
kind = "link_transforms"
title = "Link transforms"
points = 8
convention = "standard"
frames = "free"
follows = "table"

[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
points = 8
follows = "links"

[[parts]]
id = "position"
kind = "position"
title = "Position"
points = 3
follows = "pose"
"""

Row = tuple[str, str, str, str]
TABLE: list[Row] = [
    ("a1", "0", "0", "q1"),
    ("a2", "pi", "0", "q2"),
    ("0", "0", "d3", "0"),
    ("0", "0", "d4", "q4"),
]
# The printed form of A_i (SHV, eq. 3.10), filled in by hand.
A1 = [["c1", "-s1", "0", "a1*c1"], ["s1", "c1", "0", "a1*s1"], ["0", "0", "1", "0"], list("0001")]
A2 = [["c2", "s2", "0", "a2*c2"], ["s2", "-c2", "0", "a2*s2"], ["0", "0", "-1", "0"], list("0001")]
A3 = [list("1000"), list("0100"), ["0", "0", "1", "d3"], list("0001")]
A4 = [["c4", "-s4", "0", "0"], ["s4", "c4", "0", "0"], ["0", "0", "1", "d4"], list("0001")]
LINKS = [A1, A2, A3, A4]
IDENTITY = [list("1000"), list("0100"), list("0010"), list("0001")]


def a2_with(length: str) -> list[list[str]]:
    return [[cell.replace("a2", length) for cell in row] for row in A2]


def pose_with(length: str) -> list[list[str]]:
    turn = "q1 + q2 - q4"
    return [
        [f"cos({turn})", f"sin({turn})", "0", f"a1*c1 + {length}*c12"],
        [f"sin({turn})", f"-cos({turn})", "0", f"a1*s1 + {length}*s12"],
        ["0", "0", "-1", "-d3 - d4"],
        list("0001"),
    ]


def table(rows: Sequence[Sequence[str]]) -> dict[str, Any]:
    return {"rows": [dict(zip(("a", "alpha", "d", "theta"), row, strict=True)) for row in rows]}


def graded(exercise: Exercise, **answers: object) -> dict[str, PartReport]:
    return {part.part: part for part in grade(exercise, Submission(answers)).parts}


def wrong_cells(part: PartReport) -> set[tuple[str, str]]:
    return {
        (row.label, cell.label)
        for row in part.rows
        for cell in row.cells
        if cell.verdict is not Verdict.CORRECT
    }
