"""Rounded valid tables are right; tables with a changed digit are wrong."""

import pytest

from tests.frame_choice.robots import GIVEN, POLICIES
from tests.frame_choice.rounded import RoundedCell, run


def test_a_rounded_cell_has_the_number_of_figures() -> None:
    assert RoundedCell(angle=True, constant=0.0505, figures=3).text == "0.0505"
    assert RoundedCell(angle=True, constant=1.0472, figures=3, units=3).text == "1.08"
    assert RoundedCell(angle=True, constant=-1.5, variables={"q1": 1}).text == "q1 - 1.50"


@pytest.mark.long
def test_rounded_tables_are_judged_right() -> None:
    found = run(range(4), seed=3, seeds=1, policies=(GIVEN,))
    assert found.misses == []
    assert found.counts["changed, given"] >= 3


def test_rounded_tables_with_free_ends_are_judged_right() -> None:
    found = run(range(2, 3), seed=3, policies=POLICIES[1::2])
    assert found.misses == []
    assert sum(found.counts.values()) >= 6
