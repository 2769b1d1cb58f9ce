"""Print formulas as LaTeX."""

import pytest
from dh_grader.expressions import Symbol, Vocabulary, read

from tests.expressions.printing.formulas import FORMULAS


@pytest.mark.parametrize(("source", "text", "latex"), FORMULAS)
def test_latex_is_as_typed(source: str, text: str, latex: str, arm: Vocabulary) -> None:
    assert read(source, arm).latex() == read(text, arm).latex() == latex


@pytest.mark.parametrize(
    ("symbol", "latex"),
    [
        (Symbol("theta12", "angle"), r"\theta_{12}"),
        (Symbol("R", "length"), "R"),
        (Symbol("l_base", "length"), r"l_{\mathrm{base}}"),
        (Symbol("offset", "length"), r"\mathrm{offset}"),
        (Symbol("d3", "length", latex="d_3^*"), "d_3^*"),
    ],
)
def test_a_symbol_is_printed_with_its_index(symbol: Symbol, latex: str) -> None:
    assert read(symbol.name, Vocabulary([symbol])).latex() == latex
