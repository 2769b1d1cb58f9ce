"""Test the valid table that is nearest to a wrong one."""

from collections.abc import Mapping
from itertools import product

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport

from tests.grading.support.submitting import Make, cell, graded, graded_table, not_correct, one_part

# --- A table in the wrong convention is compared with the intended table


def test_a_table_in_the_other_convention_is_judged_by_the_intended_one(
    catalogue: Mapping[str, Exercise],
) -> None:
    # The answer has modified rows, with z2 reversed; the exercise expects standard rows.
    report = graded_table(
        catalogue["stanford-arm"],
        [
            ("0", "0", "0", "theta1"),
            ("0", "-90deg", "d2", "theta2"),
            ("0", "-90deg", "-d3", "0"),
            ("0", "180deg", "0", "theta4"),
            ("0", "-90deg", "0", "theta5"),
            ("0", "90deg", "d6", "theta6"),
        ],
    )
    assert [m.code for m in report.feedback] == ["other_convention", "own_frame_choice"]
    assert "let z2 point the opposite way" in report.feedback[1].message
    # Row i should have the α that the student wrote in row i + 1.
    assert set(not_correct(report)) == {(row, "alpha") for row in ("1", "3", "4", "5", "6")}


# --- If one cell of a table is wrong, only this cell is marked wrong

# The robot's axes are skew, so that no other cell can repair the table.

SKEW = """
[robot]
structure = "RRRR"
convention = "standard"
joints = ["theta1", "theta2", "theta3", "theta4"]
table = [
    ["l1", "70deg", "l2", "theta1"], ["l2", "50deg", "l1", "theta2"],
    ["l1", "-80deg", "2*l2", "theta3"], ["l2", "40deg", "l1", "theta4"],
]
[symbols]
l1 = { kind = "length", description = "a length" }
l2 = { kind = "length", description = "a length" }
"""
PARALLEL = """
[robot]
structure = "RPPR"
convention = "modified"
joints = ["q1", "q2", "q3", "q4"]
table = [
    ["0", "0", "0.80", "q1 + 90deg"], ["0.47", "0", "q2 + 0.58", "0"], ["0.3", "0", "q3", "0"],
    ["0", "0", "0", "q4"],
]
"""
COLUMNS = ("a", "alpha", "d", "theta")
# A valid table with z1, z3 and x2 reversed, row by row.
TURNED_OVER = [
    ["l1", "-110deg", "l2", "theta1"],
    ["-l2", "130deg", "-l1", "-theta2 + 180deg"],
    ["l1", "100deg", "2*l2", "theta3 - 180deg"],
    ["l2", "-140deg", "-l1", "-theta4"],
]
SLIPS = ("l1 + 0.3", "21deg", "l2 - 0.2", "theta{} + 31deg")


def policy(
    base: str, tool: str, directions: str, robot: str = SKEW, convention: str = "standard"
) -> str:
    fields = f'convention = "{convention}"\nframes = "free"\nbase = "{base}"\ntool = "{tool}"'
    return one_part("dh_table", f'{fields}\ndirections = "{directions}"', robot)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("directions", ["given", "free"])
@pytest.mark.parametrize("tool", ["given", "free"])
@pytest.mark.parametrize("base", ["given", "free"])
def test_only_the_cell_with_the_slip_is_wrong(
    make_exercise: Make, base: str, tool: str, directions: str
) -> None:
    exercise = make_exercise(policy(base, tool, directions))
    right = [dict(zip(COLUMNS, row, strict=True)) for row in TURNED_OVER]
    assert not_correct(graded(exercise, {"rows": right})) == {}
    for i in range(4):
        for column, slip in zip(COLUMNS, SLIPS, strict=True):
            if base == "free" and i == 0 and column in ("d", "theta"):
                continue  # frame 0 may lie anywhere on the first axis
            if tool == "free" and i == 3:
                continue  # the end effector may lie anywhere
            rows = [dict(row) for row in right]
            rows[i][column] = slip.format(i + 1)
            wrong = not_correct(graded(exercise, {"rows": rows}))
            assert list(wrong) == [(str(i + 1), column)]


@pytest.mark.parametrize("base", ["given", "free"])
def test_a_wrong_variable_is_found_if_its_constant_is_right(make_exercise: Make, base: str) -> None:
    exercise = make_exercise(policy(base, "free", "given"))
    rows = [dict(zip(COLUMNS, row, strict=True)) for row in TURNED_OVER]
    rows[1]["theta"] = "theta2 + 180deg"
    assert list(not_correct(graded(exercise, {"rows": rows}))) == [("2", "theta")]
    rows[1]["theta"] = "180deg"
    assert list(not_correct(graded(exercise, {"rows": rows}))) == [("2", "theta")]


def test_only_the_variable_is_wrong_if_any_constant_is_valid(make_exercise: Make) -> None:
    # If the base is free, any constant in row 1 is valid, so the student's constant is kept.
    exercise = make_exercise(policy("free", "free", "given"))
    rows = [dict(zip(COLUMNS, row, strict=True)) for row in TURNED_OVER]
    rows[0]["theta"] = "-theta1 + 23deg"
    report = graded(exercise, {"rows": rows})
    assert list(not_correct(report)) == [("1", "theta")]
    [finding] = report.rows[0].cells[3].feedback
    assert finding.code == "joint_variable_sign"
    assert "theta1 + 23deg" in str(finding)


@pytest.mark.parametrize("tool", ["given", "free"])
@pytest.mark.parametrize("base", ["given", "free"])
def test_a_table_with_a_number_out_of_bounds_is_not_repaired(
    make_exercise: Make, base: str, tool: str
) -> None:
    exercise = make_exercise(policy(base, tool, "free"))
    for i, text in product((1, 3), ("1e308", "1e160", "1/0", "theta1^2")):
        rows = [dict(zip(COLUMNS, row, strict=True)) for row in TURNED_OVER]
        rows[i]["a"] = text
        assert (str(i + 1), "a") in not_correct(graded(exercise, {"rows": rows}))


def test_one_cell_is_wrong_between_moved_prismatic_axes(make_exercise: Make) -> None:
    # The two prismatic axes were moved, so that a search cannot find their intended places.
    exercise = make_exercise(policy("free", "given", "given", PARALLEL, "modified"))
    table = [
        ("-0.44", "0", "1.06", "q1 + 1.29984947646"),
        ("-0.18681541692", "pi", "-q2 + 0.22", "-2.35297388941"),
        ("-0.94021274188", "pi", "q3 + 0.44", "-2.08202703907"),
        ("-0.28", "0", "0.36", "q4 - pi/2"),
    ]
    rows = [dict(zip(COLUMNS, row, strict=True)) for row in table]
    assert not_correct(graded(exercise, {"rows": rows})) == {}
    rows[3]["a"] = "0.28"
    assert len(not_correct(graded(exercise, {"rows": rows}))) == 1


# --- If a slip can be repaired in several cells, the likeliest cell is marked wrong

# The first three axes of the RRRP arm are parallel, and z3 and z4 point down. Therefore the pose
# contains only the sum d1 + d2 − d3 − d4 = l1 − l4 − q4 (Robotic Fundamentals, Forward Kinematics,
# Example 2).

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
