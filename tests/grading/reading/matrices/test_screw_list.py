"""Read screw axes as students write them."""

from collections.abc import Callable, Mapping
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict
from dh_grader.grading.reading import preview_pasted

from tests.grading.support.exercise_texts import all_codes
from tests.grading.support.submitting import full_marks, handed_in, not_correct, part
from tests.grading.support.wrist import WRIST

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
