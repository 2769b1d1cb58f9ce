"""Read matrices that are pasted as text."""

from collections.abc import Mapping
from functools import reduce
from operator import mul
from typing import Any

import pytest
import sympy as sp
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Verdict
from dh_grader.pasting import read_grid
from sympy.printing.numpy import NumPyPrinter

from tests.grading.support.robots import PLANAR_RRR, ROBOTS, Robot
from tests.grading.support.submitting import cell, codes, full_marks, handed_in, not_correct, part
from tests.pasting.writers import FORMATS
from tests.together import together

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
