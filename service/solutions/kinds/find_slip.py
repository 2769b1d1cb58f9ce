"""The model answer of kind ``find_slip``: the wrong cells, and the table without the slip."""

from service.catalogue import Exercise
from service.catalogue.parts.find_slip import FindSlipSpec
from service.grading.kinds.find_slip import slip_of
from service.kinematics.chain import COLUMNS
from service.learning.table_texts import as_rows
from service.solutions import layout
from service.solutions.model_solution import PrintedAnswer
from service.solutions.work import Work


def answer_find_slip(part: FindSlipSpec, work: Work) -> PrintedAnswer:
    """Return the cells to mark, and the corrected table."""
    robot = work.exercise.robot
    table = robot.tables[part.convention]
    drawn = slip_of(part, work.exercise)
    marks = [f"{table.labels[i]}.{COLUMNS[j]}" for i, j in sorted(drawn.cells)]
    rows = [work.table_row(row) for row in table.rows]
    printed = layout.table(rows, table.labels, part.convention, named=False)
    return layout.marked(marks, printed)


def lazy_find_slip(part: FindSlipSpec, exercise: Exercise) -> list[object]:
    """Return the given table unchanged, with no cell marked."""
    return [{"table": {"rows": as_rows(slip_of(part, exercise).texts)}}]
