"""The explanation of a whole table, beside the judgement of its cells."""

from collections.abc import Callable

from service.catalogue import Exercise
from service.grading import Verdict
from tests.grading.support.submitting import handed_in, part, table

SKEW_RPR = """
title = "Skew RPR"
source = "made for a test"
statement = "The table of the arm."

[robot]
structure = "RPR"
convention = "standard"
joints = ["q1", "q2", "q3"]
table = [["l1", "pi/3", "h", "q1"], ["l2", "-pi/4", "q2", "pi/6"], ["l3", "pi/2", "h/2", "q3"]]

[symbols]
l1 = { kind = "length", description = "length", range = [0.5, 2.5] }
l2 = { kind = "length", description = "length", range = [0.5, 2.5] }
l3 = { kind = "length", description = "length", range = [0.5, 2.5] }
h = { kind = "length", description = "length", range = [0.5, 2.5] }

[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
convention = "either"
frames = "free"
"""


def test_an_explanation_of_more_rows_than_were_judged(
    make_exercise: Callable[[str], Exercise],
) -> None:
    # Reversed and with a row too many: mostly wrong, so judged by the reference's three rows.
    rows = [
        ("l3", "pi/2", "0", "0"),
        ("l1", "pi/3", "q2", "pi/6"),
        ("l2", "-pi/4", "h/2", "q3"),
        ("0", "0", "h", "q1"),
    ]
    report = part(handed_in(make_exercise(SKEW_RPR), {"table": table(rows)}, "degrees"), "table")
    assert report.verdict is Verdict.PARTIAL
