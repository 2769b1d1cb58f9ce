"""Formulas printed by SymPy are read with the value that they have in SymPy."""

from collections.abc import Callable
from random import Random

import numpy as np
import pytest
import sympy
from dh_grader.expressions import LIMITS, read
from sympy.printing.numpy import NumPyPrinter
from sympy.simplify.fu import TR8, TR10i

from tests.expressions.corpus_files import ROBOT
from tests.expressions.random_formulas import NUMBERS, entry, product, value

VALUES = {name: np.array([number]) for name, number in NUMBERS.items()}
PRINTERS: dict[str, Callable[[sympy.Expr], str]] = {
    "str": str,
    "latex": sympy.latex,
    "latex, folded": lambda e: str(sympy.latex(e, fold_frac_powers=True, fold_short_frac=True)),
    "latex, no brackets": lambda e: str(sympy.latex(e, fold_func_brackets=True, mul_symbol="dot")),
    "latex, times": lambda e: f"$${sympy.latex(e, mul_symbol='times', ln_notation=True)}$$",
    "octave": sympy.octave_code,
    "numpy": lambda e: str(NumPyPrinter().doprint(e)),
    "python": sympy.pycode,
}
REWRITINGS: dict[str, Callable[[sympy.Expr], sympy.Expr]] = {
    "expand": sympy.expand,
    "expand_trig": sympy.expand_trig,
    "sum of angles": lambda e: TR10i(sympy.expand(sympy.expand_trig(e))),
    "trigsimp": lambda e: sympy.trigsimp(sympy.expand(e)),
    # Rules 8 and 10 of Fu et al., which trigsimp uses: products to sums, and sums to products.
    "product to sum": lambda e: TR8(sympy.expand(e)),
    "factor_terms": lambda e: sympy.factor_terms(sympy.expand(e)),
    "collect": lambda e: sympy.collect(sympy.expand(e), list(sympy.ordered(e.free_symbols))[:1]),
}


def worth(text: str) -> float:
    return float(np.ravel(read(text, ROBOT).evaluate(VALUES))[0])


def entries(seed: int, count: int) -> list[sympy.Expr]:
    random = Random(seed)
    return [entry(random) for _ in range(count)]


@pytest.mark.long
@pytest.mark.parametrize("printer", PRINTERS)
def test_a_printed_formula_has_its_value(printer: str) -> None:
    count = 0
    for expression in entries(1, 40):
        text = PRINTERS[printer](expression)
        if len(text) > LIMITS.characters:
            continue
        count += 1
        assert worth(text) == pytest.approx(value(expression), rel=1e-9, abs=1e-9), text
    assert count > 25


@pytest.mark.sampled(4)
@pytest.mark.parametrize("rewriting", REWRITINGS)
def test_a_rewritten_formula_has_the_same_value(rewriting: str) -> None:
    # SymPy rewrites the formula; the reader must give both texts the same value.
    random = Random(2)
    changed = 0
    for _ in range(10):
        expression = product(random)
        rewritten = REWRITINGS[rewriting](expression)
        changed += rewritten != expression
        for pair in ((str(expression), str(rewritten)), (str(expression), sympy.latex(rewritten))):
            assert worth(pair[0]) == pytest.approx(worth(pair[1]), rel=1e-9, abs=1e-9), pair
    assert changed >= 3


@pytest.mark.long
def test_latex_of_an_expression_is_read_back() -> None:
    for expression in entries(3, 40):
        ours = read(str(expression), ROBOT).latex()
        if len(ours) <= LIMITS.characters:
            assert worth(ours) == pytest.approx(value(expression), rel=1e-9, abs=1e-9)
