"""Test formulas that SymPy prints."""

from collections.abc import Callable
from random import Random
from typing import Final

import numpy as np
import pytest
import sympy
from dh_grader.expressions import LIMITS, read
from sympy.printing.numpy import NumPyPrinter
from sympy.simplify.fu import TR8, TR10i

from tests.expressions.corpus_files import ROBOT

# --- Random SymPy formulas like those in forward kinematics

ANGLES: Final = sympy.symbols("theta_1 theta_2 theta_4 theta_5")
LENGTHS: Final = sympy.symbols("l_1 l_2 a_1 d_3")
OFFSETS: Final = (0, 0, sympy.pi / 2, -sympy.pi / 2, sympy.pi)
NUMBERS: Final = {
    "theta1": 0.3, "theta2": 0.5, "theta4": 0.9, "theta5": -0.4, "l1": 1.1, "l2": 1.2, "a1": 0.6,
    "d3": 0.7, "alpha1": 0.15, "k": 2.0,
}  # fmt: skip


def entry(random: Random) -> sympy.Expr:
    terms = [_term(random) for _ in range(random.randint(1, 4))]
    total = sum(terms, sympy.Integer(0))
    wrap = random.randrange(8)
    if wrap == 0:
        return sympy.sqrt(total**2 + random.choice(LENGTHS) ** 2)
    if wrap == 1:
        return sympy.atan2(total, random.choice(LENGTHS) + _term(random))
    if wrap == 2:
        return total / random.choice([2, 3, sympy.sqrt(2), random.choice(LENGTHS)])
    if wrap == 3:
        return sympy.acos(sympy.cos(random.choice(ANGLES)) / 2) + sympy.Abs(total)
    return total


def product(random: Random) -> sympy.Expr:
    first, second = random.sample(ANGLES, 2)
    left, right = random.sample(LENGTHS, 2)
    along = random.choice([sympy.cos, sympy.sin])
    return (left * along(first) + right * along(first + second)) * random.choice(
        [sympy.cos(second), sympy.sin(first + second), left + sympy.cos(first), 2 * left]
    )


def _term(random: Random) -> sympy.Expr:
    factor = random.choice(
        [1, -1, sympy.Rational(1, 2), sympy.Rational(-3, 4), sympy.sqrt(2), 0.25, 1.5e-3, *LENGTHS]
    )
    for _ in range(random.randint(0, 3)):
        angle = sum(random.sample(ANGLES, random.randint(1, 3)), random.choice(OFFSETS))
        function = random.choice([sympy.sin, sympy.cos])
        factor = factor * function(angle) ** random.choice([1, 1, 1, 2])
    return factor + random.choice([0, 0, 0, random.choice(ANGLES), sympy.pi / 2])


def value(expression: sympy.Expr) -> float:
    at = {name: NUMBERS[name.name.replace("_", "")] for name in expression.free_symbols}
    return float(expression.evalf(20, subs=at))


# --- Formulas printed by SymPy are read with the value that they have in SymPy

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
