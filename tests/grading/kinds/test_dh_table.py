"""Tables that were once graded wrongly."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Correction, PartReport
from dh_grader.grading.report import MAX_REPAIRS

from tests.grading.support.robots import EXACT, STANFORD
from tests.grading.support.submitting import graded_table, handed_in, not_correct, part, table

Rows = list[tuple[str, str, str, str]]

# The exercise, the table, and the cells that are wrong in it.
BLAMED: dict[str, tuple[str, Rows, list[tuple[str, str]]]] = {
    "a sliding joint's sign, in a small robot": (
        "scara",
        [
            ("a1", "0", "0", "theta1"),
            ("a2", "180deg", "0", "theta2"),
            ("0", "0", "-d3", "0"),
            ("0", "0", "d4", "theta4"),
        ],
        [("3", "d")],
    ),
    "a sliding joint's variable is nowhere, beside huge offsets": (
        "scara",
        [
            ("a1", "0", "0", "theta1"),
            ("a2", "180deg", "0", "theta2"),
            ("0", "0", "9e8", "0"),
            ("0", "0", "d4 - 9e8", "theta4"),
        ],
        [("3", "d")],
    ),
    "a foreign variable, small enough to be rounding": (
        "stanford-arm",
        [
            ("0", "-pi/2", "0", "theta1 + 0.0005*theta2"),
            ("0", "1.57 + 0.0001*theta1", "d2", "theta2"),
            *EXACT.rows(STANFORD)[2:],
        ],
        [("1", "theta"), ("2", "alpha")],
    ),
    "a number beside the variable, small enough to be rounding": (
        "stanford-arm",
        [
            *EXACT.rows(STANFORD)[:2],
            ("0", "0", "d3 + 0.0003", "0"),
            *EXACT.rows(STANFORD)[3:],
        ],
        [("3", "d")],
    ),
}


@pytest.mark.parametrize(("exercise", "rows", "wrong"), BLAMED.values(), ids=list(BLAMED))
def test_only_these_cells_are_wrong(
    exercise: str, rows: Rows, wrong: list[tuple[str, str]], catalogue: Mapping[str, Exercise]
) -> None:
    assert list(not_correct(graded_table(catalogue[exercise], rows))) == wrong


def test_a_millimetre_beside_a_thousand_kilometres_is_wrong(
    catalogue: Mapping[str, Exercise],
) -> None:
    # Only the sum of the two offsets counts, so either row may be the wrong one.
    rows = [("a1", "0", "1e6", "theta1"), ("a2", "0", "-1e6 + 0.0009", "theta2")]
    wrong = list(not_correct(graded_table(catalogue["planar-rr"], rows)))
    assert wrong in ([("1", "d")], [("2", "d")])


def test_an_unread_cell_makes_no_other_wrong(catalogue: Mapping[str, Exercise]) -> None:
    # If the unread cell in row 3 is d3 + 0.5, then row 4 is correct.
    rows = [
        ("a1", "0", "0", "theta1"),
        ("a2", "pi", "0", "theta2"),
        ("0", "0", "", "0"),
        ("0", "0", "d4 - 0.5", "theta4"),
    ]
    assert list(not_correct(graded_table(catalogue["scara"], rows))) == [("3", "d")]


def codes(report: PartReport) -> list[str]:
    return [message.code for message in report.feedback]


def test_a_missing_row_in_the_middle_is_found_by_the_variables(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [("0", "0", "0", "q1"), ("l2", "0", "0", "q3"), ("l3", "0", "0", "0")]
    report = graded_table(catalogue["planar-rrr"], rows)
    assert codes(report) == ["missing_row", "rows_matched"]
    # Rows 2, 3 and e have a length as a content cell. With a fifth for each row these are 3.8 units
    # of 8 / 3.8, about 2 points; each row shares in the other 2 points.
    assert report.points == 8 - (2 + 0.5)


def test_an_axis_with_one_offset_gets_no_message_on_sums(catalogue: Mapping[str, Exercise]) -> None:
    rows = [*EXACT.rows(STANFORD)[:5], ("0", "0", "0", "theta6")]
    report = graded_table(catalogue["stanford-arm"], rows)
    [message] = [m.message for cell in report.rows[5].cells for m in cell.feedback]
    assert "sum" not in message


def test_frames_that_miss_the_tool_are_not_a_valid_choice(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [
        ("0", "0", "l1", "q1"),
        ("l1", "0", "0", "q2"),
        ("l3", "180deg", "l4", "-q3"),
        ("0.7", "0", "q4", "0"),
    ]
    assert codes(graded_table(catalogue["rrrp-proximal"], rows)) == ["tool_not_reached"]


# The Stanford arm with the wrong sign of every α.
SIGNS_TURNED = [
    ("0", "90deg", "0", "theta1"),
    ("0", "-90deg", "d2", "theta2"),
    ("0", "0", "d3", "0"),
    ("0", "90deg", "0", "theta4"),
    ("0", "-90deg", "0", "theta5"),
    ("0", "0", "d6", "theta6"),
]


def test_the_cells_agree_with_a_slip_of_the_whole_table(catalogue: Mapping[str, Exercise]) -> None:
    # Two half turns of θ would also repair the table, but the slip is in the signs of α.
    report = graded_table(catalogue["stanford-arm"], SIGNS_TURNED)
    assert codes(report) == ["column_sign"]
    assert set(not_correct(report)) == {(row, "alpha") for row in "1245"}
    assert not [m.code for row in report.rows for cell in row.cells for m in cell.feedback]
    assert {place.row: place.correction for place in report.feedback[0].places or ()} == {
        "1": Correction("-90deg", r"-90^{\circ}"),
        "2": Correction("90deg", r"90^{\circ}"),
        "4": Correction("-90deg", r"-90^{\circ}"),
        "5": Correction("90deg", r"90^{\circ}"),
    }


def test_two_half_turns_are_not_a_slip_of_the_whole_table(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [list(row) for row in EXACT.rows(STANFORD)]
    rows[0][3], rows[5][3] = "theta1 + pi", "theta6 + pi"
    report = graded_table(catalogue["stanford-arm"], rows)
    assert codes(report) == []
    assert list(not_correct(report)) == [("1", "theta"), ("6", "theta")]
    told = [(row.label, m.code) for row in report.rows for c in row.cells for m in c.feedback]
    assert told == [("1", "half_turn"), ("6", "half_turn")]


def test_the_number_of_repaired_cells_is_bounded(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [[f"(tehta1 + {i}.{j}" for j in range(4)] for i in range(7)]
    report = part(handed_in(catalogue["baxter-left-arm"], {"table": table(rows)}), "table")
    messages = [m for row in report.rows for cell in row.cells for m in cell.feedback]
    helped = [(m.suggestion or "").startswith("(theta1 + ") for m in messages]
    assert helped == [True] * MAX_REPAIRS + [False] * (28 - MAX_REPAIRS)


def test_rounded_angles_and_a_fixed_row_raise_no_error(catalogue: Mapping[str, Exercise]) -> None:
    # Rows are compared as objects, because comparing the arrays in them would raise an error.
    rows = [
        ("0", "0", "l1", "q1"),
        ("l2", "3.14", "0", "-q2"),
        ("l3", "0", "l4", "-q3"),
        ("0", "0", "q4 + l1", "0"),
        ("0", "0", "0", "1.57"),
    ]
    assert not_correct(graded_table(catalogue["rrrp-proximal"], rows))


def test_a_value_under_an_unknown_name_is_not_missing(
    catalogue: Mapping[str, Exercise],
) -> None:
    answer = table(EXACT.rows(STANFORD))
    answer["rows"][1]["alpha [rad]"] = answer["rows"][1].pop("alpha")
    report = part(handed_in(catalogue["stanford-arm"], {"table": answer}), "table")
    [message] = report.rows[1].cells[1].feedback
    assert message.code == "wrong_shape"
