"""Test the simulation of a class before a deadline."""

import numpy as np
import pytest

from tests.load.sizing.deadline import HOUR, WEEK, before_deadline, waited, waits

COSTS = {kind: np.array([0.01]) for kind in ("page", "preview", "right", "wrong", "hand_in")}


@pytest.mark.parametrize(("last", "share"), [(WEEK / 7, 0.5), (HOUR, 0.161), (60.0, 0.037)])
def test_as_many_hand_in_late_as_the_model_says(last: float, share: float) -> None:
    found = before_deadline(200_000, np.random.default_rng(1))
    assert np.mean(found <= last) == pytest.approx(share, abs=0.003)


def test_a_process_answers_in_the_order_of_the_requests() -> None:
    # By hand: 0 to 2, then 2 to 5 for the one that came at 1, then idle until 10.
    asked, cost = np.array([10.0, 1.0, 0.0]), np.array([1.0, 3.0, 2.0])
    assert waited(asked, cost).tolist() == [1.0, 4.0, 2.0]


def test_more_students_wait_longer_and_more_processes_help() -> None:
    def longest(students: int, processes: int) -> float:
        return waits(students, processes, COSTS, np.random.default_rng(2)).longest

    assert longest(500, 1) < longest(20_000, 1)
    assert longest(20_000, 8) < longest(20_000, 1) / 4
