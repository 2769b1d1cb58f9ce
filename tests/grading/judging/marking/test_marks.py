"""Compute by hand the cost of slips in textbook tables."""

from collections.abc import Mapping

import pytest

from service.catalogue import Exercise
from service.grading import CellReport, PartReport, RowReport, Verdict
from service.grading.lost_points import lost_in_row
from tests.grading.support.robots import COLUMNS, EXACT, SCARA, STANFORD, Row
from tests.grading.support.submitting import graded_table, handed_in, not_correct, part
from tests.grading.support.worth import worth_of_rows

# Content cells of the SCARA, by hand: a1; a2 and the half turn; none; d4. Each row has a fifth
# more.
SCARA_WORTH = 1.2 + 2.2 + 0.2 + 1.2


def codes(report: PartReport) -> list[str]:
    return [message.code for message in report.feedback]


def stanford(*changes: tuple[int, int, str]) -> list[Row]:
    rows = [list(row) for row in EXACT.rows(STANFORD)]
    for i, j, text in changes:
        rows[i][j] = text
    return [(a, alpha, d, theta) for a, alpha, d, theta in rows]


def test_a_slip_of_the_whole_table_is_charged_once(catalogue: Mapping[str, Exercise]) -> None:
    # Wrong signs of all twists cost a quarter of the points; four wrong cells would cost more.
    turned = {"pi/2": "-pi/2", "-pi/2": "pi/2", "0": "0"}
    rows = [(a, turned[alpha], d, theta) for a, alpha, d, theta in EXACT.rows(STANFORD)]
    report = graded_table(catalogue[STANFORD.exercise], rows)
    assert codes(report) == ["column_sign"]
    assert report.points == pytest.approx(12 * 3 / 4)
    assert sum(row.points for row in report.rows) == pytest.approx(9, abs=1e-5)


@pytest.mark.parametrize(("column", "rows"), [("d", "236"), ("theta", "12456")])
def test_the_wrong_sign_of_a_column_with_joint_variables_is_charged_once(
    column: str, rows: str, catalogue: Mapping[str, Exercise]
) -> None:
    # The signs of all offsets or angles are wrong, those of the joint variables included.
    j = COLUMNS.index(column)
    turned = [(int(i) - 1, j, f"-({EXACT.rows(STANFORD)[int(i) - 1][j]})") for i in rows]
    report = graded_table(catalogue[STANFORD.exercise], stanford(*turned))
    assert codes(report) == ["column_sign"]
    assert set(not_correct(report)) == {(row, column) for row in rows}
    assert report.points == pytest.approx(12 * 3 / 4)


def test_the_other_convention_costs_half(catalogue: Mapping[str, Exercise]) -> None:
    # The rows are those of the modified convention: a and α are one row later.
    rows = EXACT.rows(STANFORD)
    ends = [("0", "0"), *((a, alpha) for a, alpha, _, _ in rows)]
    moved = [(*ends[i], d, theta) for i, (_, _, d, theta) in enumerate(rows)]
    report = graded_table(catalogue[STANFORD.exercise], moved)
    assert "other_convention" in codes(report)
    assert report.points == pytest.approx(6)


def test_a_standard_table_is_named_if_the_row_of_the_tool_is_empty(
    catalogue: Mapping[str, Exercise],
) -> None:
    # The standard convention needs three rows; the fourth row of the form, e, is left empty.
    rows = [(f"l{i}", "0", "0", f"q{i}") for i in (1, 2, 3)]
    report = graded_table(catalogue["planar-rrr"], [*rows, ("", "", "", "")])
    assert codes(report) == ["other_convention"]
    assert report.points == 8 / 2
    assert report.rows[3].verdict is Verdict.MISSING


def test_a_slip_of_the_whole_table_costs_no_more_than_its_cells(
    catalogue: Mapping[str, Exercise],
) -> None:
    # The SCARA arm's table has only one twist, so wrong twists cost at most one cell.
    rows = [("a1", "0", "0", "theta1"), ("a2", "0", "0", "theta2"), *EXACT.rows(SCARA)[2:]]
    report = graded_table(catalogue[SCARA.exercise], rows)
    assert report.points == 8 - 1.75


def test_cancelling_offsets_do_not_make_a_slip_cheaper(catalogue: Mapping[str, Exercise]) -> None:
    # Offsets that cancel along parallel axes are right, but do not make a slip cheaper.
    rows = [("a1", "0", "0.4", "theta1"), ("a1", "pi", "-0.4", "theta2"), *EXACT.rows(SCARA)[2:]]
    report = graded_table(catalogue[SCARA.exercise], rows)
    assert report.points == 8 - 1.75
    assert [row.points == row.max_points for row in report.rows] == [True, False, True, True]


@pytest.mark.parametrize("extra", [("0", "0", "0", "0"), ("0.3", "0.5", "0.7", "0.9")])
@pytest.mark.parametrize("place", [0, 2, 6])
def test_an_extra_row_never_helps(
    extra: Row, place: int, catalogue: Mapping[str, Exercise]
) -> None:
    wrong = stanford((1, 1, "0"), (3, 1, "0"), (4, 1, "0"))
    without = graded_table(catalogue[STANFORD.exercise], wrong)
    wrong[place:place] = [extra] * 6
    report = graded_table(catalogue[STANFORD.exercise], wrong)
    assert report.points <= without.points + 1e-6


def test_rows_that_earn_nothing_are_not_partly_right(catalogue: Mapping[str, Exercise]) -> None:
    rows = stanford(*((i, j, "0.123") for i in range(6) for j in (1, 2)))
    report = graded_table(catalogue[STANFORD.exercise], rows)
    for row in report.rows:
        assert (row.verdict is Verdict.PARTIAL) <= (row.points > 0)


def test_the_worth_computed_by_hand_is_right() -> None:
    assert sum(worth_of_rows(SCARA)) == pytest.approx(SCARA_WORTH)
    assert sum(worth_of_rows(STANFORD)) == pytest.approx(7.2)


def test_lost_points_have_places(catalogue: Mapping[str, Exercise]) -> None:
    # Two cells of row 2 are wrong; row 3 holds only zeros.
    rows = [list(row) for row in EXACT.rows(SCARA)]
    rows[1][:2] = "a1", "0"
    report = graded_table(catalogue[SCARA.exercise], rows)
    [lost] = report.lost
    assert (lost.code, lost.row, lost.cells, lost.points) == ("cells", "2", ("a", "alpha"), 3.5)
    assert lost.message == "a and α in row 2"
    assert report.little_worth is not None
    assert (report.little_worth.rows, report.little_worth.points) == (("3",), 0.25)


def test_a_row_loses_no_more_than_it_is_worth(catalogue: Mapping[str, Exercise]) -> None:
    # A rotation about x is worth 2 points for four cells in rows 2 and 3. A wrong cell in row 1,
    # which is worth nothing, costs as much as one of them; rows 2 and 3 share the loss.
    matrix = [[1, 0, 1], [0, "cos(phi)", "-sin(phi)"], [0, "sin(phi)", "cos(phi)"]]
    report = handed_in(catalogue["fundamental-rotations"], {"about-x": matrix})
    about_x = part(report, "about-x")
    points = [(row.points, row.max_points) for row in about_x.rows]
    assert points == [(0, 0), (0.75, 1), (0.75, 1)]
    [lost] = about_x.lost
    assert (lost.code, lost.row, lost.points) == ("shared_by_rows", None, 0.5)


def test_a_slip_of_the_whole_table_is_lost_at_one_place(catalogue: Mapping[str, Exercise]) -> None:
    # Wrong signs of all twists cost a quarter of 12 points.
    turned = {"pi/2": "-pi/2", "-pi/2": "pi/2", "0": "0"}
    rows = [(a, turned[alpha], d, theta) for a, alpha, d, theta in EXACT.rows(STANFORD)]
    report = graded_table(catalogue[STANFORD.exercise], rows)
    assert [(each.code, each.row, each.points) for each in report.lost] == [("whole", None, 3.0)]


def test_a_right_table_has_lost_nothing(catalogue: Mapping[str, Exercise]) -> None:
    report = graded_table(catalogue[SCARA.exercise], EXACT.rows(SCARA))
    assert (report.lost, report.little_worth) == ((), None)


def test_a_single_value_has_lost_its_points_in_its_row() -> None:
    row = RowReport("3", Verdict.INCORRECT, 0.0, 1.0, (CellReport("3", Verdict.INCORRECT),))
    assert lost_in_row(row, 1.0).message == "row 3"
    mark = RowReport("marked", Verdict.INCORRECT, 0.0, 1.0, (CellReport("marked", row.verdict),))
    assert lost_in_row(mark, 1.0).message == "the mark"
