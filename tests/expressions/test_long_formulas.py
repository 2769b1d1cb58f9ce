"""Read the pose of a seven-joint arm as programs print it."""

import inspect
import sys
from collections.abc import Callable, Iterator
from functools import cache

import numpy as np
import pytest
import sympy
from dh_grader.expressions import (
    LIMITS,
    Expression,
    Symbol,
    Vocabulary,
    joint_variable,
    read,
    reading_cost,
)
from dh_grader.expressions.parser import in_degrees
from dh_grader.grading.report import MAX_SYMBOLS

JOINTS = [sympy.Symbol(f"theta{i}") for i in range(1, 8)]
LENGTHS = [sympy.Symbol(f"L{i}") for i in range(7)]
ARM = Vocabulary(
    [*(joint_variable(i) for i in range(1, 8)), *(Symbol(f"L{i}", "length") for i in range(7))]
)
NUMBERS = {
    str(symbol): 0.3 + 0.17 * i for i, symbol in enumerate([*JOINTS, *LENGTHS])
}  # generic: no two alike, none a multiple of a right angle
VALUES = {name: np.array([number]) for name, number in NUMBERS.items()}
PRINTERS: dict[str, Callable[[sympy.Expr], str]] = {
    "str": str,
    "latex": sympy.latex,
    "latex, ldot": lambda entry: str(sympy.latex(entry, mul_symbol="ldot")),
    "latex, dot": lambda entry: str(sympy.latex(entry, mul_symbol="dot")),
    "octave": sympy.octave_code,
    "mathematica": sympy.mathematica_code,
    "c": sympy.ccode,
    "javascript": sympy.jscode,
}


@cache
def _pose() -> sympy.Matrix:
    a0, a1, a2, a3, a4, a5, a6 = LENGTHS
    turn = sympy.pi / 2
    rows = [(a1, -turn, a0), (0, turn, 0), (a3, -turn, a2), (0, turn, 0), (a5, -turn, a4),
            (0, turn, 0), (0, 0, a6)]  # fmt: skip
    pose = sympy.eye(4)
    for theta, (a, alpha, d) in zip(JOINTS, rows, strict=True):
        c, s, ca, sa = sympy.cos(theta), sympy.sin(theta), sympy.cos(alpha), sympy.sin(alpha)
        link = [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d],
                [0, 0, 0, 1]]  # fmt: skip
        pose *= sympy.Matrix(link)
    return pose


def _entries() -> Iterator[sympy.Expr]:
    pose = _pose()
    for entry in (pose[0, 0], pose[0, 3], pose[1, 3], pose[2, 3]):
        yield entry
        yield sympy.expand(entry)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("printer", PRINTERS)
def test_a_whole_pose_is_read(printer: str) -> None:
    texts = [PRINTERS[printer](sympy.expand(entry)) for entry in _pose()]
    assert 8_000 < sum(map(reading_cost, texts)) < MAX_SYMBOLS


@pytest.mark.long
@pytest.mark.parametrize("printer", PRINTERS)
def test_a_long_entry_is_read(printer: str) -> None:
    longest = 0
    for entry in _entries():
        text = PRINTERS[printer](entry)
        longest = max(longest, len(text))
        found = np.ravel(read(text, ARM).evaluate(VALUES))
        expected = float(entry.subs(NUMBERS))
        assert found == pytest.approx([expected], rel=1e-9, abs=1e-9)
    assert 900 < longest < LIMITS.characters / 2


def _longest_formulas() -> list[str]:
    run = LIMITS.tree_depth - 1
    return [
        "+".join(["L1"] * (run + 1)),
        "*".join(["L1"] * (run + 1)),
        "-L1" * run,
        "(" * 39 + "L1" + "+L2)" * 39 + "+L1" * (run - 40),
        "sin(" * 38 + "L1" + ")" * 38 + "*L1" * (run - 40),
    ]


@pytest.mark.parametrize("text", _longest_formulas(), ids=range(5))
def test_functions_on_trees_stay_far_from_the_recursion_limit(text: str) -> None:
    # Python allows 1,000 nested calls, of which a server's own calls take about a hundred.
    depth = len(inspect.stack(0))
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(depth + 800)
    try:
        expression = read(text, ARM, quantity="angle", angle_unit="degrees")
        _printed(expression)
        in_degrees(expression.tree, is_angle=True, notes=[])
        assert np.isfinite(expression.evaluate(VALUES)).all()
    finally:
        sys.setrecursionlimit(limit)


def _printed(expression: Expression) -> None:
    assert expression.text()
    assert expression.latex()
    assert expression.mathml()
