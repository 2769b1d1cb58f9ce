"""Compare the statistics of a class with counts made by hand."""

import tracemalloc
from dataclasses import replace

import pytest
from dh_grader.grading import CellReport, PartReport, ReadEntry, Report, Verdict
from dh_grader.statistics import ClassStatistics, ScoreDistribution, Share

from tests.formats.class_of_seven import ANNA, BEN, CLEO, DANA, EMRE, FRITZ, class_of_seven

TABLE = ("planar-rrr", "table")
POSE = ("planar-rrr", "pose")


@pytest.fixture(scope="module")
def counted() -> ClassStatistics:
    statistics = ClassStatistics()
    for number, submission in enumerate(class_of_seven()):
        for file in submission.files:
            if file.report:
                statistics.add(number, file.report)
    return statistics


def test_scores_are_counted_in_ten_bins() -> None:
    scores = ScoreDistribution()
    for score in (0.0, 0.1, 0.3, 0.35, 0.8, 1.0):
        scores.add(score, passed=score >= 0.8)
    assert (scores.count, scores.passed) == (6, 2)
    assert scores.mean == pytest.approx(2.55 / 6)
    assert scores.median == pytest.approx(0.325)
    assert [each.count for each in scores.bins] == [1, 1, 0, 2, 0, 0, 0, 0, 1, 1]
    assert [each.passed for each in scores.bins] == [0, 0, 0, 0, 0, 0, 0, 0, 1, 1]
    assert (scores.bins[3].low, scores.bins[3].high) == (0.3, 0.4)


def test_a_score_at_an_edge_is_in_the_upper_bin() -> None:
    for tenths in range(10):
        scores = ScoreDistribution()
        scores.add(round(tenths / 10, 6), passed=False)
        assert scores.bins[tenths].count == 1


def test_missing_parts_do_not_count_as_answers(counted: ClassStatistics) -> None:
    table, pose = counted.parts[TABLE], counted.parts[POSE]
    # Fritz handed in nothing; only Anna's table is all right.
    assert (table.seen, table.share) == (6, Share(correct=1, answered=5))
    # Dana has no pose either; the others' are right.
    assert (pose.seen, pose.share) == (6, Share(correct=4, answered=4))
    assert pose.mean_points == 8


@pytest.mark.parametrize(
    ("row", "cell", "correct", "answered"),
    [
        ("1", "a", 5, 5),
        ("2", "alpha", 3, 5),  # Ben and Cleo are wrong
        ("2", "a", 5, 5),
        ("3", "theta", 4, 5),  # Emre's cannot be read
        ("e", "a", 4, 4),  # Dana has no such row
        ("1", None, 5, 5),
        ("2", None, 3, 5),
        ("3", None, 4, 5),
        ("e", None, 4, 4),
    ],
)
def test_missing_rows_and_cells_do_not_count_as_answers(
    counted: ClassStatistics, row: str, cell: str | None, correct: int, answered: int
) -> None:
    found = counted.parts[TABLE].rows[row]
    share = found.cells[cell].share if cell else found.share
    assert share == Share(correct, answered)


def test_without_answers_there_is_no_share() -> None:
    share = Share()
    share.add(Verdict.MISSING)
    assert share.value is None


def test_rows_added_by_few_students_are_left_out(counted: ClassStatistics) -> None:
    assert list(counted.parts[TABLE].rows) == ["1", "2", "3", "e"]


def test_the_most_common_wrong_entries_are_listed(counted: ClassStatistics) -> None:
    assert counted.parts[TABLE].commonest_wrong(5) == [("2", "alpha", "pi/2", 2)]
    assert counted.parts[POSE].commonest_wrong(5, at_least=1) == []


def test_slips_are_listed_with_their_submissions(counted: ClassStatistics) -> None:
    found = {slip.slip_code: list(slip.submissions) for slip in counted.slips.counted()}
    assert found == {
        "quarter_turn": [BEN, CLEO],
        "missing_tool_row": [DANA],
        "row_too_many": [EMRE],
    }
    assert [slip.count for slip in counted.slips.counted()] == [2, 1, 1]
    quarter = counted.slips.counted()[0]
    assert quarter.parts == {TABLE: 2}
    assert quarter.sentence == "α is not right: compare z1 and z2."


def test_unreadable_entries_are_listed_separately(counted: ClassStatistics) -> None:
    [slip] = counted.slips.counted(unreadable=True)
    assert (slip.slip_code, list(slip.submissions)) == ("trailing_operator", [EMRE])


def test_submissions_with_identical_mistakes_are_grouped(counted: ClassStatistics) -> None:
    [group] = counted.identical.groups
    assert (group.exercise, group.part) == TABLE
    assert list(group.mistakes) == [("2", "alpha", "pi/2")]
    assert list(group.submissions) == [BEN, CLEO]
    assert {ANNA, FRITZ}.isdisjoint(group.submissions)


def with_entries(report: Report, text: str) -> Report:
    table = report.parts[0]
    cells = tuple(
        CellReport(name, Verdict.INCORRECT, read=ReadEntry(text, text)) for name in "abcd"
    )
    rows = tuple(replace(row, cells=cells, feedback=()) for row in table.rows)
    parts: tuple[PartReport, ...] = (replace(table, rows=rows, feedback=()),)
    return replace(report, parts=parts)


def test_mistakes_that_differ_at_the_end_of_a_long_text_are_not_identical() -> None:
    report = class_of_seven()[BEN].files[0].report
    assert report
    statistics = ClassStatistics()
    for number, end in enumerate("xyx"):
        statistics.add(number, with_entries(report, 5000 * "1 + " + end))
    [group] = statistics.identical.groups
    assert list(group.submissions) == [0, 2]
    assert max(len(text) for _, _, text in group.mistakes) <= 120


@pytest.mark.long
def test_thousands_of_submissions_take_little_memory() -> None:
    report = class_of_seven()[BEN].files[0].report
    assert report
    statistics = ClassStatistics()
    tracemalloc.start()
    try:
        for number in range(1_000):
            statistics.add(number, with_entries(report, f"{number}{' + 1' * 500}"))
        taken, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    # Each submission has 16 wrong entries of 2,000 characters: 32 MB in all.
    assert taken < 3_000_000
