"""Test how matrices, lists of matrices, and screws are read."""

from collections.abc import Callable, Mapping
from functools import reduce
from operator import mul
from typing import Any

import pytest
import sympy as sp
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Verdict
from dh_grader.grading.reading import preview_pasted
from dh_grader.grading.reading.matrices import indices_of, is_changed, is_product, places_of
from dh_grader.pasting import read_grid
from sympy.printing.numpy import NumPyPrinter

from tests.grading.support.robots import A5, A6, PLANAR_RRR, ROBOTS, WRIST, Robot
from tests.grading.support.robots import WRIST_A4 as A4
from tests.grading.support.submitting import (
    all_codes,
    cell,
    codes,
    full_marks,
    handed_in,
    not_correct,
    part,
)
from tests.pasting.writers import FORMATS
from tests.together import together

# --- Read matrices that are pasted as text

POSE = [
    ["c123", "-s123", "0", "l1*c1+l2*c12+l3*c123"],
    ["s123", "c123", "0", "l1*s1+l2*s12+l3*s123"],
    ["0", "0", "1", "0"],
    ["0", "0", "0", "1"],
]


@pytest.fixture
def arm(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue[PLANAR_RRR.exercise]


def pasted(exercise: Exercise, text: str) -> PartReport:
    return part(handed_in(exercise, {"pose": text}), "pose")


@together("name", FORMATS)
def test_each_format_gets_full_marks(name: str, arm: Exercise) -> None:
    report = pasted(arm, FORMATS[name](POSE))
    assert full_marks(report), report
    assert {code for row in report.rows for cell in row.cells for code in codes(cell)} <= {
        "blank_before_sign", "blank_columns",
    }  # fmt: skip


def exact_pose(robot: Robot) -> Any:
    """Return the exact pose of a robot."""

    # The link matrices are those of the textbooks: SHV eq. 3.10, Craig eq. 3.6.
    def symbol(text: str) -> Any:
        name = text.removesuffix("*")
        return sp.Integer(0) if name == "0" else sp.Symbol(name)

    def link(row: tuple[str, ...]) -> Any:
        a, d, theta = symbol(row[0]), symbol(row[2]), symbol(row[3])
        alpha = sp.pi * sp.Integer(row[1]) / 180
        c, s, ca, sa = sp.cos(theta), sp.sin(theta), sp.cos(alpha), sp.sin(alpha)
        if robot is PLANAR_RRR:
            lines = [[c, -s, 0, a], [s * ca, c * ca, -sa, -sa * d], [s * sa, c * sa, ca, ca * d]]
        else:
            lines = [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d]]
        return sp.Matrix([*lines, [0, 0, 0, 1]])

    return reduce(mul, map(link, robot.rows))


POSES = {robot.exercise: exact_pose(robot) for robot in ROBOTS}
PRINTS = {
    "str": str,
    "repr of a list": lambda matrix: repr(matrix.tolist()),
    "latex": sp.latex,
    "latex array": lambda matrix: sp.latex(matrix, mat_str="array", mat_delim="("),
    "octave_code": sp.octave_code,
    "NumPy code": NumPyPrinter().doprint,
}


def latex_without_sizes(entry: Any) -> str:
    return str(sp.latex(entry)).replace(r"\left(", "(").replace(r"\right)", ")")


ALONE = {
    "str": str,
    "repr of a list": str,
    "latex": latex_without_sizes,
    "latex array": latex_without_sizes,
    "octave_code": sp.octave_code,
    "NumPy code": NumPyPrinter().doprint,
}


@pytest.mark.long
@together("exercise", POSES)
@together("name", PRINTS)
def test_a_printed_matrix_has_the_entries_printed_one_by_one(exercise: str, name: str) -> None:
    matrix = POSES[exercise]
    rows = read_grid(PRINTS[name](matrix)).rows
    expected = [[ALONE[name](entry) for entry in matrix.row(i)] for i in range(4)]
    assert [[cell.text for cell in row] for row in rows] == expected


@pytest.mark.long
@together("exercise", POSES)
@together("name", PRINTS)
def test_a_print_gets_full_marks(
    exercise: str, name: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = pasted(catalogue[exercise], PRINTS[name](POSES[exercise]))
    assert full_marks(report), not_correct(report)


def test_spans_count_in_the_pasted_text(arm: Exercise) -> None:
    text = r"T = \begin{bmatrix} 1 & 2 & 3 & l_1 + foo \\ 1 & 2 & 3 & (4 \end{bmatrix}"
    report = pasted(arm, text)
    for place, marked in {("1", "4"): "foo", ("2", "4"): "("}.items():
        [feedback] = cell(report, *place).feedback
        assert feedback.span is not None
        assert text[slice(*feedback.span)] == marked


def test_an_empty_entry_is_missing(arm: Exercise) -> None:
    report = pasted(arm, "[c123, -s123, , 0; s123, c123, 0, 0; 0, 0, 1, 0; 0, 0, 0, 1]")
    assert cell(report, "1", "3").verdict is Verdict.MISSING


def test_three_rows_leave_the_fourth_missing(arm: Exercise) -> None:
    report = pasted(arm, FORMATS["MATLAB"](POSE[:3]))
    assert [row.verdict for row in report.rows] == [Verdict.CORRECT] * 3 + [Verdict.MISSING]


@pytest.mark.parametrize("at", range(4))
def test_a_pasted_empty_row_does_not_move_the_rows_below_it(at: int, arm: Exercise) -> None:
    lines = [", ".join(row) for row in POSE]
    report = pasted(arm, "\n".join([*lines[:at], ", , ,", *lines[at + 1 :]]))
    wanted = [Verdict.CORRECT] * 4
    wanted[at] = Verdict.MISSING
    assert [row.verdict for row in report.rows] == wanted


@pytest.mark.parametrize("empty", [None, [], "", " ", ["", ""], ["", None, "", ""]])
def test_every_kind_of_empty_row_costs_the_same(empty: object, arm: Exercise) -> None:
    report = part(handed_in(arm, {"pose": [*POSE[:2], empty, POSE[3]]}), "pose")
    assert report.rows[2].verdict is Verdict.MISSING
    wrong = part(handed_in(arm, {"pose": [*POSE[:2], ["5", "6", "7", "8"], POSE[3]]}), "pose")
    assert report.points <= wrong.points


def test_a_row_of_the_wrong_length_affects_only_itself(arm: Exercise) -> None:
    text = FORMATS["CSV"]([*POSE[:3], ["0", "0", "1"]])
    report = pasted(arm, text)
    assert [row.verdict for row in report.rows] == [Verdict.CORRECT] * 3 + [Verdict.UNREADABLE]
    [feedback] = cell(report, "4", "1").feedback
    assert (feedback.code, feedback.message) == (
        "row_length",
        "Write 4 entries in this row; it has 3.",
    )


@pytest.mark.parametrize(
    ("text", "size"),
    [
        ("[1 2 3; 4 5 6; 7 8 9]", "3 × 3"),
        ("[[1]]", "1 × 1"),
        ("1,2,3,4,5\n1,2,3", "2 × 3 to 5"),
        (FORMATS["CSV"]([*POSE, ["0", "0", "0", "1"]]), "5 × 4"),
    ],
)
def test_a_matrix_of_the_wrong_size_is_refused_with_both_sizes(
    text: str, size: str, arm: Exercise
) -> None:
    report = pasted(arm, text)
    assert (report.verdict, report.points, report.rows) == (Verdict.UNREADABLE, 0.0, ())
    [feedback] = report.feedback
    assert feedback.code == "wrong_shape"
    assert feedback.message.endswith(f"yours is {size}.")


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("c1 + s1", "wrong_shape"),
        ("[1 2; 3 4]'", "text_around"),
        ("[1 2; 3 4", "unbalanced_bracket"),
        ("[c1 -s1, 0; s1 c1, 0]", "mixed_separators"),
    ],
)
def test_a_text_without_a_matrix_is_refused(text: str, code: str, arm: Exercise) -> None:
    report = pasted(arm, text)
    assert (report.verdict, [feedback.code for feedback in report.feedback]) == (
        Verdict.UNREADABLE, [code],
    )  # fmt: skip


def test_an_empty_paste_is_missing(arm: Exercise) -> None:
    assert pasted(arm, " \n").verdict is Verdict.MISSING


# --- Read all link transforms of an arm from one text

A1 = "[c1 -s1 0 a1*c1; s1 c1 0 a1*s1; 0 0 1 0; 0 0 0 1]"
A2 = "[c2 -s2 0 a2*c2; s2 c2 0 a2*s2; 0 0 1 0; 0 0 0 1]"


@pytest.fixture
def matrix_list_arm(catalogue: Mapping[str, Exercise]) -> Exercise:
    # Return an arm with two revolute joints, whose tool frame is the frame of the second link.
    return catalogue["planar-rr"]


def matrix_list_pasted(arm: Exercise, answer: object) -> PartReport:
    return part(handed_in(arm, {"links": answer}), "links")


@pytest.mark.parametrize(
    ("text", "notes"),
    [
        (f"A1 = {A1}\nA2 = {A2}", set()),
        (f"{A1}\n{A2}", set()),
        (f"A2 = {A2}; A1 = {A1};", {"matrix_order"}),
        (f"A0 = {A1}\nA1 = {A2}", {"matrix_names"}),
        (f"A1 = {A1}\nA2 = {A2}\nT = {A1}", {"matrix_left_aside"}),
        (f"T01 = {A1}\nT12 = {A2}\nT02 = {A1}", {"matrix_left_aside"}),
        (f"A1 = {A1}\n{A2}", set()),
        (f"T = {A1}\nR = {A2}", set()),
        (f"theta1 = pi/2\nA1 = {A1}\nA2 = {A2}", {"matrix_left_aside"}),
        (f"H1 = {A1}, H2 = {A2}, H1*H2 = T", {"matrix_left_aside"}),
        (f"H1 = {A1}\nH2 = {A2}\nH1*H2 = {A1}", {"matrix_left_aside"}),
        (f"A1 = {A1}\nA2 = {A2}\ninv(A1) = {A1}", {"matrix_left_aside"}),
        (f"T12 = {A1}\nT23 = {A2}", {"matrix_names"}),
    ],
)
def test_matrices_in_another_order_get_full_marks_and_a_note(
    text: str, notes: set[str], matrix_list_arm: Exercise
) -> None:
    report = matrix_list_pasted(matrix_list_arm, text)
    assert full_marks(report), report
    assert all_codes(report) == notes | {"blank_before_sign"}


@pytest.mark.parametrize(
    ("text", "code", "marked"),
    [
        (f"A1 = {A1}\nA1 = {A2}", "duplicate_matrix", "A1"),
        (f"A1 = {A1}\nA7 = {A2}", "unknown_matrix", "A7"),
        (f"A1 = {A1}\nT = {A2}\nB = {A2}", "unknown_matrix", "B"),
        (f"inv(A1) = {A1}\nA2 = {A2}", "unknown_matrix", "inv(A1)"),
        (f"A1' = {A1}\nA2 = {A2}", "unknown_matrix", "A1'"),
        (f"A1 = {A1}\nA2.T = {A2}", "unknown_matrix", "A2.T"),
        (f"{A1}\n{A2}\n{A1}", "wrong_shape", A1[1:-1]),
        ("see the attached file", "wrong_shape", "see the attached file"),
        (f"A1 = {A1[:-1]}\nA2 = {A2}", "unbalanced_bracket", "["),
    ],
)
def test_matrices_that_cannot_be_identified_are_refused(
    text: str, code: str, marked: str, matrix_list_arm: Exercise
) -> None:
    report = matrix_list_pasted(matrix_list_arm, text)
    [feedback] = report.feedback
    assert (report.verdict, feedback.code) == (Verdict.UNREADABLE, code)
    assert feedback.span is not None
    assert text[slice(*feedback.span)] == marked


@pytest.mark.parametrize(
    ("answer", "notes"),
    [
        ([f"A2 = {A2}", f"A1 = {A1}"], {"matrix_order"}),
        ([f"A1 = {A1}", f"A2 = {A2}"], set()),
        ([f"T = {A1}", f"R = {A2}"], set()),
        ([f"T12 = {A1}", f"T23 = {A2}"], {"matrix_names"}),
    ],
)
def test_texts_in_a_list_are_ordered_by_their_names(
    answer: list[str], notes: set[str], matrix_list_arm: Exercise
) -> None:
    report = matrix_list_pasted(matrix_list_arm, answer)
    assert full_marks(report), report
    assert all_codes(report) == notes | {"blank_before_sign"}


@pytest.mark.parametrize("names", ["A6 A4 A5", "T56 T34 T45", "T_6^5 T_4^3 T_5^4", "A3 A1 A2"])
def test_links_may_have_the_numbers_of_the_joints(
    names: str, make_exercise: Callable[[str], Exercise]
) -> None:
    wrist = make_exercise(WRIST)
    texts = [f"{name} = {a}" for name, a in zip(names.split(), (A6, A4, A5), strict=True)]
    for answer in (texts, "\n".join(texts)):
        report = matrix_list_pasted(wrist, answer)
        assert full_marks(report), report
        assert all_codes(report) == {"matrix_order"}


def test_a_list_of_texts_under_the_wrong_names_is_wrong(matrix_list_arm: Exercise) -> None:
    report = matrix_list_pasted(matrix_list_arm, [f"A2 = {A1}", f"A1 = {A2}"])
    assert (report.verdict, report.points) == (Verdict.INCORRECT, 0)


@pytest.mark.parametrize(
    ("answer", "code"),
    [
        ([f"A1 = {A1}", f"A1 = {A2}"], "duplicate_matrix"),
        ([f"inv(A1) = {A1}", f"A2 = {A2}"], "unknown_matrix"),
        ([f"A1 = {A1}", f"A5 = {A2}"], "unknown_matrix"),
    ],
)
def test_contradicting_names_in_a_list_are_refused(
    answer: list[str], code: str, matrix_list_arm: Exercise
) -> None:
    report = matrix_list_pasted(matrix_list_arm, answer)
    [feedback] = report.feedback
    assert (report.verdict, feedback.code, feedback.span) == (Verdict.UNREADABLE, code, None)


def test_a_product_is_not_a_link(matrix_list_arm: Exercise) -> None:
    report = matrix_list_pasted(matrix_list_arm, f"A1 = {A1}\nA1*A2 = {A2}")
    assert [row.verdict for row in report.rows] == [Verdict.CORRECT] * 4 + [Verdict.MISSING] * 4


def test_an_unreadable_matrix_affects_only_itself(matrix_list_arm: Exercise) -> None:
    for answer in (f"A1 = {A1}\nA2 = {A2}'", [A1, f"{A2}'"]):
        report = matrix_list_pasted(matrix_list_arm, answer)
        assert [row.verdict for row in report.rows] == (
            [Verdict.CORRECT] * 4 + [Verdict.UNREADABLE] * 4
        )
        assert codes(cell(report, "A2.1", "1")) == ["text_around"]
        assert codes(cell(report, "A2.1", "2")) == []
        assert 0 < report.points < report.max_points


def test_a_matrix_of_the_wrong_size_affects_only_itself(matrix_list_arm: Exercise) -> None:
    report = matrix_list_pasted(matrix_list_arm, f"A1 = {A1}\nA2 = [1 2; 3 4]")
    assert codes(cell(report, "A2.1", "1")) == ["wrong_shape"]
    assert report.rows[0].verdict is Verdict.CORRECT


def test_an_absent_matrix_is_missing(matrix_list_arm: Exercise) -> None:
    report = matrix_list_pasted(matrix_list_arm, f"A2 = {A2}")
    assert [row.verdict for row in report.rows] == [Verdict.MISSING] * 4 + [Verdict.CORRECT] * 4


def test_an_empty_list_of_matrices_is_missing(matrix_list_arm: Exercise) -> None:
    assert matrix_list_pasted(matrix_list_arm, " \n").verdict is Verdict.MISSING


def test_a_span_counts_in_the_whole_text(matrix_list_arm: Exercise) -> None:
    text = f"A1 = {A1}\nA2 = {A2.replace('a2*s2', 'foo')}"
    [feedback] = cell(matrix_list_pasted(matrix_list_arm, text), "A2.2", "4").feedback
    assert feedback.span is not None
    assert text[slice(*feedback.span)] == "foo"


def test_the_preview_has_the_rows_of_the_report(matrix_list_arm: Exercise) -> None:
    text = f"A2 = {A2}\nA1 = {A1}"
    shown = preview_pasted(text, matrix_list_arm, "links")
    assert shown.ok
    assert [row[0].row for row in shown.rows] == [
        row.label for row in matrix_list_pasted(matrix_list_arm, text).rows
    ]
    assert [row[0].typed for row in shown.rows] == ["c1", "s1", "0", "0", "c2", "s2", "0", "0"]
    assert "matrix_order" in {note.code for note in shown.notes}


def test_the_preview_shows_unreadable_cells(matrix_list_arm: Exercise) -> None:
    [*rows, last] = preview_pasted(f"A1 = {A1}\nA2 = {A2}'", matrix_list_arm, "links").rows
    assert len(rows) == 4
    assert [(each.row, each.problem.code) for each in last if each.problem] == [
        ("A2", "text_around")
    ]
    problem = preview_pasted(f"A1 = {A1}\nA1 = {A2}", matrix_list_arm, "links").problem
    assert problem is not None
    assert problem.code == "duplicate_matrix"


def test_a_note_on_the_reading_is_shown_once(matrix_list_arm: Exercise) -> None:
    report = matrix_list_pasted(matrix_list_arm, f"A1 = {A1}\nA2 = {A2}")
    assert [message.code for message in report.feedback] == ["blank_before_sign"]


# --- Find the link to which the name of a matrix refers


def places(names: str, count: int, first: int = 1) -> list[int | None]:
    numbers = range(first, first + count)
    return list(places_of([indices_of(name.strip()) for name in names.split("|")], numbers)[0])


@together(
    "names",
    [
        "A1 | A2 | A3", "A_1 | A_2 | A_3", "A_{1} | A_{2} | A_{3}", "A{1} | A{2} | A{3}",
        "A_1(q_1) | A_2(q_2) | A_3(q_3)", r"A_1(\theta_1) | A_2(\theta_2) | A_3(d_3)",
        r"{}^{0}T_{1} | {}^{1}T_{2} | {}^{2}T_{3}", "^0T_1 | ^1T_2 | ^2T_3", "T01 | T12 | T23",
        r"{}^0_1T | {}^1_2T | {}^2_3T", "T_{01} | T_{12} | T_{23}", "T_{0,1} | T_{1,2} | T_{2,3}",
        "T_1^0 | T_2^1 | T_3^2", r"\mathbf{A}^0_1 | \mathbf{A}^1_2 | \mathbf{A}^2_3",
        "A(:,:,1) | A(:,:,2) | A(:,:,3)", "T0_1 | T1_2 | T2_3", "Link 1 | Link 2 | Link 3",
        "A[0] | A[1] | A[2]", "A0 | A1 | A2", "T_1 | T_2 | T_e", "A1 | A2 | An", "A1 | A2 | Ae",
        "T01 | T12 | T_{2,tool}", "T01 | T02 | T03", "T12 | T23 | T34", "H10 | H21 | H32",
    ],
)  # fmt: skip
def test_three_names_mean_the_links_in_order(names: str) -> None:
    assert places(names, 3) == [1, 2, 3]


@pytest.mark.parametrize(
    ("names", "count", "expected"),
    [
        ("A3 | A1 | A2", 3, [3, 1, 2]),
        ("T12 | T01", 2, [2, 1]),
        ("A1 | A2 | T", 2, [1, 2, None]),
        ("A1 | A2 | T_{02}", 2, [1, 2, None]),
        ("T01 | T12 | T02", 2, [1, 2, None]),
        ("T01 | T12 | T23 | T03", 3, [1, 2, 3, None]),
        ("A1 | A1", 2, [1, 1]),
        ("A1 | A7", 2, [1, None]),
        ("A11 | A12", 12, [11, 12]),
        ("T01 | T89 | T910", 10, [1, 9, 10]),
        ("T_{910} | T_{1011} | T_{1112}", 12, [10, 11, 12]),
        ("H10 | H109", 10, [1, 10]),
        ("T01 | T12 | T100", 10, [1, 2, None]),
        ("A1 | A3", 3, [1, 3]),
        ("ans | ans", 2, [None, None]),
        ("A1*A2*A3", 3, [None]),
    ],
)
def test_names_mean_these_places(names: str, count: int, expected: list[int | None]) -> None:
    assert places(names, count) == expected


@together(
    "names",
    [
        "A4 | A5 | A6", "T34 | T45 | T56", "T_4^3 | T_5^4 | T_6^5", "{}^3T_4 | {}^4T_5 | {}^5T_6",
        "T_{3,4} | T_{4,5} | T_{5,tool}", "A4 | A5 | Ae", "A1 | A2 | A3", "T01 | T12 | T23",
        "A0 | A1 | A2", "A1 | A2 | An",
    ],
)  # fmt: skip
def test_names_of_a_wrist_count_by_its_joints_or_from_one(names: str) -> None:
    assert places(names, 3, first=4) == [1, 2, 3]


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        ("A2 | A3 | A4", [1, 2, 3]),
        ("A2 | A3", [1, 2]),
        ("A3 | A4", [2, 3]),
        ("A1 | A2", [1, 2]),
        ("A3 | A2 | A1", [3, 2, 1]),
        ("A4 | A1", [3, None]),
        ("A4 | A4", [3, 3]),
        ("T12 | T23 | T34", [1, 2, 3]),
        ("T12 | T23", [1, 2]),
        ("T01 | T12", [1, 2]),
    ],
)
def test_the_robots_own_numbers_come_first(names: str, expected: list[int | None]) -> None:
    assert places(names, 3, first=2) == expected


def test_names_may_count_from_zero_or_from_one() -> None:
    def unusual(*names: str) -> str:
        return places_of([indices_of(name) for name in names], range(1, len(names) + 1))[1]

    assert unusual("A0", "A1")
    assert not unusual("A1", "A2")
    assert not unusual("T01", "T12")


@pytest.mark.parametrize(
    "name", ["inv(A1)", "A1'", "A1.T", "A1inv", "A_1^T", "A_1^{-1}", "A_1^{T}", r"A_1^\top"]
)
def test_names_of_inverses_and_transposes(name: str) -> None:
    assert is_changed(name)


@pytest.mark.parametrize(
    "name", ["A1", "^0T_1", "{}^{0}T_{1}", "{}^T_2 T", r"A_1(\theta_1)", "T_1^0", "Link 2", "A1.m"]
)
def test_names_of_links(name: str) -> None:
    assert not is_changed(name)
    assert not is_product(name)


@pytest.mark.parametrize("name", ["A1*A2", "A_1 A_2", "A1 @ A2", r"A_1 \cdot A_2", "A1A2"])
def test_names_of_products(name: str) -> None:
    assert is_product(name)


# --- Read screw axes as students write them

PART = "space-screws"

# The axes of the lecture's planar RPR arm: docs/answer-kinds.md.
TEXTS = {
    "MATLAB's rows with names": "S1 = [0 0 1 0 0 0]\nS2 = [0 0 0 1 0 0]\nS3 = [0 0 1 0 -L1 0]",
    "MATLAB's columns": "S1 = [0;0;1;0;0;0]; S2=[0;0;0;1;0;0]; S3=[0;0;1;0;-L1;0];",
    "columns without names": "[0;0;1;0;0;0], [0;0;0;1;0;0], [0;0;1;0;-L1;0]",
    "transposed": "S_1 = (0,0,1,0,0,0)^T, S_2 = (0,0,0,1,0,0)^T, S_3 = (0,0,1,0,-L1,0)^T",
    "Mathematica": "S1 = {0,0,1,0,0,0}; S2 = {0,0,0,1,0,0}; S3 = {0,0,1,0,-L1,0};",
    "another order": "S3 = [0 0 1 0 -L1 0]\nS1 = [0 0 1 0 0 0]\nS2 = [0 0 0 1 0 0]",
    "LaTeX": r"\mathcal{S}_1 = \begin{bmatrix}0\\0\\1\\0\\0\\0\end{bmatrix}, "
    r"\mathcal{S}_2 = \begin{bmatrix}0\\0\\0\\1\\0\\0\end{bmatrix}, "
    r"\mathcal{S}_3 = \begin{bmatrix}0\\0\\1\\0\\-L_1\\0\end{bmatrix}",
    "NumPy, transposed": "np.array([[0,0,1,0,0,0],[0,0,0,1,0,0],[0,0,1,0,-L1,0]]).T",
    "halves with names": "w1 = [0 0 1], v1 = [0 0 0]\nw2 = [0 0 0], v2 = [1 0 0]\n"
    "w3 = [0 0 1], v3 = [0 -L1 0]",
    "halves in LaTeX": r"\hat{\omega}_1 = (0,0,1), v_1 = (0,0,0), \hat{\omega}_2 = (0,0,0), "
    r"v_2 = (1,0,0), \hat{\omega}_3 = (0,0,1), v_3 = (0,-L1,0)",
    "halves in rows": "[[0,0,1],[0,0,0]], [[0,0,0],[1,0,0]], [[0,0,1],[0,-L1,0]]",
    "a table of halves": "| i | ω | v |\n|---|---|---|\n| 1 | (0,0,1) | (0,0,0) |\n"
    "| 2 | (0,0,0) | (1,0,0) |\n| 3 | (0,0,1) | (0,-L1,0) |",
    "v before ω": "| i | v | ω |\n|---|---|---|\n| 1 | (0,0,0) | (0,0,1) |\n"
    "| 2 | (1,0,0) | (0,0,0) |\n| 3 | (0,-L1,0) | (0,0,1) |",
    "v before ω, in words": "linear velocity; angular velocity\n(0,0,0); (0,0,1)\n"
    "(1,0,0); (0,0,0)\n(0,-L1,0); (0,0,1)",
    "rows by their numbers": "| joint | axis ω | v |\n|---|---|---|\n| 3 | (0,0,1) | (0,-L1,0) |\n"
    "| 1 | (0,0,1) | (0,0,0) |\n| 2 | (0,0,0) | (1,0,0) |",
    "rows without numbers": "| type | ω | v |\n|---|---|---|\n| R | (0,0,1) | (0,0,0) |\n"
    "| P | (0,0,0) | (1,0,0) |\n| R | (0,0,1) | (0,-L1,0) |",
}
LISTS: dict[str, Any] = {
    "pairs": [[[0, 0, 1], [0, 0, 0]], [[0, 0, 0], [1, 0, 0]], [[0, 0, 1], [0, "-L1", 0]]],
    "columns": [[[0], [0], [1], [0], [0], [0]], [[0], [0], [0], [1], [0], [0]],
                [[0], [0], [1], [0], ["-L1"], [0]]],
    "by name": {"S3": [0, 0, 1, 0, "-L1", 0], "S1": [0, 0, 1, 0, 0, 0], "S2": [0, 0, 0, 1, 0, 0]},
    "objects": [{"omega": [0, 0, 1], "v": [0, 0, 0]}, {"v": [1, 0, 0], "w": [0, 0, 0]},
                {"ω": [0, 0, 1], "v": [0, "-L1", 0]}],
}  # fmt: skip
COLUMNS = {
    "MATLAB": "Slist = [0 0 0; 0 0 0; 1 0 1; 0 1 0; 0 0 -L1; 0 0 0]",
    "blanks": "0 0 0\n0 0 0\n1 0 1\n0 1 0\n0 0 -L1\n0 0 0",
}


# The axes of the spherical wrist by the numbers of its joints, that of joint 5 first.
BY_JOINTS: dict[str, Any] = {
    "rows": "S5 = [0; 1; 0; 0; 0; 0]\nS4 = [0; 0; 1; 0; 0; 0]\nS6 = [0; 0; 1; 0; 0; 0]",
    "halves": "w5 = [0 1 0], v5 = [0 0 0]\nw4 = [0 0 1], v4 = [0 0 0]\nw6 = [0 0 1], v6 = [0 0 0]",
    "a table": "| i | ω | v |\n|---|---|---|\n| 5 | (0,1,0) | (0,0,0) |\n"
    "| 4 | (0,0,1) | (0,0,0) |\n| 6 | (0,0,1) | (0,0,0) |",
    "an object": {"S5": [0, 1, 0, 0, 0, 0], "S4": [0, 0, 1, 0, 0, 0], "S6": [0, 0, 1, 0, 0, 0]},
    "from one": "S2 = [0; 1; 0; 0; 0; 0]\nS1 = [0; 0; 1; 0; 0; 0]\nS3 = [0; 0; 1; 0; 0; 0]",
}


@pytest.fixture
def rpr(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["planar-rpr-poe"]


@pytest.mark.parametrize("header", ["ω | q", "q | ω", "v | s", "ω | ω"])
def test_a_table_of_other_vectors_is_not_read(header: str, rpr: Exercise) -> None:
    # A point on an axis is not read as v, and v is not read as ω.
    rows = "| (0,0,0) | (0,0,1) |\n| (1,0,0) | (0,0,0) |\n| (0,L1,0) | (0,0,1) |"
    report = part(handed_in(rpr, {PART: f"| {header} |\n|---|---|\n{rows}"}), PART)
    assert report.verdict is Verdict.UNREADABLE


@pytest.mark.parametrize("answer", [*TEXTS.values(), *LISTS.values()], ids=[*TEXTS, *LISTS])
def test_every_way_of_writing_is_read(answer: Any, rpr: Exercise) -> None:
    report = part(handed_in(rpr, {PART: answer}), PART)
    assert full_marks(report), report
    assert all_codes(report) <= {"blank_before_sign"}


@pytest.mark.parametrize("text", COLUMNS.values(), ids=COLUMNS)
def test_axes_may_be_columns(text: str, rpr: Exercise) -> None:
    report = part(handed_in(rpr, {PART: text}), PART)
    assert full_marks(report), report
    assert all_codes(report) - {"blank_before_sign", "blank_columns"} == {"columns_as_axes"}


@pytest.mark.parametrize("text", [*TEXTS.values(), *COLUMNS.values()], ids=[*TEXTS, *COLUMNS])
def test_the_preview_has_the_same_rows(text: str, rpr: Exercise) -> None:
    preview = preview_pasted(text, rpr, PART)
    assert preview.ok
    assert [[cell.text for cell in row] for row in preview.rows] == [
        ["0", "0", "1", "0", "0", "0"],
        ["0", "0", "0", "1", "0", "0"],
        ["0", "0", "1", "0", "-L1", "0"],
    ]


@pytest.mark.parametrize("answer", BY_JOINTS.values(), ids=BY_JOINTS)
def test_axes_may_have_the_numbers_of_the_joints(
    answer: Any, make_exercise: Callable[[str], Exercise]
) -> None:
    report = part(handed_in(make_exercise(WRIST), {"screws": answer}), "screws")
    assert full_marks(report), report


def test_halves_count_in_the_same_way(make_exercise: Callable[[str], Exercise]) -> None:
    # v1 is missing; v2 and v3 alone would be those of the joints 2 and 3, the first two.
    arm = make_exercise(
        WRIST.replace("theta4", "theta2").replace("theta6", "theta4").replace("theta5", "theta3")
    )
    text = "w1 = [0 0 1]\nw2 = [0 1 0], v2 = [0 0 0]\nw3 = [0 0 1], v3 = [0 0 0]"
    report = part(handed_in(arm, {"screws": text}), "screws")
    assert {(row, verdict) for (row, _), verdict in not_correct(report).items()} == {
        ("2", Verdict.MISSING)
    }


@pytest.mark.parametrize(
    "layout",
    [
        "w{i} = [0 0 1], v{i} = [0 -{i} 0]",
        "w{i} = np.array([0, 0, 1])\nv{i} = np.array([0, -{i}, 0])",
        r"\hat{{\omega}}_{{{i}}} = (0,0,1), v_{{{i}}} = (0,-{i},0),",
        r"\omega_{{{i}}} = \pmatrix{{0\\0\\1}}, v_{{{i}}} = \pmatrix{{0\\-{i}\\0}} \\",
    ],
)
def test_twelve_axes_may_be_halves(layout: str, make_exercise: Callable[[str], Exercise]) -> None:
    expected = [["0", "0", "1", "0", f"-{i}", "0"] for i in range(1, 13)]
    arm = make_exercise(f"{WRIST}expected = {expected}\n")
    text = "\n".join(layout.format(i=i) for i in range(1, 13))
    report = part(handed_in(arm, {"screws": text}), "screws")
    assert full_marks(report), report


def test_an_absent_axis_is_missing(rpr: Exercise) -> None:
    report = part(handed_in(rpr, {PART: "S1 = [0 0 1 0 0 0]; S3 = [0 0 1 0 -L1 0]"}), PART)
    assert {(row, verdict) for (row, _), verdict in not_correct(report).items()} == {
        ("2", Verdict.MISSING)
    }


@pytest.mark.parametrize(
    "text",
    [
        "S1 = [0 0 1 0 0 0]\nS1 = [0 0 0 1 0 0]\nS3 = [0 0 1 0 -L1 0]",
        "S1 = [0 0 1 0 0 0]\nS2 = [0 0 0 1 0 0]\nS7 = [0 0 1 0 -L1 0]",
        "w1 = [0 0 1], q1 = [0 0 0]\nw2 = [0 0 0], q2 = [1 0 0]\nw3 = [0 0 1], q3 = [L1 0 0]",
        "w1 = [0 0 1], w2 = [0 0 0], w3 = [0 0 1]",
        "S1 = [0 0 1]\nS2 = [0 0 0 1 0 0]",
    ],
)
def test_ambiguous_axes_are_refused(text: str, rpr: Exercise) -> None:
    report = part(handed_in(rpr, {PART: text}), PART)
    assert report.verdict == Verdict.UNREADABLE
