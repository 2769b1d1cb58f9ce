"""Choose the joint of a table row if several are possible."""

from collections.abc import Mapping

from dh_grader.catalogue import Exercise

from tests.grading.support.submitting import graded_table, not_correct


def test_a_row_of_zeros_may_have_a_missing_value(
    catalogue: Mapping[str, Exercise],
) -> None:
    # z3 and z4 point up, so that row e must turn the last frame over, but its α is 0.
    report = graded_table(
        catalogue["rrrp-proximal"],
        [
            ("0", "0", "l1", "q1"),
            ("l2", "0", "0", "q2"),
            ("l3", "0", "-l4", "-q3"),
            ("0", "0", "-q4", "0"),
            ("0", "0", "0", "0"),
        ],
    )
    assert list(not_correct(report)) == [("e", "alpha")]
