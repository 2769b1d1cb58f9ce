"""Explain tables with two slips."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict
from dh_grader.grading.report import messages_of

from tests.grading.support.submitting import graded_table, not_correct

STANFORD = [
    ("0", "-90deg", "0", "theta1"),
    ("0", "90deg", "d2", "theta2"),
    ("0", "0", "d3", "0"),
    ("0", "-90deg", "0", "theta4"),
    ("0", "90deg", "0", "theta5"),
    ("0", "0", "d6", "theta6"),
]
RRRP = [
    ("l2", "0", "l1", "q1"),
    ("l3", "180deg", "0", "q2"),
    ("0", "0", "l4", "q3"),
    ("0", "0", "q4", "0"),
]
COLUMNS = ("a", "alpha", "d", "theta")


@pytest.mark.parametrize(
    ("name", "table", "row", "other", "code"),
    [
        # Row 2 of the Stanford arm comes before its sliding joint.
        ("stanford-arm", STANFORD, 2, (1, 1, "90deg"), "sign"),
        ("stanford-arm", STANFORD, 2, (4, 1, "90deg"), "sign"),
        ("stanford-arm", STANFORD, 6, (2, 3, "theta1"), "joint_variable_index"),
        ("rrrp", RRRP, 1, (4, 2, "-q4"), "joint_variable_sign"),
    ],
)
def test_an_exchange_is_named_beside_another_slip(
    catalogue: Mapping[str, Exercise],
    name: str,
    table: list[tuple[str, ...]],
    row: int,
    other: tuple[int, int, str],
    code: str,
) -> None:
    rows = [list(each) for each in table]
    rows[row - 1][0], rows[row - 1][2] = rows[row - 1][2], rows[row - 1][0]
    i, column, text = other
    rows[i - 1][column] = text
    report = graded_table(catalogue[name], rows)
    codes = [message.code for message, _, _ in messages_of(report) if message.severity == "error"]
    assert sorted(codes) == sorted(["columns_swapped", code])
    wrong = {(str(row), "a"), (str(row), "d"), (str(i), COLUMNS[column])}
    assert not_correct(report) == dict.fromkeys(wrong, Verdict.INCORRECT)


def test_a_missing_offset_is_no_exchange(catalogue: Mapping[str, Exercise]) -> None:
    rows = [list(row) for row in STANFORD]
    rows[1][2], rows[0][1] = "0", "90deg"
    report = graded_table(catalogue["stanford-arm"], rows)
    codes = {message.code for message, _, _ in messages_of(report)}
    assert "columns_swapped" not in codes
