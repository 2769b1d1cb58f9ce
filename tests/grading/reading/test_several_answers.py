"""Texts with several answers to one part: a first try, and what replaced it."""

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.formats.graded import GradingTerms, graded
from dh_grader.grading import PartReport, Submission, Verdict, grade
from dh_grader.submissions import of_one
from dh_grader.submissions.files import all_handed_in

Rows = tuple[tuple[str, ...], ...]

HEAD = ("i", "a", "alpha", "d", "theta")
ROWS = (
    ("1", "a1", "0", "0", "theta1"), ("2", "a2", "180deg", "0", "theta2"),
    ("3", "0", "0", "d3", "0"), ("4", "0", "0", "d4", "theta4"),
)  # fmt: skip
TRY = (ROWS[0], ("2", "a2", "0", "0", "theta2"), *ROWS[2:])
# The same numbers in other words.
AGAIN = (ROWS[0], ("2", "a2", "pi", "0", "q2"), *ROWS[2:])
POSE = """c123 -s123 0 l1*c1+l2*c12+l3*c123
s123 c123 0 l1*s1+l2*s12+l3*s123
0 0 1 0
0 0 0 1"""


def csv(rows: Rows) -> str:
    return "\n".join(", ".join(row) for row in (HEAD, *rows))


def blanks(rows: Rows) -> str:
    return "\n".join(" ".join(row[1:]) for row in rows)


def bars(rows: Rows) -> str:
    return "\n".join(f"| {' | '.join(row)} |" for row in (HEAD, ("---",) * 5, *rows))


def latex(rows: Rows) -> str:
    body = " \\\\\n".join(" & ".join(row) for row in (HEAD, *rows))
    return f"\\begin{{tabular}}{{ccccc}}\n{body}\n\\end{{tabular}}"


def matlab(rows: Rows) -> str:
    return f"DH{len(str(rows))} = [{'; '.join(' '.join(row[1:]) for row in rows)}];"


def table(catalogue: Mapping[str, Exercise], text: str) -> PartReport:
    return grade(catalogue["scara"], Submission({"table": text})).parts[0]


def refusal(report: PartReport) -> str:
    assert report.verdict is Verdict.UNREADABLE
    [message] = report.feedback
    assert message.code == "several_answers"
    return message.message


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        (f"{csv(TRY)}\n\n{csv(ROWS)}", "1-5 and 7-11"),
        (f"{csv(TRY)}\n{csv(ROWS)}", "1-5 and 6-10"),
        (f"\n\n{csv(TRY)}\n\n\n{csv(ROWS)}", "3-7 and 10-14"),
        (f"My first try\n{csv(TRY)}\n\nCorrected table:\n\n{csv(ROWS)}\n", "2-6 and 10-14"),
        (f"{blanks(TRY)}\n\n{blanks(ROWS)}", "1-4 and 6-9"),
        (f"{blanks(TRY)}\n{blanks(ROWS)}", "1-4 and 5-8"),
        (f"First\n{blanks(TRY)}\nSecond\n{blanks(ROWS)}", "2-5 and 7-10"),
        (f"{bars(TRY)}\n\nThe second try\n\n{bars(ROWS)}", "1-6 and 10-15"),
        (f"First\n{latex(TRY)}\n\nSecond\n{latex(ROWS)}", "2-8 and 11-17"),
        (f"{matlab(TRY)}\n% better\n{matlab(ROWS)}", "1 and 3"),
        (f"{csv(TRY)}\n\n{csv(ROWS)}\n\n{csv(TRY)}", "1-5, 7-11 and 13-17"),
        # A try without its last row.
        (f"{csv(TRY[:3])}\n\n{csv(ROWS)}", "1-4 and 6-10"),
    ],
)
def test_several_tables_that_differ_are_named_by_their_lines(
    text: str, lines: str, catalogue: Mapping[str, Exercise]
) -> None:
    assert f"in the lines {lines}." in refusal(table(catalogue, text))


@pytest.mark.parametrize("again", [ROWS, AGAIN])
@pytest.mark.parametrize("layout", [csv, blanks, bars, latex, matlab])
def test_equal_tables_are_one_answer(
    layout: Callable[[Rows], str], again: Rows, catalogue: Mapping[str, Exercise]
) -> None:
    report = table(catalogue, f"Draft\n{layout(ROWS)}\n\nFinal version\n{layout(again)}")
    assert report.points == report.max_points
    assert "answer_repeated" in [message.code for message in report.feedback]


def test_matrices_that_differ_are_refused_and_equal_ones_are_one(
    catalogue: Mapping[str, Exercise],
) -> None:
    def pose(text: str) -> PartReport:
        return grade(catalogue["planar-rrr"], Submission({"pose": text})).parts[1]

    wrong = POSE.replace("-s123", "s123")
    assert "in the lines 2-5 and 8-11." in refusal(pose(f"First\n{wrong}\n\nBetter:\n{POSE}"))
    report = pose(f"{POSE}\n\n{POSE}")
    assert report.points == report.max_points


@pytest.mark.parametrize(
    "rows",
    [
        # One table with an empty line in it.
        f"{blanks(ROWS[:2])}\n\n{blanks(ROWS[2:])}",
        f"{csv(ROWS[:2])}\n\n{csv(ROWS[2:]).partition(chr(10))[2]}",
    ],
)
def test_one_table_in_two_blocks_is_one_answer(
    rows: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = table(catalogue, rows)
    assert report.points == report.max_points


def test_rows_behind_the_last_joint_are_no_second_table(
    catalogue: Mapping[str, Exercise],
) -> None:
    # Two joints, each with a fixed row behind it.
    text = "0 0 0 q1\na1 0 0 0\n\n0 0 0 q2\na2 0 0 0"
    report = grade(catalogue["planar-rr"], Submission({"table": text})).parts[0]
    assert "several_answers" not in [message.code for message in report.feedback]


def test_a_file_with_two_tables_is_graded_by_hand_and_not_with_zero_points(
    tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    (tmp_path / "Anna.txt").write_text(f"\n{csv(TRY)}\n\nThis one counts\n{csv(ROWS)}\n")
    assignment = of_one(catalogue["scara"], "table")
    [handed] = all_handed_in([tmp_path])
    found = graded(handed, GradingTerms(assignment, 0.8))
    assert not found.is_complete
    [file] = found.files
    assert file.report is not None
    assert "in the lines 2-6 and 9-13." in refusal(file.report.parts[0])
