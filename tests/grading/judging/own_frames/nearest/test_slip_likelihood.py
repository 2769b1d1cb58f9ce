"""If a slip can be repaired in several cells, the likeliest cell is marked wrong."""

# The first three axes of the RRRP arm are parallel, and z3 and z4 point down. Therefore the pose
# contains only the sum d1 + d2 − d3 − d4 = l1 − l4 − q4 (Robotic Fundamentals, Forward Kinematics,
# Example 2).

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport

from tests.grading.support.submitting import cell, graded_table, not_correct

BLAMED: dict[str, tuple[tuple[str, str, str], str, str]] = {
    # d of rows 1 to 3; the row that is wrong; its right value
    "an offset forgotten, the reference's frames": (("l1", "0", "0"), "3", "l4"),
    "an offset added, the reference's frames": (("l1", "l3", "l4"), "2", "0"),
    "origin 1 elsewhere, the sign turned behind it": (("l1 + 0.2", "0.2", "l4"), "2", "-0.2"),
    "an offset at the wrong joint, its sign turned": (("l1 + l4", "0", "0"), "1", "l1 - l4"),
    "two origins elsewhere, a number that is none": (("l1 + l2", "-l2", "0.3"), "3", "l4"),
}


@pytest.mark.parametrize(("offsets", "row", "right"), BLAMED.values(), ids=list(BLAMED))
def test_the_likeliest_cell_is_wrong(
    offsets: tuple[str, str, str], row: str, right: str, catalogue: Mapping[str, Exercise]
) -> None:
    d1, d2, d3 = offsets
    report = graded_table(
        catalogue["rrrp"],
        [
            ("l2", "0", d1, "q1"),
            ("l3", "180deg", d2, "q2"),
            ("0", "0", d3, "q3"),
            ("0", "0", "q4", "0"),
        ],
    )
    assert list(not_correct(report)) == [(row, "d")]
    [message] = cell(report, row, "d").feedback
    assert "only the sum of the offsets along both counts" in message.message
    assert message.correction is not None
    assert message.correction.text == right


def messages(report: PartReport) -> list[str]:
    return [m.message for row in report.rows for cell in row.cells for m in cell.feedback]
