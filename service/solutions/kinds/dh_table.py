"""The model answer of kind ``dh_table``: the reference table in the requested convention."""

from service.catalogue import Exercise
from service.catalogue.parts.dh_table import DhTableSpec
from service.kinematics.dh import Convention
from service.solutions import layout
from service.solutions.model_solution import PrintedAnswer
from service.solutions.work import Work


def answer_dh_table(part: DhTableSpec, work: Work) -> PrintedAnswer:
    """Return the table. If the part accepts either convention, the table names its convention."""
    robot = work.exercise.robot
    asked = part.convention
    convention = asked if isinstance(asked, Convention) else robot.convention
    table = robot.tables[convention]
    rows = [work.table_row(row) for row in table.rows]
    return layout.table(rows, table.labels, convention, named=asked == "either")


def lazy_dh_table(part: DhTableSpec, exercise: Exercise) -> list[object]:
    """Return a table with the joint variables in their columns and 0 elsewhere."""
    robot, asked = exercise.robot, part.convention
    convention = asked if isinstance(asked, Convention) else robot.convention
    named = {"convention": convention.value} if asked == "either" else {}
    return [{"rows": robot.tables[convention].lazy_rows, **named}]
