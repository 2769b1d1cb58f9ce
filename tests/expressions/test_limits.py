"""Test the limits on expressions."""

import contextlib
import time

import pytest
from dh_grader.expressions import LIMITS, ExpressionError, Vocabulary, read
from dh_grader.expressions.vocabulary import Binary, Node, SymbolNode, children

from tests.expressions.fuzzing import seeds, texts
from tests.guards import STALL


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
