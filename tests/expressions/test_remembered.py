"""Test which expressions are memoized."""

import gc
import threading

import numpy as np
import pytest
from dh_grader.expressions import Expression, ExpressionError, Vocabulary, read, reader

from tests.expressions.conftest import Values
from tests.expressions.corpus_files import ROBOT, cases, names

LONG = "c1*(c2*(c4*d3 - s4*l1) - s2*k*l2) - s1*(s4*l1 + c4*d3) + 0.{}"
READABLE = [case.text for name in names() for case in cases(name)]
SAMPLES = {symbol.name: np.linspace(-2, 2, 16) for symbol in ROBOT.symbols}


def _tracked() -> int:
    for _ in range(3):
        gc.collect()
    return len(gc.get_objects())


def _readable(text: str) -> Expression | None:
    try:
        return read(text, ROBOT)
    except ExpressionError:
        return None


def test_a_memoized_text_is_at_most_five_objects(arm: Vocabulary, values: Values) -> None:
    # A formula with fifty nodes must cost the garbage collector no more than a name.
    before = _tracked()
    for number in range(100, 600):
        read(LONG.format(number), arm).evaluate(values)
    reader._parsed.cache_clear()
    assert _tracked() - before < 5 * 500


@pytest.mark.parametrize(
    ("text", "quantity", "angle_unit"),
    [
        ("-s1*(d3*s2 + 2 k) + θ_1", "number", "radians"),
        (r"\frac{\pi}{2} - \cos\theta_1", "number", "radians"),
        ("cosd(60) + q1", "number", "radians"),
        ("2*(q1 + 45) - 90", "angle", "degrees"),
        ("2*(q1 + 45) - 90", "number", "degrees"),
        ("sin(30)", "number", "degrees"),
        (0.25, "length", "radians"),
    ],
)
def test_a_tree_that_is_parsed_again_is_the_same(
    text: str | float, quantity: object, angle_unit: object, arm: Vocabulary
) -> None:
    expression = read(text, arm, quantity=quantity, angle_unit=angle_unit)  # type: ignore[arg-type]
    first = expression.tree
    reader._parsed.cache_clear()
    again = expression.tree
    assert again is not first
    # Equality ignores places in the text, but the repr contains them.
    assert repr(again) == repr(first)


def test_a_tree_given_without_options_is_stored(arm: Vocabulary) -> None:
    tree = read("2*l1", arm).tree
    expression = Expression("l1", tree, (), frozenset({"l1"}))
    assert expression.tree is tree
    assert expression.evaluate({"l1": np.array([3.0])}) == [6.0]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0.5", True),
        (".5", True),
        ("5.*q1", True),
        ("l1 + 0.707*c1", True),
        (0.5, True),
        ("5", False),
        (5, False),
        ("1/2", False),
        ("np.cos(q1)", False),
    ],
)
def test_has_decimal_is_true_for_decimal_numbers(
    text: str | float, expected: bool, arm: Vocabulary
) -> None:
    assert read(text, arm).has_decimal is expected


def test_a_shared_memo_changes_no_value() -> None:
    # Values are equal to the last bit, with and without a memo, in any order.
    expressions = [each for text in READABLE if (each := _readable(text)) is not None]
    assert len(expressions) > 100
    alone = [np.asarray(each.evaluate(SAMPLES)) for each in expressions]
    for order in (expressions, expressions[::-1]):
        memo: dict[str, object] = {}
        shared = {id(each): np.asarray(each.evaluate(SAMPLES, memo)) for each in order}
        for each, value in zip(expressions, alone, strict=True):
            np.testing.assert_array_equal(shared[id(each)], value, each.source)


def test_threads_that_read_the_same_texts_agree() -> None:
    texts = [f"{text} + 0*{number}" for number, text in enumerate(READABLE[:60])]
    expected = [None if (each := _readable(text)) is None else str(each.text()) for text in texts]
    for memoized in reader._reader_memoized:
        memoized.cache_clear()
    reader._parsed.cache_clear()
    together = threading.Barrier(4)
    found: list[list[str | None]] = []

    def read_all() -> None:
        together.wait()
        expressions = [_readable(text) for text in texts]
        found.append([None if each is None else each.text() for each in expressions])

    threads = [threading.Thread(target=read_all) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected] * 4
