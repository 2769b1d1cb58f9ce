"""Print formulas as plain text."""

import pytest
from dh_grader.expressions import Vocabulary, read

from tests.expressions.printing.formulas import FORMULAS


@pytest.mark.parametrize(("source", "text"), [formula[:2] for formula in FORMULAS])
def test_text_reads_back_to_the_same_tree(source: str, text: str, arm: Vocabulary) -> None:
    expression = read(source, arm)
    assert expression.text() == text
    assert read(text, arm).tree == expression.tree
