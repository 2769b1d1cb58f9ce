"""Test the points of parts, and that they add up."""

import json
import random
from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import replace
from typing import Any, Final

import pytest
from dh_grader.api.http import validated
from dh_grader.catalogue import Exercise, PartSpec
from dh_grader.grading import CellReport, Feedback, PartReport, RowReport, Severity, Verdict, grade
from dh_grader.grading.judging import Content, Judged
from dh_grader.grading.marks import has_earned, least_lost, part_report, steps_lost, unjudged_report
from dh_grader.grading.report import combined, little_worth, lost_in_row, without_places
from dh_grader.submissions.bodies import GradeRequest

from tests.grading.sums import run
from tests.grading.support.robots import COLUMNS, EXACT, SCARA, STANFORD, Row
from tests.grading.support.submitting import (
    graded_table,
    handed_in,
    not_correct,
    part,
    worth_of_rows,
)
from tests.shipped import shipped_exercises
from tests.solutions.solved import solved

# --- Compute by hand the cost of slips in textbook tables

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


VERDICTS = {
    "+": Verdict.CORRECT, "-": Verdict.INCORRECT, "?": Verdict.UNREADABLE, ".": Verdict.MISSING,
}  # fmt: skip
# The cells of the SCARA's table that need knowledge; a unit is 1.75 points, a row 0.25.
KNOWN = tuple(tuple(cell == "x" for cell in row) for row in ("x...", "xx..", "....", "..x."))
TABLE = Content(KNOWN, tuple((i,) * 4 for i in range(4)), besides=True)
RIGHT = "++++ ++++ ++++ ++++"
ONE, TWO = "-+++ ++++ ++++ ++++", "-+++ -+++ ++++ ++++"


def judged(verdicts: str, content: Content = TABLE, **more: Any) -> Judged:
    """Return the judgement with the verdicts of ``verdicts``: a word for each row."""
    rows = []
    for i, word in enumerate(verdicts.split(), start=1):
        each = [VERDICTS[sign] for sign in word]
        cells = tuple(map(CellReport, ("a", "alpha", "d", "theta"), each))
        rows.append(RowReport(str(i), combined(each), 0.0, 0.0, cells))
    return Judged(tuple(rows), content, **more)


@pytest.fixture
def table(catalogue: Mapping[str, Exercise]) -> PartSpec:
    """The part for the SCARA's table: 8 points, for what needs knowledge."""
    part = next(each for each in catalogue["scara"].parts if each.id == "table")
    assert (part.points, part.marking) == (8, "content")
    return part


# Verdicts, other fields of the judgement, and the points that each row loses.
LOSSES: list[tuple[str, dict[str, Any], list[float]]] = [
    (RIGHT, {}, [0, 0, 0, 0]),
    (ONE, {}, [1.75, 0, 0, 0]),
    # A cell that needs no knowledge costs a unit, too, but a row never loses more than it has.
    ("+-++ ++++ ++++ ++++", {}, [1.75, 0, 0, 0]),
    ("--++ ++++ ++++ ++++", {}, [2, 0, 0, 0]),
    ("++++ ++++ -+++ ++++", {}, [0, 0, 0.25, 0]),
    ("++++ --++ ++++ ++++", {}, [0, 3.5, 0, 0]),
    ("++++ ---+ ++++ ++++", {}, [0, 3.75, 0, 0]),
    # An empty cell costs as much as a wrong one.
    ("++++ +.++ ++++ ++++", {}, [0, 1.75, 0, 0]),
    ("++++ ++++ ++++ ....", {}, [0, 0, 0, 2]),
    # Unreadable cells that need no knowledge cost a fifth of a unit together.
    ("?+++ ++++ ++++ ++++", {}, [1.75, 0, 0, 0]),
    ("+?++ ++++ ++++ ++++", {}, [0.25, 0, 0, 0]),
    ("+??? ++++ ++++ ++++", {}, [0.25, 0, 0, 0]),
    ("++++ ++++ ???? ++++", {}, [0, 0, 0.25, 0]),
    ("???? ???? ???? ????", {}, [2, 3.75, 0.25, 2]),
    ("---- ---- ---- ----", {}, [2, 3.75, 0.25, 2]),
    # A slip that no cell shows costs a unit, of the rows with a mistake first.
    ("++++ -+++ ++++ ++++", {"slips": 1}, [0, 3.5, 0, 0]),
    ("+?++ ++++ ++++ ++++", {"slips": 1}, [2, 0, 0, 0]),
    # A slip of the whole answer costs its share, if its cells cost more.
    ("-+++ --++ ++++ ++-+", {"whole_cost": 0.25}, [0.5, 1.0, 0, 0.5]),
    (ONE, {"whole_cost": 0.25}, [1.75, 0, 0, 0]),
    (TWO, {"whole_cost": 0.5}, [1.75, 1.75, 0, 0]),
    # The cells may be explained more cheaply than they were judged.
    (TWO, {"lost": 1.0}, [1.0, 0.75, 0, 0]),
    (TWO, {"lost": 3.0}, [1.75, 1.75, 0, 0]),
    ("---- ++++ ++++ ++++", {"lost": 0.2}, [0.25, 0, 0, 0]),
    ("---- ---- ++++ ++++", {"lost": 2.2}, [1.25, 2.5, 0, 0]),
    # Limits by other judgements.
    (ONE, {"at_most": judged(TWO)}, [2, 1, 0.25, 0.25]),
    (TWO, {"at_most": judged(ONE)}, [1.75, 1.75, 0, 0]),
    (TWO, {"at_least": judged(ONE)}, [1.0, 0.75, 0, 0]),
    (ONE, {"at_least": judged(TWO)}, [1.75, 0, 0, 0]),
    (ONE, {"at_least": judged(RIGHT)}, [0.25, 0, 0, 0]),
    # With a row more than the limit, each wrong cell loses a unit at most.
    (ONE, {"at_most": judged(TWO), "needs_all": True}, [1.75, 0, 0, 0]),
    (TWO, {"at_most": judged(ONE), "needs_all": True}, [1.75, 1.75, 0, 0]),
    ("--++ ++++ ++++ ++++", {"at_most": judged("---- ---- ---- ----"), "needs_all": True},
     [2, 1, 0, 0.5]),
    # A wrong answer earns a unit at most for each cell that was written and is not lazy.
    (TWO, {"written": 2}, [1.75, 1.75, 0, 0]),
    (TWO, {"written": 4}, [1.75, 1.75, 0, 0]),
]  # fmt: skip


@pytest.mark.parametrize(("verdicts", "more", "lost"), LOSSES)
def test_the_points_that_each_row_loses(
    verdicts: str, more: dict[str, Any], lost: list[float], table: PartSpec
) -> None:
    answer = judged(verdicts, **more)
    report = part_report(table, answer)
    assert [row.max_points for row in report.rows] == [2, 3.75, 0.25, 2]
    found = [row.max_points - row.points for row in report.rows]
    assert sum(found) == sum(lost) == 8 - report.points
    assert sum(each.points for each in report.lost) == sum(lost)
    assert 0.25 * steps_lost(table, answer) == sum(lost)
    # Only the grading of later parts can say this.
    assert not report.follow_through
    if "at_most" not in more:
        assert found == lost


def test_a_lazy_answer_keeps_only_the_fifths_of_its_rows(table: PartSpec) -> None:
    for written, lost in ((0, 7.0), (1, 5.25), (3, 1.75)):
        assert part_report(table, judged(ONE, written=written)).points == 8 - lost
    # A slip of the whole answer may have moved the cells.
    moved = judged("---- ---- ---- ----", written=0, whole_cost=0.25)
    assert part_report(table, moved).points == 6
    assert part_report(table, judged(RIGHT, written=0)).points == 8


@pytest.mark.parametrize(
    ("answer", "lost"),
    [
        (judged(RIGHT), []),
        (judged(TWO), [("cells", "1", 1.75), ("cells", "2", 1.75)]),
        (judged(RIGHT, slips=2), [("outside_cells", None, 3.5)]),
        (judged(ONE, slips=1), [("cells", "1", 1.75), ("outside_cells", None, 1.75)]),
        (judged(RIGHT, slips=9), [("outside_cells", None, 8)]),
        (judged(TWO, whole_cost=0.25), [("whole", None, 2)]),
        (
            judged("---- ---- ++++ ++++", whole_cost=0.25, beside=judged(ONE)),
            # The first row loses 1.25 of its 2 points, and the other rows the rest.
            [("whole", None, 2), ("cells", "1", 1.25), ("shared_by_rows", None, 0.5)],
        ),
        (
            # The slip of the whole answer comes first, an extra row last. The rows lose 4.25, of
            # their 2 and 3.75: the first one 1.5 of its 1.75.
            judged("---- ---- ++++ ++++", whole_cost=0.1, beside=judged(ONE, slips=1)),
            [
                ("whole", None, 0.75),
                ("cells", "1", 1.5),
                ("shared_by_rows", None, 0.25),
                ("outside_cells", None, 1.75),
            ],
        ),
        (judged("---- ++++ ++++ ++++", whole_cost=0.25), [("cells", "1", 2)]),
        (judged(TWO, whole_cost=0.001), [("whole", None, 0.25)]),
        (judged(ONE, stands_still=True), [("no_motion", None, 8)]),
        (judged(RIGHT, slips=1, at_least=judged(RIGHT)), [("outside_cells", None, 0.25)]),
        # A quarter of a point is lost in one row, and none elsewhere.
        (judged(ONE, slips=1, at_least=judged(RIGHT)), [("cells", "1", 0.25)]),
        (judged(TWO, at_least=judged(RIGHT)), [("cells", "1", 0.25)]),
    ],
)
def test_each_loss_has_a_cause(
    answer: Judged, lost: list[tuple[str, str | None, float]], table: PartSpec
) -> None:
    report = part_report(table, answer)
    assert [(each.code, each.row, each.points) for each in report.lost] == lost
    assert report.points == 8 - sum(points for _, _, points in lost)


@pytest.mark.parametrize(
    ("marking", "verdicts", "points"),
    [
        ("whole", ONE, 0), ("whole", RIGHT, 8),
        ("rows", ONE, 6), ("rows", "---- ++++ ++++ ++++", 6), ("rows", TWO, 4),
        ("rows", "++++ ++++ ++++ ?+++", 6), ("rows", "---- ---- ---- ----", 0),
        # 8 points for 16 cells.
        ("cells", ONE, 7.5), ("cells", "---- ++++ +-++ ++++", 5.5), ("cells", RIGHT, 8),
    ],
)  # fmt: skip
def test_the_exercise_chooses_the_marking(
    marking: str, verdicts: str, points: float, table: PartSpec
) -> None:
    part = table.model_copy(update={"marking": marking})
    report = part_report(part, judged(verdicts))
    assert report.points == points
    if marking == "whole" and points == 0:
        assert [each.code for each in report.lost] == ["all_or_nothing"]
    assert report.little_worth is None
    # Other limits are for the marking by content.
    assert part_report(part, judged(verdicts, lost=0.2, written=0)).points == points
    assert least_lost(part, judged(verdicts), 2) == 0


def test_the_verdict_is_that_of_the_rows_and_the_points(table: PartSpec) -> None:
    for answer, verdict in (
        (judged(RIGHT), Verdict.CORRECT),
        (judged(RIGHT, slips=1), Verdict.PARTIAL),
        (judged(ONE), Verdict.PARTIAL),
        (judged("---- ---- ---- ----"), Verdict.INCORRECT),
        (judged("???? ???? ???? ????"), Verdict.UNREADABLE),
        (judged(".... .... .... ...."), Verdict.MISSING),
        # No cell is right, though the answer earns points.
        (judged("---- ---- ---- ----", whole_cost=0.25, slips=1), Verdict.INCORRECT),
        # Right cells that earn nothing make nothing partly right.
        (judged("-+++ --++ -+++ ++-+", stands_still=True), Verdict.INCORRECT),
    ):
        assert part_report(table, answer).verdict is verdict
    rows = part_report(table, judged("--++ +?++ -+++ ++++")).rows
    assert [row.verdict for row in rows] == [
        Verdict.INCORRECT, Verdict.PARTIAL, Verdict.INCORRECT, Verdict.CORRECT
    ]  # fmt: skip
    assert [row.points for row in rows] == [0, 2, 0, 2]


def test_rows_of_zeros_are_named_if_points_are_lost(table: PartSpec) -> None:
    told = part_report(table, judged(ONE)).little_worth
    assert told is not None
    assert (told.rows, told.points) == (("3",), 0.25)
    assert told.message.startswith("Row 3 is worth little: zeros")
    other = table.model_copy(update={"kind": "matrix"})
    assert part_report(other, judged(ONE)).little_worth is None
    assert part_report(table, judged(RIGHT)).little_worth is None
    assert part_report(table, judged("-+++ ++++ -+++ ++++")).little_worth is None
    # Rows that need knowledge are not named, though each is worth a twelfth.
    many = Content(((True, *(False,) * 3),) * 12, tuple((i,) * 4 for i in range(12)))
    part = table.model_copy(update={"points": 24})
    report = part_report(part, judged(" ".join(["-+++", *["++++"] * 11]), many))
    assert (report.points, report.little_worth) == (22, None)
    big = [RowReport("1", Verdict.CORRECT, p, p, ()) for p in (0.0, 1.0, 1.001)]
    told = little_worth(big, 8)
    assert told is not None
    # A row that is worth nothing, or more than an eighth of 8 points, is not named.
    assert (told.rows, told.points) == (("1",), 1.0)
    told = little_worth([big[1], replace(big[1], label="2")], 8)
    assert told is not None
    assert told.message.startswith("Rows 1 and 2 are worth little: zeros")
    wrong = [replace(big[1], verdict=Verdict.INCORRECT)]
    assert little_worth(wrong, 8) is None


def test_an_answer_has_earned_a_share_of_what_needs_knowledge(table: PartSpec) -> None:
    # Two units of 1.75 are lost: 4.5 of 8 are left, whatever the marking of the part.
    for spec in (table, table.model_copy(update={"marking": "whole"})):
        assert has_earned(spec, judged(TWO), 4.5 / 8)
        assert not has_earned(spec, judged(TWO), 4.6 / 8)
        assert has_earned(spec, judged(RIGHT), 1)
    # A rotation with a position must have earned more than the share.
    equal = Content(KNOWN[:2], ((0,) * 4, (1,) * 4), equal=True)
    assert part_report(table, judged("++++ ----", equal)).points == 4
    assert not has_earned(table, judged("++++ ----", equal), 0.5)
    assert has_earned(table, judged("++++ ----", equal), 0.49)


def test_a_wrong_row_loses_its_units_and_a_fifth_at_least(table: PartSpec) -> None:
    assert [least_lost(table, judged(ONE), cells) for cells in (0, 1, 2)] == [1, 8, 15]


def test_a_bottom_row_and_a_group_have_limits(table: PartSpec) -> None:
    # Each of six entries of a pose is worth a point. All entries of the bottom row, which is the
    # same in every pose, cost a fifth together.
    known = tuple(tuple(cell == "x" for cell in row) for row in ("xx.x", ".x..", "..xx", "...."))
    pose = Content(known, ((0,) * 4,) * 4, bottom=(3,))
    part = table.model_copy(update={"points": 6})
    for verdicts, points in (
        ("++++ ++++ ++++ +++-", 6 - 0.2),
        ("++++ ++++ ++++ ----", 6 - 0.2),
        ("++++ -+++ ++++ ++++", 6 - 1),
        # Rows that are worth less than their cells cost: other rows of the group lose the rest.
        ("++++ ---- ++++ ++++", 6 - 4),
        ("---- ---- ++++ ++++", 0),
    ):
        report = part_report(part, judged(verdicts, pose))
        assert report.points == pytest.approx(points), verdicts
        assert sum(row.points for row in report.rows) == pytest.approx(points)


def test_a_row_that_loses_all_it_is_worth_is_not_overdrawn(table: PartSpec) -> None:
    # Each cell that needs knowledge is worth 2 points; rows 1 and 2 are a group. Rows 1 and 3 are
    # wrong, and row 3 has 2 points left, which a slip without a cell costs.
    known = tuple(tuple(cell == "x" for cell in row) for row in ("x...", "x...", "xx..", "x..."))
    pairs = Content(known, tuple((i // 2,) * 4 for i in range(4)))
    part = table.model_copy(update={"points": 10})
    report = part_report(part, judged("-+++ ++++ -+++ ++++", pairs, slips=1))
    assert [row.max_points - row.points for row in report.rows] == [2, 0, 4, 0]


def test_a_given_row_costs_a_step_if_it_is_wrong(table: PartSpec) -> None:
    part = table.model_copy(update={"marking": "rows"})
    given = replace(TABLE, given=(True, False, False, False))
    assert part_report(part, judged(ONE, given)).points == 8 - 0.25


def test_additional_cells_of_own_frames_cost_what_the_usual_ones_do(table: PartSpec) -> None:
    # Only three of the four cells count: a unit is 2 points, and each row has another 0.5.
    fixed = replace(TABLE, most=3)
    assert part_report(table, judged(RIGHT, fixed)).points == 8
    assert part_report(table, judged(ONE, fixed)).points == 6
    assert part_report(table, judged("+-++ ++++ ++++ ++++", fixed)).points == 6
    assert part_report(table, judged("--++ ++++ ++++ ++++", fixed)).points == 8 - 2.5
    lost = part_report(table, judged("--++ ++++ ++++ ++++", fixed))
    # The row has only 2 points.
    assert lost.rows[0].points == 0
    assert sum(row.points for row in lost.rows) == 5.5


def test_an_answer_that_was_not_judged_loses_all(table: PartSpec) -> None:
    for verdict, code in ((Verdict.MISSING, "no_answer"), (Verdict.UNREADABLE, "not_read")):
        report = unjudged_report(table, verdict)
        assert (report.verdict, report.points, report.max_points) == (verdict, 0, 8)
        assert [(each.code, each.points) for each in report.lost] == [(code, 8)]
        assert (report.rows, report.feedback, report.part) == ((), (), "table")
        assert not report.follow_through
        message = Feedback("empty", Severity.ERROR, "Write something.")
        assert unjudged_report(table, verdict, (message,)) == replace(report, feedback=(message,))


def test_a_student_who_sees_only_points_sees_one_sum(table: PartSpec) -> None:
    [told] = without_places(part_report(table, judged(TWO, slips=1)).lost)
    assert (told.code, told.row, told.cells, told.points) == ("part", None, None, 5.25)
    assert without_places(()) == ()


def test_a_loss_names_its_cells() -> None:
    def message(labels: str, verdicts: str) -> str:
        each = [VERDICTS[sign] for sign in verdicts]
        cells = tuple(map(CellReport, labels.split(), each))
        return str(lost_in_row(RowReport("2", combined(each), 0.0, 1.0, cells), 1.0).message)

    assert message("a alpha d theta", "+-+?") == "α and θ in row 2"
    assert message("a alpha d theta", "----") == "row 2"
    assert message("a alpha d theta", "++++") == "row 2"
    assert message("1 2 3 4", "-+++") == "column 1 in row 2"
    assert message("1 2 3 4", "--+-") == "columns 1, 2 and 4 in row 2"


# --- An empty entry never earns more than a wrong entry

TRIES: Final = 20
# Tables have a search for the frames, and a campaign of their own: tests/frame_choice/rows.
ELSEWHERE: Final = {"dh_table", "frames", "find_slip"}
Path = tuple[str | int, ...]


def parts_with_answers() -> list[tuple[Exercise, PartSpec, Any]]:
    return [
        (exercise, part, answer)
        for exercise in shipped_exercises().values()
        for part in exercise.parts
        for answer in [dict[str, Any](solved(exercise).answers)[part.id]]
        if part.kind not in ELSEWHERE and any(entries(answer))
    ]


def entries(answer: Any, path: Path = ()) -> Iterator[tuple[Path, str]]:
    if isinstance(answer, str):
        yield path, answer
    elif isinstance(answer, dict | list):
        pairs = answer.items() if isinstance(answer, dict) else enumerate(answer)
        for key, value in pairs:
            yield from entries(value, (*path, key))


def with_texts(answer: Any, texts: dict[Path, str]) -> Any:
    changed = deepcopy(answer)
    for (*path, last), text in texts.items():
        inner = changed
        for key in path:
            inner = inner[key]
        inner[last] = text
    return changed


def graded(exercise: Exercise, part: PartSpec, answer: Any) -> PartReport:
    body = validated(GradeRequest, json.loads(json.dumps({"answers": {part.id: answer}})), ())
    report = grade(exercise, body.submission(exercise.feedback))
    return next(each for each in report.parts if each.part == part.id)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(4))
def test_an_empty_entry_or_row_earns_no_more(seed: int) -> None:
    choose, asked = random.Random(seed), parts_with_answers()
    for _ in range(TRIES):
        exercise, part, answer = choose.choice(asked)
        places = dict(entries(answer))
        spoiled = choose.sample(sorted(places, key=str), min(len(places), choose.randint(1, 16)))
        texts = {
            place: choose.choice(["-({})", "({}) + 0.321", "0", "1", "2*({})"]).format(
                places[place]
            )
            for place in spoiled
        }
        written = with_texts(answer, texts)
        row = choose.choice(sorted(places, key=str))[:-1]
        emptied = [[place] for place in choose.sample(sorted(places, key=str), min(3, len(places)))]
        for empty in [*emptied, [place for place in places if place[:-1] == row]]:
            less = graded(exercise, part, with_texts(written, dict.fromkeys(empty, "")))
            earned = graded(exercise, part, written).points
            assert less.points <= earned, (exercise.id, part.id, texts, empty)


# --- The points in reports on random wrong answers add up


@pytest.mark.long
@pytest.mark.parametrize("answers", [1, pytest.param(1000, marks=pytest.mark.campaign)])
def test_points_add_up(answers: int, catalogue: Mapping[str, Exercise]) -> None:
    graded, found = run(catalogue, answers, seed=1)
    assert graded > answers * len(catalogue)
    assert not found, "\n".join(found[:5])
