"""One function over many things in several threads: for what waits, not for what computes."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager, suppress
from queue import Empty, SimpleQueue
from threading import Thread
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


@contextmanager
def mapped_in_threads(
    function: Callable[[Item], Result], items: Iterable[Item], jobs: int
) -> Iterator[Iterator[Result]]:
    """The results in the order of the items, with few of them in memory.

    What has not begun when the context ends is never begun, and nobody waits for what has: the
    threads of an executor would hold the end of the program up.
    """
    tasks: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
    for _ in range(jobs):
        Thread(target=_work, args=(tasks,), daemon=True).start()
    try:
        yield _in_order(tasks, function, items, 2 * jobs)
    finally:
        with suppress(Empty):
            while True:
                tasks.get_nowait()
        for _ in range(jobs):
            tasks.put(None)


def _in_order(
    tasks: "SimpleQueue[Callable[[], None] | None]",
    function: Callable[[Item], Result],
    items: Iterable[Item],
    ahead: int,
) -> Iterator[Result]:
    waiting: deque[Future[Result]] = deque()
    for item in items:
        future: Future[Result] = Future()
        tasks.put(_task(function, item, future))
        waiting.append(future)
        if len(waiting) > ahead:
            yield waiting.popleft().result()
    while waiting:
        yield waiting.popleft().result()


def _task(
    function: Callable[[Item], Result], item: Item, future: Future[Result]
) -> Callable[[], None]:
    def run() -> None:
        try:
            future.set_result(function(item))
        except Exception as error:  # noqa: BLE001 -- raised where the result is asked for
            future.set_exception(error)

    return run


def _work(tasks: "SimpleQueue[Callable[[], None] | None]") -> None:
    while (task := tasks.get()) is not None:
        task()
