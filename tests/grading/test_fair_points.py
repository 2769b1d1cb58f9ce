"""Compare a wrong table with similar tables, whose points are told here."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.grading.judging import Content, Grading, Judged
from dh_grader.grading.judging_table import FairPoints
from dh_grader.grading.marks import least_lost, steps_lost
from dh_grader.grading.numbers import SAMPLES, draw
from dh_grader.grading.reading.entries import Entry, Reader
from dh_grader.grading.reading.table import COMPUTED, EMPTY, GIVEN_UP, StudentRow, StudentTable
from dh_grader.grading.report import Verdict, WorkBudget
from dh_grader.kinematics import Convention

from tests.grading.support.submitting import one_part
from tests.grading.test_marks import KNOWN, ONE, RIGHT, TWO, judged
from tests.together import together

# The signs of cells: read, replaced by a wrong number, empty, unreadable.
CELLS = {
    "w": COMPUTED,
    "x": GIVEN_UP,
    ".": EMPTY,
    "?": Entry(None, Verdict.UNREADABLE),
}
READ = "wwww wwww wwww wwww"
# The work of judging a table, and of judging it again without a row.
WORK, AGAIN = 8.0, 4.0


def table_of(words: str, convention: Convention | None = None) -> StudentTable:
    """Return a table with the cells of ``words``: a word for each row."""
    rows = []
    for word in words.split():
        entries = tuple(CELLS[sign] for sign in word)
        numbers = [np.nan if sign in ".?" else 0.7 for sign in word]
        rows.append(StudentRow(entries, np.repeat(np.array(numbers)[:, None], SAMPLES, axis=1)))
    return StudentTable(tuple(rows), np.array([row.values for row in rows]), convention)


def words_of(table: StudentTable) -> str:
    """Return the cells of a table as ``table_of`` takes them."""
    signs = {id(entry): sign for sign, entry in CELLS.items()}
    return " ".join("".join(signs[id(entry)] for entry in row.entries) for row in table.rows)


@dataclass
class Limiting:
    """Limits points, and notes which tables are judged for that."""

    exercise: Exercise
    part: DhTableSpec
    # The judgements of other tables, by their cells.
    answers: Mapping[str, Judged]
    searches: float = 250.0

    def __post_init__(self) -> None:
        self.asked: list[str] = []
        self.budget = WorkBudget(searches=self.searches)

    def of(self, words: str, first: Judged, convention: Convention | None = None) -> Judged:
        samples = draw(self.exercise, None)
        reader = Reader.of(self.exercise, samples, "radians", self.budget)
        grading = Grading(self.exercise, samples, reader)
        fair = FairPoints(self.part, self._judged_again, WORK, grading)
        return fair.limited(table_of(words, convention), first)

    def _judged_again(self, table: StudentTable) -> Judged:
        words = words_of(table)
        self.asked.append(words)
        # Only cells that were read keep their number; only empty and unreadable ones have none.
        for row in table.rows:
            for entry, values in zip(row.entries, row.values, strict=True):
                assert np.isnan(values).all() == (entry in (EMPTY, CELLS["?"]))
                assert (values == 0.7).all() == (entry is COMPUTED)
        return self.answers[words]

    @property
    def spent(self) -> float:
        return self.searches - self.budget.searches


def table_part(exercise: Exercise, **changes: Any) -> DhTableSpec:
    """Return the part for the robot's table, with 8 points for what needs knowledge."""
    part = next(each for each in exercise.parts if isinstance(each, DhTableSpec))
    return part.model_copy(update={"points": 8.0, **changes})


def given_up(*rows: int, of: str = READ) -> str:
    """Return the cells of a table in which rows, counted from 1, were given up."""
    words = of.split()
    return " ".join("xxxx" if i in rows else word for i, word in enumerate(words, start=1))


# Losses in quarters of a point, in the SCARA's table: a unit is 7, each row has 1 besides.
LOSES_1 = judged("++++ ++++ -+++ ++++")
LOSES_7 = judged(ONE)
LOSES_8 = judged("--++ ++++ ++++ ++++")
LOSES_14 = judged(TWO)
LOSES_15 = judged("++++ ---+ ++++ ++++")
LOSES_21 = judged("-+++ --++ ++++ ++++")
ALL_WRONG = judged("---- ---- ---- ----")
IN_THREE_ROWS = judged("-+++ --++ ++++ ---+")
FIVE_ROWS = Content(
    (*KNOWN, (False,) * 4), tuple((i,) * 4 for i in range(5)), besides=True, usual=(4, 4)
)


MISSING_ROW = judged("++++ ....").rows[1]


def test_the_losses_of_the_cases_are_right(catalogue: Mapping[str, Exercise]) -> None:
    part = table_part(catalogue["scara"])
    for answer, lost in (
        (judged(RIGHT), 0), (LOSES_1, 1), (LOSES_7, 7), (LOSES_8, 8), (LOSES_14, 14),
        (LOSES_15, 15), (LOSES_21, 21), (ALL_WRONG, 32), (IN_THREE_ROWS, 29),
    ):  # fmt: skip
        assert steps_lost(part, answer) == lost
    part = table_part(catalogue["planar-rrr"])
    for answer, lost in (
        (PLANAR_RIGHT, 0), (LOSES_2, 2), (TIP_8, 8), (TIP_10, 10), (WITHOUT_TIP, 10),
        (LOSES_12, 12), (UNREAD_10, 10), (UNREAD_12, 12),
    ):  # fmt: skip
        assert steps_lost(part, answer) == lost


FREE: tuple[dict[str, Any], ...] = ({"base": "free"}, {"tool": "free"}, {"directions": "free"})
# The first judgement of a table whose cells are all read, changes of the part, the judgements of
# the tables with rows given up in the order in which they are asked for, and the row of the best.
ROWS_GIVEN_UP: list[tuple[Judged, dict[str, Any], list[tuple[int, Judged]], int | None]] = [
    # With given ends, the other rows determine the only wrong cell.
    (judged("++++ ++++ ++++ +-++"), {}, [], None),
    # If something is free, they do not.
    *((judged("++++ ++++ ++++ +-++"), free, [(4, LOSES_1)], 4) for free in FREE),
    (judged("++++ ++++ ++++ +-++", at_most=ALL_WRONG), {}, [(4, LOSES_1)], 4),
    # A row that costs no more than it certainly loses: row 1 has a unit besides a fifth, since a1
    # is wrong in all frames; the others have a fifth.
    (LOSES_1, {"base": "free"}, [], None),
    (LOSES_8, {"base": "free"}, [], None),
    # Two wrong cells: all tables with so few were compared, but row 2 has no such cell.
    (LOSES_14, {}, [(2, LOSES_7)], 2),
    (LOSES_14, {}, [(2, LOSES_14)], None),
    (LOSES_14, {}, [(2, LOSES_15)], None),
    # The wrong cells of one row, too.
    (judged("---- ++++ ++++ ++++", lost=1.5), {}, [], None),
    (judged("---+ ++++ ++++ ++++", slips=1), {}, [], None),
    (LOSES_15, {}, [(2, LOSES_8)], 2),
    # Three wrong cells in two rows: the row with the most wrong cells first.
    (LOSES_21, {}, [(2, LOSES_14), (1, LOSES_15)], 2),
    (LOSES_21, {}, [(2, LOSES_15), (1, LOSES_14)], 1),
    # Row 1 loses 8 in any case.
    (LOSES_21, {}, [(2, LOSES_8)], 2),
    # If something is free, any row may be the wrong one; but not if just two cells are wrong.
    *((LOSES_21, free, [(2, LOSES_21), (1, LOSES_21), (3, LOSES_21), (4, LOSES_21)], None)
      for free in FREE),
    (LOSES_21, {"tool": "free"},
     [(2, LOSES_21), (1, LOSES_15), (3, LOSES_7), (4, LOSES_14)], 3),
    *((LOSES_14, free, [(1, LOSES_14), (2, LOSES_14)], None) for free in FREE),
    (replace(LOSES_14, at_most=ALL_WRONG), {}, [(1, LOSES_14), (2, LOSES_14)], 1),
    # A slip of the whole table is in several rows.
    (replace(IN_THREE_ROWS, whole_cost=0.9), {}, [], None),
    (replace(LOSES_21, whole_cost=0.9), {}, [(2, LOSES_21), (1, LOSES_21)], None),
    (IN_THREE_ROWS, {}, [(4, LOSES_21), (2, LOSES_21), (1, LOSES_21)], 4),
    # Beside the slip, some rows are wrong.
    (replace(IN_THREE_ROWS, whole_cost=0.25, beside=LOSES_14), {},
     [(1, LOSES_21), (2, LOSES_14)], 2),
    (replace(IN_THREE_ROWS, whole_cost=0.25, beside=LOSES_7), {}, [], None),
    # In given frames each row stands alone.
    (LOSES_21, {"frames": "given"}, [], None),
    (ALL_WRONG, {"frames": "given"}, [], None),
    # If the rows cannot be compared one by one, each of them may be the wrong one.
    (judged("-+++ --++ ++++ ++++ ----", FIVE_ROWS), {},
     [(1, LOSES_21), (2, LOSES_14), (3, LOSES_14), (4, LOSES_15)], 2),
    (judged("-+++ .... ++++ -+++"), {}, [(1, LOSES_8), (2, LOSES_7), (3, LOSES_1)], 3),
]  # fmt: skip


@together(("first", "changes", "others", "best"), ROWS_GIVEN_UP)
def test_a_wrong_table_earns_what_it_earns_with_a_wrong_row_given_up(
    first: Judged,
    changes: dict[str, Any],
    others: list[tuple[int, Judged]],
    best: int | None,
    catalogue: Mapping[str, Exercise],
) -> None:
    # The submitted rows; the third one may be missing.
    words = " ".join(READ.split()[: 3 if MISSING_ROW in first.rows else 4])
    answers = {given_up(i, of=words): other for i, other in others}
    limiting = Limiting(catalogue["scara"], table_part(catalogue["scara"], **changes), answers)
    limited = limiting.of(words, first)
    assert limiting.asked == list(answers)
    best_of_them = None if best is None else answers[given_up(best, of=words)]
    assert limited == replace(first, at_least=best_of_them)
    assert limiting.spent == AGAIN * len(answers)


# A robot and a table, its first judgement, changes of the part, the judgements of other tables in
# the order in which they are asked for, the limits of the points, and the work of the searches.
Others = dict[str, Judged]
Limits = dict[str, Any]
_Case = tuple[str, str, Judged, dict[str, Any], Others, Limits, float]
SHORT = "wwww wwww wwww"
# Only the first three rows; of these, one has a wrong cell, or two have.
SHORT_0 = judged("++++ ++++ ++++ ....")
SHORT_1 = judged("++++ -+++ ++++ ....")
SHORT_2 = judged("-+++ -+++ ++++ ....")
STANDARD, MODIFIED = Convention.STANDARD, Convention.MODIFIED

UNREAD_AND_EMPTY: list[_Case] = [
    # A table with an empty cell earns at most as much as with a wrong number in this cell.
    ("scara", "w.ww wwww wwww wwww", LOSES_7, {}, {"wxww wwww wwww wwww": LOSES_14},
     {"at_most": LOSES_14}, WORK),
    ("scara", "w.ww wwww wwww ....", LOSES_7, {}, {"wxww wwww wwww xxxx": LOSES_1},
     {"at_most": LOSES_1}, WORK),
    # An unreadable cell is no empty one.
    ("scara", "w.?w wwww wwww wwww", LOSES_7, {}, {"wx?w wwww wwww wwww": LOSES_14},
     {"at_most": LOSES_14}, WORK),
    ("scara", "w?ww wwww wwww wwww", LOSES_7, {}, {}, {}, 0),
    ("scara", "w?ww wwww wwww wwww", LOSES_21, {"base": "free"}, {}, {}, 0),
    # Another limit may be lower.
    ("scara", "w.ww wwww wwww wwww", replace(LOSES_7, at_most=LOSES_15), {},
     {"wxww wwww wwww wwww": LOSES_14}, {"at_most": LOSES_15}, WORK),
    ("scara", "w.ww wwww wwww wwww", replace(LOSES_7, at_most=LOSES_14), {},
     {"wxww wwww wwww wwww": LOSES_15}, {"at_most": LOSES_15}, WORK),
    # Without a cell that can be read, there is nothing to limit.
    ("scara", "???? ..?? .... ????", ALL_WRONG, {}, {}, {}, 0),
    ("scara", "wwww ww?w .... ?www", LOSES_21, {}, {"wwww ww?w xxxx ?www": LOSES_21},
     {"at_most": LOSES_21}, WORK),
    ("scara", "?www ww?w .... www?", ALL_WRONG, {}, {"?www ww?w xxxx www?": LOSES_21},
     {"at_most": LOSES_21}, WORK),
]  # fmt: skip
MISSING_ROWS: list[_Case] = [
    # A missing row counts as a wrong one. If only it is wrong, there is nothing to limit.
    ("scara", SHORT, SHORT_0, {}, {}, {}, 0),
    ("scara", "wwww wwww", judged("++++ ++++ .... ...."), {}, {}, {}, 0),
    # Without a wrong row, the table may be worth more than with the missing row wrong.
    ("scara", SHORT, SHORT_1, {},
     {f"{SHORT} xxxx": LOSES_7, "xxxx wwww wwww": LOSES_8, "wwww xxxx wwww": LOSES_1},
     {"at_most": LOSES_7, "at_least": LOSES_1}, WORK + 2 * AGAIN),
    ("scara", SHORT, SHORT_1, {},
     {f"{SHORT} xxxx": LOSES_7, **{given_up(i, of=SHORT): LOSES_7 for i in (1, 2, 3)}},
     {"at_most": LOSES_7, "at_least": LOSES_7}, WORK + 3 * AGAIN),
    ("scara", "wwww wwww", judged("-+++ ++++ .... ...."), {},
     {"wwww wwww xxxx xxxx": LOSES_1}, {"at_most": LOSES_1, "at_least": LOSES_1}, WORK),
    # The table with the missing row wrong has limits of its own.
    ("scara", SHORT, SHORT_2, {},
     {f"{SHORT} xxxx": LOSES_21, "wwww xxxx wwww xxxx": LOSES_14, "xxxx wwww wwww xxxx": LOSES_15,
      **{given_up(i, of=SHORT): LOSES_21 for i in (1, 2, 3)}},
     {"at_most": replace(LOSES_21, at_least=LOSES_14),
      "at_least": replace(LOSES_21, at_least=LOSES_14)}, WORK + 5 * AGAIN),
    # If a cell is unread, no row is given up.
    ("scara", "w?ww wwww wwww", SHORT_1, {}, {"w?ww wwww wwww xxxx": LOSES_7},
     {"at_most": LOSES_7}, WORK),
    ("scara", "?www w?ww www?", SHORT_1, {}, {"?www w?ww www? xxxx": LOSES_7},
     {"at_most": LOSES_7}, WORK),
    # In given frames each row stands alone, and the other convention may need fewer rows.
    ("scara", SHORT, SHORT_2, {"frames": "given"}, {}, {}, 0),
    ("scara", SHORT, replace(SHORT_2, whole_cost=0.9), {}, {}, {}, 0),
    # The rows that are missing may be others.
    ("scara", SHORT, judged("++++ ++++ -+++ .... ....", FIVE_ROWS), {},
     {given_up(i, of=SHORT): LOSES_1 for i in (1,)}, {"at_least": LOSES_1}, AGAIN),
    ("scara", SHORT, judged("-+++ ++++ ++++ ...+"), {},
     {given_up(i, of=SHORT): LOSES_1 for i in (1,)}, {"at_least": LOSES_1}, AGAIN),
]  # fmt: skip

# The cells of the planar RRR that need knowledge: l1, l2, l3. A unit is 8, each row has 2 besides.
PLANAR = Content(
    tuple(tuple(cell == "x" for cell in row) for row in ("....", "x...", "x...", "x...")),
    tuple((i,) * 4 for i in range(4)),
    besides=True,
)
TIP_8 = judged("++++ ++++ ++++ -+++", PLANAR)
TIP_10 = judged("++++ ++++ ++++ ----", PLANAR)
WITHOUT_TIP = judged("++++ ++++ ++++ ....", PLANAR)
LOSES_12 = judged("-+++ ++++ ++++ ----", PLANAR)
LOSES_2 = judged("-+++ ++++ ++++ ++++", PLANAR)
UNREAD_10 = judged("+?++ ++++ ++++ -+++", PLANAR)
UNREAD_12 = judged("+?++ ++++ ++++ ....", PLANAR)
PLANAR_RIGHT = judged(RIGHT, PLANAR)
WRONG_END: list[_Case] = [
    # A wrong last row, after those of the joints, costs no more than a missing one.
    ("planar-rrr", READ, TIP_8, {}, {SHORT: WITHOUT_TIP}, {}, AGAIN),
    ("planar-rrr", READ, TIP_10, {}, {SHORT: WITHOUT_TIP, given_up(4): TIP_10}, {}, 2 * AGAIN),
    ("planar-rrr", READ, LOSES_12, {},
     {SHORT: WITHOUT_TIP, given_up(4): TIP_10, given_up(1): TIP_8}, {"at_least": TIP_8}, 3 * AGAIN),
    ("planar-rrr", READ, LOSES_12, {},
     {SHORT: WITHOUT_TIP, given_up(4): TIP_10, given_up(1): TIP_10}, {"at_least": WITHOUT_TIP},
     3 * AGAIN),
    # A table that is right without it shows that the row belongs to no right table.
    ("planar-rrr", READ, TIP_8, {}, {SHORT: PLANAR_RIGHT}, {}, AGAIN),
    # The rows of all joints are kept, and right rows after them.
    ("planar-rrr", READ, LOSES_2, {}, {}, {}, 0),
    ("planar-rrr", READ, judged("++++ ++++ -+++ ++++", PLANAR), {}, {}, {}, 0),
    # A row that was given up before is not left out, nor any row in free or given frames, nor a row
    # that the form does not have.
    ("planar-rrr", given_up(4), TIP_8, {}, {}, {}, 0),
    ("planar-rrr", READ, TIP_8, {"tool": "free"}, {given_up(4): TIP_8}, {}, AGAIN),
    ("planar-rrr", READ, TIP_8, {"frames": "given"}, {}, {}, 0),
    ("planar-rrr", f"{READ} wwww", judged("++++ ++++ ++++ ++++ -+++", FIVE_ROWS), {}, {}, {}, 0),
    ("planar-rrr", READ, judged("++++ ++++ ++++ -+++ ----", FIVE_ROWS), {},
     {given_up(i): TIP_10 for i in (1, 4)}, {}, 2 * AGAIN),
    # If a cell is unread or empty, the missing row is compared with a wrong one.
    ("planar-rrr", "w?ww wwww wwww wwww", UNREAD_10, {},
     {"w?ww wwww wwww": UNREAD_12, "w?ww wwww wwww xxxx": TIP_10},
     {"at_least": replace(UNREAD_12, at_most=TIP_10)}, AGAIN + WORK),
    ("planar-rrr", "w.ww wwww wwww wwww", UNREAD_10, {},
     {"w.ww wwww wwww": UNREAD_12, "w.ww wwww wwww xxxx": LOSES_2, "wxww wwww wwww xxxx": LOSES_2,
      "wxww wwww wwww wwww": TIP_8},
     {"at_most": TIP_8,
      "at_least": replace(UNREAD_12, at_most=replace(LOSES_2, at_most=LOSES_2))},
     AGAIN + 3 * WORK),
]  # fmt: skip


@together(
    ("robot", "words", "first", "changes", "others", "limits", "work"),
    [*UNREAD_AND_EMPTY, *MISSING_ROWS, *WRONG_END],
)
def test_empty_cells_and_missing_rows_are_compared_with_wrong_ones(
    robot: str,
    words: str,
    first: Judged,
    changes: dict[str, Any],
    others: Others,
    limits: Limits,
    work: float,
    catalogue: Mapping[str, Exercise],
) -> None:
    limiting = Limiting(catalogue[robot], table_part(catalogue[robot], **changes), others)
    limited = limiting.of(words, first)
    assert limiting.asked == list(others)
    assert limited == replace(first, **limits)
    assert limiting.spent == work


def test_rows_are_given_up_until_the_work_is_spent(catalogue: Mapping[str, Exercise]) -> None:
    robot = catalogue["scara"]
    asked = [given_up(2), given_up(1), given_up(3), given_up(4)]
    for searches, count in ((0.0, 0), (3.9, 0), (AGAIN, 1), (11.9, 2), (12.0, 3), (99.0, 4)):
        answers = dict.fromkeys(asked, LOSES_21)
        limiting = Limiting(robot, table_part(robot, base="free"), answers, searches)
        limiting.of(READ, LOSES_21)
        assert limiting.asked == asked[:count]
        assert limiting.spent == AGAIN * count
    # The row at the end is left out only if there is enough work.
    robot = catalogue["planar-rrr"]
    for searches, tables in ((3.9, []), (AGAIN, [SHORT])):
        limiting = Limiting(robot, table_part(robot), {SHORT: WITHOUT_TIP}, searches)
        limiting.of(READ, TIP_8)
        assert limiting.asked == tables
    # The comparison with empty cells or missing rows is made in any case.
    robot = catalogue["scara"]
    for words, first, full in (
        ("w.ww wwww wwww wwww", LOSES_7, "wxww wwww wwww wwww"),
        (SHORT, SHORT_1, f"{SHORT} xxxx"),
    ):
        limiting = Limiting(robot, table_part(robot), {full: LOSES_7}, 0.0)
        assert limiting.of(words, first).at_most == LOSES_7
        assert (limiting.asked, limiting.spent) == ([full], WORK)


def test_if_a_given_up_row_may_be_anything_it_is_left_empty(
    catalogue: Mapping[str, Exercise],
) -> None:
    # The last row is right with any numbers if the tool is free.
    robot = catalogue["scara"]
    words, right = "wwww wwww wwww ....", judged(RIGHT)
    for empty, best in ((LOSES_1, LOSES_1), (LOSES_15, LOSES_7)):
        answers = {given_up(4): right, words: empty}
        limiting = Limiting(robot, table_part(robot, tool="free"), answers)
        first = judged("++++ ++++ ++++ +-++")
        assert steps_lost(limiting.part, first) == 7
        limited = limiting.of(READ, first)
        assert limiting.asked == [given_up(4), words]
        assert limited == (first if best is LOSES_7 else replace(first, at_least=best))


def test_the_named_convention_counts_where_either_is_accepted(
    catalogue: Mapping[str, Exercise],
) -> None:
    robot = catalogue["scara"]
    either = table_part(robot, convention="either")
    missing = {f"{SHORT} xxxx": LOSES_1}
    each = {given_up(i, of=SHORT): LOSES_21 for i in (1, 2, 3)}
    for part, named, others in (
        (either, None, each),
        (either, Convention.STANDARD, missing),
        (table_part(robot), None, missing),
        (table_part(robot), Convention.MODIFIED, missing),
    ):
        limiting = Limiting(robot, part, others)
        limiting.of(SHORT, SHORT_1, named)
        assert limiting.asked == list(others)
    # Only the robot's own table says which rows have content in any frames.
    searched = {given_up(2): LOSES_14, given_up(1): LOSES_14}
    for named, others in (
        (None, dict(reversed(searched.items()))), (Convention.STANDARD, {given_up(2): LOSES_14})
    ):  # fmt: skip
        limiting = Limiting(robot, either, others)
        limiting.of(READ, LOSES_14, named)
        assert limiting.asked == list(others)


# A robot with skew and distant axes; the third joint slides. Row 4 leads to the tool.
RRPR = """
[robot]
structure = "RRPR"
convention = "{convention}"
joints = ["q1", "q2", "q3", "q4"]
table = [{rows}]
[symbols]
b = {{ kind = "length", description = "a length" }}
"""
# The twist and the length of each row.
ROWS = {
    "standard": ['"b", "90deg", "0", "q1"', '"-b", "-30deg", "b", "q2"',
                 '"b", "-90deg", "q3", "0"', '"0.2", "1deg", "0", "q4"'],
    "half turns": ['"b", "180deg", "0", "q1"', '"0", "90deg", "b", "q2"',
                   '"0", "0", "q3", "0"', '"b", "0", "0", "q4"'],
    "modified": ['"-b", "-90deg", "b", "q1"', '"b", "30deg", "0", "q2"',
                 '"b", "90deg", "q3", "0"', '"b", "90deg", "0", "q4"'],
    "with the tool": ['"b", "90deg", "b", "q1"', '"0", "90deg", "0", "q2"',
                      '"b", "180deg", "q3", "0"', '"0", "-90deg", "0", "q4"',
                      '"b", "90deg", "b", "0"'],
}  # fmt: skip


@pytest.mark.parametrize(
    ("rows", "convention", "free", "contents"),
    [
        # Rows 1 and 2 begin at an axis that is a line; only directions are next to the sliding
        # joint: no distance. The tool's frame has both if it is given.
        ("standard", STANDARD, (), "2112"),
        ("standard", STANDARD, ("tool",), "2110"),
        ("standard", STANDARD, ("base",), "2112"),
        ("standard", STANDARD, ("base", "tool", "directions"), "2110"),
        # Parallel axes have no angle; axes that meet have no distance.
        ("half turns", STANDARD, (), "1101"),
        ("half turns", STANDARD, ("tool",), "1100"),
        # Row 1 of a modified table begins at the base.
        ("modified", MODIFIED, (), "2211"),
        ("modified", MODIFIED, ("base",), "0211"),
        ("modified", MODIFIED, ("tool", "directions"), "2211"),
        # The rows after the joints may be shared out in several ways.
        ("with the tool", MODIFIED, ("directions",), "21010"),
        ("with the tool", MODIFIED, ("base",), "01010"),
        ("with the tool", STANDARD, ("directions",), "21000"),
    ],
)
def test_a_row_is_given_up_if_it_loses_more_than_in_any_frames(
    rows: str,
    convention: Convention,
    free: tuple[str, ...],
    contents: str,
    make_exercise: Callable[[str], Exercise],
) -> None:
    robot = RRPR.format(
        convention=convention.value, rows=", ".join(f"[{each}]" for each in ROWS[rows])
    )
    fields = f'convention = "{convention.value}"\nframes = "free"'
    exercise = make_exercise(one_part("dh_table", fields, robot))
    part = table_part(exercise, **dict.fromkeys(free, "free"))
    count = len(contents)  # of four joints, and of the tool
    content = Content(
        ((True,) + (False,) * 3,) * count, tuple((i,) * 4 for i in range(count)), besides=True
    )
    every = " ".join(["wwww"] * count)
    for cells in (0, 1, 2, 2.4):
        # The table loses exactly the least loss of a row with so many cells.
        wrong = ["----"] * 4 + ["++++"] * (count - 4)
        first = judged(" ".join(wrong), content, lost=cells + 0.2)
        if cells in (0, 1, 2):
            assert steps_lost(part, first) == least_lost(part, first, int(cells))
        expected = [
            given_up(i, of=every) for i, each in enumerate(contents, start=1) if int(each) < cells
        ]
        limiting = Limiting(exercise, part, dict.fromkeys(expected, first))
        limiting.of(every, first)
        assert sorted(limiting.asked) == sorted(expected), cells
