import pytest
from dh_grader.submissions.documents import pasted_from

TABULAR = "\\begin{tabular}{cc}\n$a$ & $d$ \\\\ 0 & 1\n\\end{tabular}"
BARS = "| a | d |\n|---|---|\n| 0 | 1 |"
MATRIX = "DH = [a1 0 0 q1;\n      a2 0 0 q2]"


@pytest.mark.parametrize(
    ("text", "suffix", "pasted"),
    [
        (f"\\documentclass{{article}}\\begin{{document}}Hi\n{TABULAR}\nBye", ".tex", TABULAR),
        (f"# Homework\n\n{BARS}\n\nDone.", ".md", BARS),
        ("Matrix:\n```python\n[[1, 0],\n [0, 1]]\n```\nDone", ".md", "[[1, 0],\n [0, 1]]"),
        (TABULAR, ".tex", TABULAR),
        (
            (f"clear; clc;\nsyms q1 a1 real\nq2 = sym('q2');\n{MATRIX};  % a alpha d theta\n"
            "T = eye(4);\nfor i = 1:2\n  T = T * A(DH(i, :));\nend\ndisp(T)"),
            ".m", MATRIX,
        ),
        ('"a1 c1"\r\n\r\n"-d3"\r\n', ".csv", "a1 c1\n-d3"),
        # The values of its variables precede the matrix.
        (
            f"b = 2; a1 = 0.4; % m\nq1 = pi/2\n{MATRIX};\ndisp(DH)",
            ".m", f"a1 = 0.4\nq1 = pi/2\n{MATRIX}",
        ),
    ],
)  # fmt: skip
def test_text_around_a_table_is_removed(text: str, suffix: str, pasted: str) -> None:
    assert pasted_from(text, suffix).lstrip("\n") == pasted


@pytest.mark.parametrize(
    ("text", "suffix", "line"),
    [
        (f"\\documentclass{{article}}\n\nHi\n{TABULAR}\nBye", ".tex", 4),
        (f"# Homework\n\n{BARS}\n\nDone.", ".md", 3),
        (f"clear; clc;\n\na1 = 0.4;\n\n\n{MATRIX};", ".m", 6),
    ],
)
def test_lines_keep_their_numbers(text: str, suffix: str, line: int) -> None:
    pasted = pasted_from(text, suffix).splitlines()
    assert pasted[line - 1] == text.splitlines()[line - 1]


@pytest.mark.parametrize(
    ("text", "suffix"),
    [
        (f"{TABULAR} and {TABULAR}", ".tex"),
        ("\\begin{tabular}" * 10_000, ".tex"),
        (f"{BARS}\n\n{BARS}", ".md"),
        ("a, d\n0, 1", ".md"),
        (f"x\n{BARS}\n\ny", ".csv"),
        # The last row does not belong to another table.
        (f"{BARS}\nand\n| 2 | 3 |", ".md"),
        ('"a1","a2"\n"0","1"', ".csv"),
        ('"a1"\na2', ".csv"),
        (f"{MATRIX};\nB = [1 2; 3 4];", ".m"),
        # The matrix is changed later, or its variables have other values.
        (f"{MATRIX};\nDH(1, 3) = d1;", ".m"),
        (f"{MATRIX};\nDH = DH * 2;", ".m"),
        (f"q1 = [0 1];\n{MATRIX};", ".m"),
        (f"[q1, q2] = deal(0, 1);\n{MATRIX};", ".m"),
        ("A = [", ".m"),
        ("A = [0]\n" * 10_000, ".m"),
    ],
)
def test_a_text_without_exactly_one_table_is_unchanged(text: str, suffix: str) -> None:
    assert pasted_from(text, suffix) == text
