"""A progress bar for long runs on a terminal."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Final

from service.cli.language import spoken
from service.cli.terminal import complain
from service.translations import say

# With fewer submissions the bar would vanish before anybody could read it.
_LEAST: Final = 10


@dataclass(frozen=True, slots=True)
class Progress:
    """The functions of a progress bar: ``advance`` moves the bar, ``complain`` prints an error."""

    advance: Callable[[], None]
    complain: Callable[[str], None]
    is_shown: bool = False


@contextmanager
def progress(total: int) -> Iterator[Progress]:
    """Show a progress bar on standard error during the context."""
    if total < _LEAST or not sys.stderr.isatty():
        yield Progress(lambda: None, complain)
        return
    # Import here: nothing else needs it.
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    console = Console(stderr=True, highlight=False, markup=False)
    columns = (
        TextColumn(spoken(say("Grading"))),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    with Bar(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=total)
        yield Progress(
            lambda: bar.advance(task), lambda text: console.print(text, soft_wrap=True), True
        )
