"""Map a function that waits for I/O over many items in several threads."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from itertools import islice
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from multiprocessing.pool import AsyncResult

Item = TypeVar("Item")
Result = TypeVar("Result")


@contextmanager
def mapped_in_threads(
    function: Callable[[Item], Result], items: Iterable[Item], jobs: int
) -> Iterator[Iterator[Result]]:
    """Yield an iterator over the results in the order of the items."""
    # At the end of the context, no further call starts, and nothing waits for running calls.
    # Import here: most runs need no threads. ThreadPoolExecutor would delay the end of the program
    # until its threads end; the threads of this pool are daemons.
    from multiprocessing.pool import ThreadPool

    with ThreadPool(jobs) as pool:
        yield _in_order((pool.apply_async(function, (item,)) for item in items), 2 * jobs)


def _in_order(begun: Iterator["AsyncResult[Result]"], ahead: int) -> Iterator[Result]:
    waiting = deque(islice(begun, ahead))
    while waiting:
        yield waiting.popleft().get()
        waiting.extend(islice(begun, 1))
