import pytest
from dh_grader.grading.reading.pasted_table import MAX_CHARACTERS, MAX_MARKS, read_marks
from dh_grader.grading.report import Verdict

LABELS = ("4", "5", "6", "e")


@pytest.mark.parametrize(
    ("answer", "cells"),
    [
        ("5.alpha", {(1, 1)}),
        ("5 θ", {(1, 3)}),
        ("E.d", {(3, 2)}),
        ("6/a; 4:d\n", {(2, 0), (0, 2)}),
        (["row 4", "5.a"], {(0, 0), (0, 1), (0, 2), (0, 3), (1, 0)}),
        (6, {(2, 0), (2, 1), (2, 2), (2, 3)}),
    ],
)
def test_places_are_read_by_label_and_column(answer: object, cells: set[tuple[int, int]]) -> None:
    read = read_marks(answer, LABELS)
    assert read.cells == cells
    assert read.verdict is None


@pytest.mark.parametrize("answer", [None, "", [], " , ", [""]])
def test_nothing_is_marked(answer: object) -> None:
    assert read_marks(answer, LABELS).verdict is Verdict.MISSING


@pytest.mark.parametrize(
    ("answer", "code"),
    [
        ("1.alpha", "unknown_place"),
        ("5.beta", "unknown_place"),
        ("alpha", "unknown_place"),
        (["5.a", "here"], "unknown_place"),
        (-5, "wrong_shape"),
        (True, "wrong_shape"),
        (5.0, "wrong_shape"),
        ({"row": 5}, "wrong_shape"),
        ([["5.a"]], "wrong_shape"),
        (["5.a"] * (MAX_MARKS + 1), "wrong_shape"),
        ("5.a," * MAX_CHARACTERS, "wrong_shape"),
    ],
)
def test_one_unreadable_mark_makes_all_unreadable(answer: object, code: str) -> None:
    read = read_marks(answer, LABELS)
    assert read.verdict is Verdict.UNREADABLE
    assert [finding.code for finding in read.findings] == [code]
    assert not read.cells
