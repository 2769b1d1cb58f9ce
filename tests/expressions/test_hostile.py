"""Test hostile and long formulas: limits, work, and that nothing is run."""

import ast
import contextlib
import inspect
import sys
import time
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import dh_grader
import numpy as np
import pytest
import sympy
from dh_grader.expressions import (
    LIMITS,
    Expression,
    ExpressionError,
    Symbol,
    Vocabulary,
    joint_variable,
    read,
    reading_cost,
    symbols_in,
)
from dh_grader.expressions.parser import in_degrees
from dh_grader.expressions.vocabulary import Binary, Node, SymbolNode, children
from dh_grader.grading.report import MAX_SYMBOLS

from tests.expressions.corpus_files import ROBOT
from tests.expressions.fuzzing import outcome, seeds, texts
from tests.guards import STALL
from tests.together import together

# --- The program never runs a student's text as code

FORBIDDEN = frozenset({
    "eval", "exec", "compile", "__import__", "sympify", "parse_expr", "parse_latex", "lambdify",
    "S", "literal_eval", "loads", "load", "getattr", "setattr", "system", "popen", "Popen",
    "import_module", "resolve_name",
})  # fmt: skip
MODULES = frozenset(
    {"pickle", "marshal", "shelve", "subprocess", "sympy", "importlib", "pkgutil", "builtins"}
)
ROOT = Path(dh_grader.__file__).parent
FOLDERS = ("expressions", "grids", "grading")
FILES = sorted(file for folder in FOLDERS for file in (ROOT / folder).rglob("*.py"))


def found(source: str) -> list[str]:
    """Return the forbidden calls and imports in Python code."""
    calls = []
    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.Call(func=ast.Name(id=name)) if name in FORBIDDEN:
                calls.append(name)
            case ast.Call(func=ast.Attribute(value=value, attr=name)) if name in FORBIDDEN:
                if not (name == "compile" and isinstance(value, ast.Name) and value.id == "re"):
                    calls.append(name)
            case ast.Import(names=names):
                calls += [n.name for n in names if n.name.split(".")[0] in MODULES]
            case ast.ImportFrom(module=str() as module) if module.split(".")[0] in MODULES:
                calls.append(module.split(".")[0])
            case ast.Import() | ast.ImportFrom():
                pass
    return calls


@pytest.mark.long
@together("file", FILES)
def test_no_evaluator_is_called(file: Path) -> None:
    assert found(file.read_text("utf-8")) == []


@pytest.mark.parametrize(
    "source",
    ["eval('1')", "sympy.sympify(x)", "import pickle", "from sympy import S", "a.parse_expr(x)"],
)
def test_a_forbidden_call_is_found(source: str) -> None:
    assert found(source)
    assert len(FILES) > 40


# --- Test the limits on expressions


@pytest.mark.parametrize(
    ("text", "code", "span"),
    [
        ("1" * 8001, "too_long", (8000, 8001)),
        ("k+" * 200 + "k", "too_many_nodes", (0, 401)),
        ("(k+k+k+k)+" * 286 + "k", "too_many_nodes", (0, 2861)),
        ("-" * 41 + "1", "too_deep", (0, 42)),
        ("(" * 41 + "1" + ")" * 41, "too_deep", (40, 41)),
        ("sin(" * 40 + "1" + ")" * 40, "too_deep", (0, 201)),
        # Both limits are exceeded: the error names the first one from right to left.
        ("k+" * 1100 + "-" * 41 + "k", "too_deep", (0, 2242)),
        ("-" * 41 + "k" + "+k" * 1100, "too_many_nodes", (0, 2242)),
        ("-" * 300 + "k", "too_deep", (0, 301)),
    ],
)
def test_a_text_beyond_a_limit_is_refused(
    text: str, code: str, span: tuple[int, int], arm: Vocabulary
) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(text, arm)
    assert (caught.value.code, caught.value.span) == (code, span)


@pytest.mark.parametrize(
    "text",
    [
        " " * 7999 + "1",
        "k+" * 199 + "k",
        "(k*k*k*k)+" * 150 + "k*k*k*k",
        "-" * 39 + "1",
        "(" * 40 + "1" + ")" * 40,
        "sin(" * 39 + "1" + ")" * 39,
        "*".join(["q1"] * 100),
    ],
)
def test_a_text_within_the_limits_is_read(text: str, arm: Vocabulary) -> None:
    # A long sum counts as one level of depth.
    expression = read(text, arm, quantity="angle", angle_unit="degrees")
    assert expression.mathml()
    assert expression.latex()


@pytest.mark.parametrize(
    ("opening", "closing"),
    [
        ("-", ""),
        ("√", ""),
        ("sin ", ""),
        ("cos^2 ", ""),
        ("sec^2(", ")"),
        ("hypot^2(1,", ")"),
        ("pow(2,", ")"),
        ("Plus[k,k,", "]"),
        ("|", "|"),
        ("-(", ")^2"),
        ("k+k*(", ")"),
        ("2^(", ")"),
        (r"\frac{1}{", "}"),
        ("rad(cos ", ")"),
    ],
)
@pytest.mark.parametrize("innermost", ["k", "c12", "M_SQRT1_2", "90deg"])
def test_short_texts_are_accepted_up_to_the_limit_of_depth(
    opening: str, closing: str, innermost: str, arm: Vocabulary
) -> None:
    depths = []
    for times in range(1, 42):
        with contextlib.suppress(ExpressionError):
            depths.append(_depth(read(opening * times + innermost + closing * times, arm).tree))
    assert LIMITS.depth // 2 <= max(depths) <= LIMITS.depth
    assert len(depths) < 41


def _depth(node: Node) -> int:
    runs = {"+": "+-", "-": "+-", "*": "*/", "/": "*/", "^": "^"}
    depths = [_depth(child) for child in children(node)]
    if isinstance(node, Binary) and isinstance(node.left, Binary):
        depths[0] -= node.left.operator in runs[node.operator]
    return 1 + max(depths, default=0)


def test_all_symbols_of_a_text_are_known(arm: Vocabulary) -> None:
    for text in [*seeds(), *texts(300, seed=5)]:
        with contextlib.suppress(ExpressionError):
            expression = read(text, arm)
            pending, names = [expression.tree], set()
            while pending:
                node = pending.pop()
                names |= {node.symbol.name} if isinstance(node, SymbolNode) else set()
                pending += children(node)
            assert expression.symbols == names, text


def test_the_limits_are_those_of_the_design() -> None:
    assert (LIMITS.characters, LIMITS.nodes, LIMITS.depth) == (8000, 2000, 40)


@pytest.mark.parametrize(
    "text",
    ["a" * 500, "θ" * 500, "sin" * 166, ")" * 500, "k1" * 250, "-(" * 250, "c1" * 250, "½" * 500],
)
def test_no_text_takes_quadratic_time(text: str, arm: Vocabulary) -> None:
    # The bound on processor time is generous; quadratic growth would exceed it.
    start = time.process_time()
    with pytest.raises(ExpressionError):
        read(text, arm, angle_unit="degrees")
    assert time.process_time() - start < STALL


# --- Read the pose of a seven-joint arm as programs print it

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


# --- Estimate the cost of reading a text before it is read


@pytest.mark.parametrize(
    ("text", "symbols"),
    [
        ("q1", 2),
        ("l1*c1 + 2", 7),
        (r"\cos\left(\theta_{1}\right)", 11),
        ("     0     ", 1),
        # ½ is read as 1/2 in brackets.
        ("½", 6),
        ("x" * 160, 90),
    ],
)
def test_names_numbers_and_signs_are_counted(text: str, symbols: int) -> None:
    assert symbols_in(text) == symbols


@pytest.mark.parametrize(
    ("text", "cost"),
    [
        # Measured processor time, as a multiple of that for an opening brace of LaTeX.
        (r"\frac{1}{2}", 18),
        ("pi ", 6),
        ("√2 ", 7),
        ("sind(30)", 17),
        ("sin(q1)", 10),
        ("c12 ", 9),
        ("sin(30)", 9),
        ("½", 10),
        (r"\cos\left(\theta_{1}\right)", 12),
    ],
)
def test_costly_symbols_of_long_texts_count_several_times(text: str, cost: int) -> None:
    assert reading_cost(text) == symbols_in(text)
    assert reading_cost(text * 80) / 80 == pytest.approx(cost, abs=1.8)


def test_a_repair_tries_at_most_1200_symbols() -> None:
    # Without this limit, reading this text took 30 ms.
    with pytest.raises(ExpressionError) as caught:
        read("//".join(["½" * 78] * 6) + "1", ROBOT)
    assert 0 < caught.value.tried <= 1200
    with pytest.raises(ExpressionError) as caught:
        read("//".join(["½" * 78] * 6) + "1", ROBOT, repairs=False)
    assert caught.value.tried == 0


def test_a_run_of_letters_takes_linear_time() -> None:
    # The time was quadratic when the reader copied all following pieces at each place.
    start = time.process_time()
    for i in range(100):
        outcome("sin" * 26 + str(i))
    assert time.process_time() - start < STALL
