"""Estimate the cost of reading a text before it is read."""

import time

import pytest
from dh_grader.expressions import ExpressionError, read, reading_cost, symbols_in

from tests.expressions.corpus_files import ROBOT
from tests.expressions.fuzzing import outcome
from tests.guards import STALL


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
