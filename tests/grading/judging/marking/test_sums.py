"""The points in reports on random wrong answers add up."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise

from tests.grading.judging.marking.sums import run


@pytest.mark.long
@pytest.mark.parametrize("answers", [1, pytest.param(1000, marks=pytest.mark.campaign)])
def test_points_add_up(answers: int, catalogue: Mapping[str, Exercise]) -> None:
    graded, found = run(catalogue, answers, seed=1)
    assert graded > answers * len(catalogue)
    assert not found, "\n".join(found[:5])
