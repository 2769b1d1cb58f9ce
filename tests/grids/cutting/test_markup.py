"""Read tags and entities in a Markdown cell."""

import pytest
from dh_grader.pasting import read_grid


@pytest.mark.parametrize(
    ("typed", "cell"),
    [
        ("θ<sub>1</sub>", "θ_{1}"),
        ("d<SUB>3</SUB><sup>*</sup>", "d_{3}*"),
        ("90<sup>o</sup>", "90°"),
        ("l1<sup>2</sup>", "l1^(2)"),
        ("&theta;1 + 90&deg;", "θ1 + 90°"),
        ("&pi;/2", "π/2"),
        ("θ<b>1</b>", "θ<b>1</b>"),
        ("l1 < l2", "l1 < l2"),
    ],
)
def test_markup_in_a_cell(typed: str, cell: str) -> None:
    text = f"| a | {typed} |\n|---|---|\n| 1 | 2 |"
    [_, found], *_ = read_grid(text).rows
    assert found.text == cell
    assert text[slice(*found.whole)] == typed
