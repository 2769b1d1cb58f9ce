"""Limits on expressions."""

import time

import pytest

from service.expressions import LIMITS, ExpressionError, Vocabulary, read
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
    """A long sum counts as one level of depth."""
    expression = read(text, arm, quantity="angle", angle_unit="degrees")
    assert expression.mathml()
    assert expression.latex()


def test_the_limits_are_those_of_the_design() -> None:
    assert (LIMITS.characters, LIMITS.nodes, LIMITS.depth) == (8000, 2000, 40)


@pytest.mark.parametrize(
    "text",
    ["a" * 500, "θ" * 500, "sin" * 166, ")" * 500, "k1" * 250, "-(" * 250, "c1" * 250, "½" * 500],
)
def test_no_text_takes_quadratic_time(text: str, arm: Vocabulary) -> None:
    """The bound on processor time is generous; quadratic growth would exceed it."""
    start = time.process_time()
    with pytest.raises(ExpressionError):
        read(text, arm, angle_unit="degrees")
    assert time.process_time() - start < STALL
