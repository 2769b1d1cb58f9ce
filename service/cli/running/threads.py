"""Map a function over many items in several threads. It is for functions that wait for I/O."""

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
    """Yield an iterator over the results in the order of the items, with few of them in memory.

    At the end of the context, waiting items are dropped, and running ones are not waited for: the
    threads of an executor would delay the end of the program.
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
        except Exception as error:  # noqa: BLE001 -- raised by future.result()
            future.set_exception(error)

    return run


def _work(tasks: "SimpleQueue[Callable[[], None] | None]") -> None:
    while (task := tasks.get()) is not None:
        task()
