import pytest

from service.submissions.documents import pasted_from

TABULAR = "\\begin{tabular}{cc}\n$a$ & $d$ \\\\ 0 & 1\n\\end{tabular}"
BARS = "| a | d |\n|---|---|\n| 0 | 1 |"


@pytest.mark.parametrize(
    ("text", "suffix", "pasted"),
    [
        (f"\\documentclass{{article}}\\begin{{document}}Hi\n{TABULAR}\nBye", ".tex", TABULAR),
        (f"# Homework\n\n{BARS}\n\nDone.", ".md", BARS),
        ("Matrix:\n```python\n[[1, 0],\n [0, 1]]\n```\nDone", ".md", "[[1, 0],\n [0, 1]]"),
        (TABULAR, ".tex", TABULAR),
    ],
)
def test_the_words_around_a_table_are_left_out(text: str, suffix: str, pasted: str) -> None:
    assert pasted_from(text, suffix) == pasted


@pytest.mark.parametrize(
    ("text", "suffix"),
    [
        (f"{TABULAR} and {TABULAR}", ".tex"),
        ("\\begin{tabular}" * 10_000, ".tex"),
        (f"{BARS}\n\n{BARS}", ".md"),
        ("a, d\n0, 1", ".md"),
        (f"x\n{BARS}\n\ny", ".csv"),
    ],
)
def test_without_just_one_the_text_stays(text: str, suffix: str) -> None:
    assert pasted_from(text, suffix) == text
