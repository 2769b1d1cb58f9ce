"""A bar on a terminal that shows how far a long run is; none in a log."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Final

from service.cli.terminal import complain

# Fewer are done before one could read it.
_LEAST: Final = 10


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a run is. ``is_shown`` says that a bar stands on the terminal."""

    advance: Callable[[], None]
    complain: Callable[[str], None]
    is_shown: bool = False


@contextmanager
def progress(total: int) -> Iterator[Progress]:
    """A bar on standard error, above which complaints appear; it vanishes at its end."""
    if total < _LEAST or not sys.stderr.isatty():
        yield Progress(lambda: None, complain)
        return
    # Only here: nothing else needs it.
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    console = Console(stderr=True, highlight=False, markup=False)
    columns = (TextColumn("Grading"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Bar(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=total)
        yield Progress(
            lambda: bar.advance(task), lambda text: console.print(text, soft_wrap=True), True
        )
