"""Generate random formulas as trees, and evaluate them without the tested code."""

#     Number 0.5 | Ratio 1/2 | Turn 90 (degrees) | Name q1
#     Sum of signed terms | Product of factors | Quotient | Power (an integer exponent) | Call
#
# The argument of sin, cos and tan is a sum of angle names, multiples of these names, and constants.

import math
from collections.abc import Mapping
from random import Random
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]

# The robot of docs/expressions.md: joint 3 is prismatic.
TURNING: Final = (1, 2, 4, 5, 6)
JOINTS: Final = tuple(f"q{index}" for index in TURNING)
ANGLES: Final = ("alpha1", "alpha2", "beta")
LENGTHS: Final = ("l1", "l2", "a1", "a2", "d1", "l_base", "q3")
NAMES: Final = (*JOINTS, *ANGLES, *LENGTHS, "k")


class Number(NamedTuple):
    """A decimal number without a sign, as text."""

    text: str


class Ratio(NamedTuple):
    """A fraction of whole numbers."""

    top: int
    bottom: int


class Turn(NamedTuple):
    """A positive constant angle in whole degrees."""

    degrees: int


class Name(NamedTuple):
    """A symbol, such as q1."""

    name: str


class Sum(NamedTuple):
    """A sum of signed terms."""

    terms: "tuple[tuple[int, Tree], ...]"


class Product(NamedTuple):
    """A product of two or more factors."""

    factors: "tuple[Tree, ...]"


class Quotient(NamedTuple):
    """A fraction of two formulas."""

    top: "Tree"
    bottom: "Tree"


class Power(NamedTuple):
    """A power with an integer exponent."""

    base: "Tree"
    exponent: int


class Call(NamedTuple):
    """A call of a function such as sin or atan2."""

    function: str
    arguments: "tuple[Tree, ...]"


Tree = Number | Ratio | Turn | Name | Sum | Product | Quotient | Power | Call

_FUNCTIONS: Final = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos,
    "atan": np.arctan, "atan2": np.arctan2, "sqrt": np.sqrt, "abs": np.abs, "exp": np.exp,
}  # fmt: skip


def evaluated(tree: Tree, values: Mapping[str, Values]) -> Values:
    with np.errstate(all="ignore"):
        return np.asarray(_evaluated(tree, values), dtype=float)


def _evaluated(tree: Tree, values: Mapping[str, Values]) -> Values:
    match tree:
        case Name(name):
            return values[name]
        case Sum(terms):
            return np.asarray(sum(sign * _evaluated(term, values) for sign, term in terms))
        case Product(factors):
            return np.asarray(math.prod(_evaluated(factor, values) for factor in factors))
        case Quotient(top, bottom):
            return _evaluated(top, values) / _evaluated(bottom, values)
        case Power(base, exponent):
            return _evaluated(base, values) ** float(exponent)
        case Call(function, arguments):
            found: Values = _FUNCTIONS[function](*(_evaluated(each, values) for each in arguments))
            return found
        case _:
            return _constant(tree) * np.ones_like(next(iter(values.values())))


def _constant(tree: Number | Ratio | Turn) -> float:
    match tree:
        case Number(text):
            return float(text)
        case Ratio(top, bottom):
            return top / bottom
        case Turn(degrees):
            return math.radians(degrees)


def numbers(random: Random, samples: int = 7) -> dict[str, Values]:
    """Return ``samples`` random values for each symbol."""
    return {name: np.array([random.uniform(0.25, 1.25) for _ in range(samples)]) for name in NAMES}


def angle(random: Random) -> Tree:
    """Return a random argument of sin, cos or tan."""
    if random.random() < 0.55:
        chosen = sorted(random.sample(JOINTS, random.choice((1, 1, 1, 2, 2, 3))))
        terms: list[tuple[int, Tree]] = [(1, Name(name)) for name in chosen]
        return terms[0][1] if len(terms) == 1 else Sum(tuple(terms))
    mixed = random.sample((*JOINTS, *ANGLES), random.randint(1, 3))
    signed: list[tuple[int, Tree]] = []
    for name in mixed:
        term: Tree = Name(name)
        if random.random() < 0.2:
            term = Product((random.choice((Number("2"), Number("3"), Number("0.5"))), term))
        elif random.random() < 0.1:
            term = Quotient(term, Number("2"))
        signed.append((random.choice((1, 1, -1)), term))
    if random.random() < 0.4:
        signed.insert(random.choice((0, len(signed))), (random.choice((1, -1)), _turn(random)))
    if len(signed) == 1 and signed[0][0] == 1:
        return signed[0][1]
    return Sum(tuple(signed))


def _turn(random: Random) -> Turn:
    return Turn(random.choice((90, 90, 90, 180, 45, 30, 60, 120, 135, 270)))


def _wave(random: Random) -> Tree:
    call = Call(random.choice(("sin", "cos", "sin", "cos", "sin", "cos", "tan")), (angle(random),))
    return Power(call, random.choice((2, 2, 3))) if random.random() < 0.15 else call


def _number(random: Random) -> Tree:
    kind = random.random()
    if kind < 0.5:
        return Number(str(random.choice((1, 2, 2, 3, 4, 10, 12))))
    if kind < 0.75:
        return Number(random.choice(("0.5", "1.5", "0.25", ".5", "2.75", "1e-3", "1.25e2")))
    return Ratio(random.choice((1, 1, 2, 3)), random.choice((2, 3, 4, 5)))


def factor(random: Random, depth: int) -> Tree:
    """Return a random factor of a product."""
    kind = random.random()
    if kind < 0.3:
        return Name(random.choice((*LENGTHS, "k")))
    if kind < 0.65:
        return _wave(random)
    if kind < 0.75 or not depth:
        return _number(random)
    if kind < 0.85:
        return formula(random, depth - 1)
    if kind < 0.91:
        base = Name(random.choice(LENGTHS)) if random.random() < 0.6 else formula(random, depth - 1)
        return Power(base, random.choice((2, 2, 2, 3, -1)))
    return _call(random, depth - 1)


def _call(random: Random, depth: int) -> Tree:
    kind = random.randrange(6)
    if kind == 0:
        return Call("atan2", (formula(random, depth), formula(random, depth)))
    if kind == 1:
        squares = tuple((1, Power(Name(name), 2)) for name in random.sample(LENGTHS, 2))
        return Call("sqrt", (Sum(squares),))
    if kind == 2:
        return Call("sqrt", (random.choice((Number("2"), Number("3"), Name("l1"), Name("k"))),))
    if kind == 3:
        inside = Quotient(_wave(random), Number("4"))
        return Call(random.choice(("asin", "acos")), (inside,))
    if kind == 4:
        return Call("abs", (formula(random, depth),))
    return Call(random.choice(("atan", "atan", "exp")), (formula(random, depth),))


def product(random: Random, depth: int) -> Tree:
    """Return a random term of a sum."""
    factors = tuple(factor(random, depth) for _ in range(random.choice((1, 1, 2, 2, 2, 3, 4))))
    whole = factors[0] if len(factors) == 1 else Product(factors)
    return Quotient(whole, factor(random, depth)) if random.random() < 0.12 else whole


def formula(random: Random, depth: int = 2) -> Tree:
    count = random.choice((1, 1, 1, 2, 2, 3, 4))
    terms = tuple((random.choice((1, 1, 1, -1)), product(random, depth)) for _ in range(count))
    return terms[0][1] if count == 1 and terms[0][0] == 1 else Sum(terms)


def changed_sign(random: Random, tree: Tree) -> Tree:
    """Return the formula with one sign changed."""
    if isinstance(tree, Sum):
        at = random.randrange(len(tree.terms))
        terms = list(tree.terms)
        terms[at] = (-terms[at][0], terms[at][1])
        if len(terms) == 1 and terms[0][0] == 1:
            return terms[0][1]
        return Sum(tuple(terms))
    return Sum(((-1, tree),))
