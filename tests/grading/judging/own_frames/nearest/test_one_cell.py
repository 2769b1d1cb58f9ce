"""If one cell of a table is wrong, only this cell is marked wrong."""

# The robot's axes are skew, so that no other cell can repair the table.

from itertools import product

import pytest

from tests.grading.support.exercise_texts import Make, graded, one_part
from tests.grading.support.submitting import not_correct

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
