import csv
import io

import pytest
from dh_grader.formats import texts as spreadsheet

from tests.formats.submissions import HOSTILE, cases, document

COLUMNS = [
    "submission", "points", "max_points", "score", "passed", "problem", "messages",
    "planar-rrr.table", "planar-rrr.pose",
]  # fmt: skip


def read(*names: str, format_name: str = "csv") -> list[list[str]]:
    text = document(format_name, *(cases()[name] for name in names))
    return list(csv.reader(io.StringIO(text, newline=""), strict=True))


def test_each_submission_is_a_line_and_each_part_a_column() -> None:
    head, right, wrong, empty = read("right", "wrong", "empty")
    assert head == COLUMNS
    assert right == ["folder/anna.json", "16", "16", "1", "yes", "", "", "8", "8"]
    # Worked out by hand in docs/marks.md: the first joint's row is worth 0.421053.
    assert wrong[1:5] == ["11", "16", "0.6875", "no"]
    assert wrong[6:] == [
        "table.quarter_turn table.joint_variable_index pose.sign", "4", "7",
    ]  # fmt: skip
    assert empty[1:] == ["", "16", "", "no", "Nothing is answered.", "", "", ""]


def test_a_file_that_cannot_be_used_has_no_points() -> None:
    _, unusable = read("unusable")
    assert unusable[1:5] == ["", "16", "", "no"]
    assert unusable[5].startswith("is no JSON: =cmd")
    assert unusable[6:] == ["", "", ""]


def test_a_hostile_file_name_stays_in_one_line() -> None:
    names = [name for name in cases() if name != "assignment"]
    lines = read(*names)
    assert len(lines) == 1 + len(names)
    text = document("csv", *(cases()[name] for name in names))
    assert text.count("\r\n") == len(lines)
    assert "\n" not in text.replace("\r\n", "")


@pytest.mark.parametrize(
    ("cell", "written"),
    [
        ("=1+1", "'=1+1"),
        ('x;=cmd|"/c calc"!A0', 'x;\'=cmd|"/c calc"!A0'),
        ('x;"=1+1"', 'x;\'"=1+1"'),
        ("x; +1;@SUM(A1);－1", "x;' +1;'@SUM(A1);'－1"),
        ("\t=1", "\ufffd=1"),
        ("x\r\n=1", "x\ufffd\ufffd=1"),
        ("a; b; c=1", "a; b; c=1"),
        ("1-2;3", "1-2;3"),
    ],
)
def test_no_cell_is_a_formula_even_if_semicolons_end_cells(cell: str, written: str) -> None:
    line = spreadsheet.line((cell, "end"))
    [cells] = csv.reader(io.StringIO(line.decode(), newline=""), strict=True)
    assert cells == [written, "end"]
    for each in csv.reader(io.StringIO(line.decode(), newline=""), delimiter=";"):
        for text in each:
            assert not text.lstrip().startswith(("=", "+", "-", "@", "－"))


def test_no_cell_starts_like_a_formula() -> None:
    assert HOSTILE.startswith("=")
    for format_name in ("csv", "gradebook"):
        for line in read(*cases(), format_name=format_name):
            for cell in line:
                assert not cell.lstrip().startswith(("=", "+", "-", "@", "\t", "\r"))


def test_points_have_two_decimals() -> None:
    assert spreadsheet.line([7.0, 7 / 3, 0.5, None]) == b"7,2.33,0.5,\r\n"
