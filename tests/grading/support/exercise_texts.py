"""Write exercise files with a single part for tests."""

from collections.abc import Callable

from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport

from tests.grading.support.robots import AngleUnit
from tests.grading.support.submitting import handed_in, part

Make = Callable[[str], Exercise]

HEAD = """
title = "Made for a test"
source = "none"
statement = "Nothing to see."
"""

# Spatial RRR: Robotic Fundamentals (UMFM4X-15-M), Forward Kinematics, Example 3.
SPATIAL_RRR = """
[robot]
structure = "RRR"
convention = "standard"
joints = ["theta1", "theta2", "theta3"]
table = [
    ["R", "90deg", "0", "theta1"], ["L1", "0", "0", "theta2"], ["L2", "0", "0", "theta3"],
]
[symbols]
R = { kind = "length", description = "radius" }
L1 = { kind = "length", description = "first link" }
L2 = { kind = "length", description = "second link" }
"""

ANGLES = """
[symbols]
phi = { kind = "angle", description = "an angle" }
psi = { kind = "angle", description = "an angle" }
l = { kind = "length", description = "a length" }
k = { kind = "number", description = "a number" }
"""


def one_part(kind: str, fields: str, setting: str = ANGLES) -> str:
    """Return the text of an exercise with one part of this kind."""
    part_text = f'[[parts]]\nid = "it"\nkind = "{kind}"\ntitle = "It"\npoints = 6\n{fields}\n'
    return HEAD + setting + part_text


def graded(exercise: Exercise, answer: object, angle_unit: AngleUnit = "radians") -> PartReport:
    """Grade an answer to the exercise's only part, and return the report on the part."""
    return part(handed_in(exercise, {"it": answer}, angle_unit), "it")


def all_codes(report: PartReport) -> set[str]:
    messages = [*report.feedback]
    for row in report.rows:
        messages += row.feedback
        for cell in row.cells:
            messages += cell.feedback
    return {message.code for message in messages}
