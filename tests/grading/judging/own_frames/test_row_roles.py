"""Match the rows of an answer with the expected rows, in order."""

import numpy as np
import pytest
from dh_grader.grading.frames import pair_in_order

PAIRS: dict[str, tuple[list[list[float]], list[tuple[int | None, int | None]]]] = {
    "all agree": ([[1, 0], [0, 1]], [(0, 0), (1, 1)]),
    "the first row is missing": ([[0, 1]], [(None, 0), (0, 1)]),
    "the first row is extra": ([[0], [1]], [(0, None), (1, 0)]),
    "the order counts": ([[0, 1], [1, 0]], [(None, 0), (0, 1), (1, None)]),
    "the larger sum wins": ([[0, 1], [3, 0]], [(0, None), (1, 0), (None, 1)]),
    "nothing agrees": ([[0], [0]], [(0, 0), (1, None)]),
}


@pytest.mark.parametrize("name", PAIRS)
def test_the_pairing_has_the_largest_sum_of_scores(name: str) -> None:
    scores, pairs = PAIRS[name]
    assert pair_in_order(np.array(scores, dtype=np.float64)) == pairs
