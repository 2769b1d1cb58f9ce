"""Read lists of values in all shapes."""

import pytest
from dh_grader.grading import Verdict

from tests.grading.support.submitting import (
    Make,
    all_codes,
    cell,
    full_marks,
    graded,
    not_correct,
    one_part,
)

POINT = one_part(
    "vector",
    """components = [
    { name = "x", quantity = "length", expected = "l" },
    { name = "y", quantity = "number", expected = "k" },
]""",
)


@pytest.mark.parametrize(
    "answer",
    [
        ["l", "k", 0],
        ["l", "k", 0.0],
        ["l", "k", " 0 "],
        [["l"], ["k"], [0]],
        [["l", "k", 0]],
        "l, k, 0",
        "[l; k; 0]",
        "l\nk\n0",
        "(l, k, 0)",
        "<l, k, 0>",
        r"\langle l, k, 0 \rangle",
        r"\begin{bmatrix} l \\ k \\ 0 \end{bmatrix}",
    ],
)
def test_a_third_zero_is_ignored_with_a_note(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(POINT), answer)
    assert full_marks(report), report
    assert [row.label for row in report.rows] == ["1", "2"]
    assert all_codes(report) == {"zero_left_aside"}
    [message] = cell(report, "2", "1").feedback
    if isinstance(answer, str):
        assert message.span is not None
        assert answer[slice(*message.span)].strip() == "0"


@pytest.mark.parametrize(
    "answer",
    [
        ["l", "k", 1],
        ["l", "k", "0.0"],
        ["l", "k", "0*l"],
        ["l", "k", False],
        ["l", "k", None],
        ["l", 0, "k"],
        ["l", "k", 0, 0],
        ["l", "k", 0, 1],
        "l, k, 0, 1",
        "l, k, l",
    ],
)
def test_any_other_third_value_is_refused(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(POINT), answer)
    assert (report.verdict, all_codes(report)) == (Verdict.UNREADABLE, {"wrong_shape"})


@pytest.mark.parametrize(
    "text",
    [
        "[l, k]^T",
        "[l; k]'",
        "(l, k)^{\\top}",
        r"\begin{pmatrix} l & k \end{pmatrix}^T",
        "p = (l, k)",
        "p = (l; k)",
        "(l; k)",
        "p = {l, k}",
        "```\nl, k\n```",
        "```text\nx = l\ny = k\n```",
        "（l，k）",
        "p＝［l；k］",
    ],
)
def test_what_stands_around_a_list_changes_nothing(text: str, make_exercise: Make) -> None:
    assert full_marks(graded(make_exercise(POINT), text))


@pytest.mark.parametrize(
    "text", ["l, k'", "l, (k)^T", "2*(l; k)", "-(l, k)", "[l, k]^2", "(l; k)*2"]
)
def test_a_list_is_not_calculated(text: str, make_exercise: Make) -> None:
    assert not full_marks(graded(make_exercise(POINT), text))


@pytest.mark.parametrize(
    "text",
    [
        "(2 l, k k)",
        "[2 l, k k]",
        "[2 l + 0, k k]",
        "2 l; k k",
        "2 l\nk k",
        "  2 l ;  k k",
        "(2 l, sqrt((k k)^2))",
    ],
)
def test_products_may_be_written_with_blanks(text: str, make_exercise: Make) -> None:
    # If only one reading has the expected number of values, this reading is used.
    vector = one_part(
        "vector",
        """components = [
    { name = "x", quantity = "length", expected = "2*l" },
    { name = "y", quantity = "number", expected = "k^2" },
]""",
    )
    assert full_marks(graded(make_exercise(vector), text))


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("no", "wrong_shape"),
        ("l", "wrong_shape"),
        ("l k", "wrong_shape"),
        # MATLAB reads three values here.
        ("[l -l, k]", "mixed_separators"),
        ("[l k, k, l k]", "mixed_separators"),
        ('{"x": 1, "y": 2, "z": 3}', "mixed_separators"),
        ("1 2 3\n4 5\n6 7", "ambiguous_columns"),
    ],
)
def test_messages_on_lists_do_not_mention_tables(text: str, code: str, make_exercise: Make) -> None:
    report = graded(make_exercise(POINT), text)
    assert (report.verdict, all_codes(report)) == (Verdict.UNREADABLE, {code})
    [message] = report.feedback
    assert "list of 2 values" in message.message
    for word in ("row", "column", "table", "matrix"):
        assert word not in message.message


@pytest.mark.parametrize("answer", [[["l"], ["k"], ["l"]], [["l", "k"], ["l", "k"]], [["l"], []]])
def test_nested_lists_are_refused(answer: object, make_exercise: Make) -> None:
    assert all_codes(graded(make_exercise(POINT), answer)) == {"wrong_shape"}


def test_equations_in_a_list_are_read_with_notes(make_exercise: Make) -> None:
    report = graded(make_exercise(POINT), "x = l\ny = k")
    assert not_correct(report) == {}
    assert all_codes(report) == {"equation"}


ROOT = one_part(
    "vector", 'components = [{ name = "n", quantity = "number", expected = "sqrt(3)/2" }]'
)


@pytest.mark.parametrize("answer", [0.866, [0.866], [[0.866]], "0.866"])
def test_a_single_value_needs_no_list_around_it(answer: object, make_exercise: Make) -> None:
    assert full_marks(graded(make_exercise(ROOT), answer))


@pytest.mark.parametrize("answer", [True, {"m": 0.866}, [[]]])
def test_anything_but_a_value_is_refused(answer: object, make_exercise: Make) -> None:
    assert graded(make_exercise(ROOT), answer).verdict is Verdict.UNREADABLE


def test_one_number_is_no_list_of_two(make_exercise: Make) -> None:
    assert all_codes(graded(make_exercise(POINT), 0.866)) == {"wrong_shape"}
