"""A table in the wrong convention is compared with the intended table."""

from collections.abc import Mapping

from dh_grader.catalogue import Exercise

from tests.grading.support.submitting import graded_table, not_correct


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
