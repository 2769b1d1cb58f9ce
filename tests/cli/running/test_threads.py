import threading

import pytest
from dh_grader.cli.running import mapped_in_threads

from tests.guards import ANSWER


def test_results_come_in_the_order_of_the_items() -> None:
    second_is_done = threading.Event()

    def work(item: int) -> int:
        if item == 0:
            assert second_is_done.wait(ANSWER)
        else:
            second_is_done.set()
        return item * item

    with mapped_in_threads(work, range(20), 2) as results:
        assert list(results) == [item * item for item in range(20)]


def test_only_few_items_are_computed_ahead() -> None:
    begun: list[int] = []
    with mapped_in_threads(begun.append, range(1000), 2) as results:
        next(results)
        assert len(begun) <= 6
    assert len(begun) <= 6


def test_the_end_of_the_context_does_not_wait_for_threads() -> None:
    begun, released = threading.Event(), threading.Event()

    def work(item: int) -> None:
        if item:
            begun.set()
            released.wait(ANSWER)

    with mapped_in_threads(work, range(9), 1) as results:
        next(results)
        assert begun.wait(ANSWER)
    assert not released.is_set()
    released.set()


def test_an_exception_in_a_thread_is_raised_in_place_of_its_result() -> None:
    with mapped_in_threads(lambda item: 1 // item, [1, 0], 2) as results:
        assert next(results) == 1
        with pytest.raises(ZeroDivisionError):
            next(results)
