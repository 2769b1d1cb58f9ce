"""Random SymPy formulas like those in forward kinematics."""

from random import Random
from typing import Final

import sympy

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
