"""The terminal: output, progress, interrupts, the reader's language, and errors that end it."""

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Final, NoReturn, TypeVar

import typer
from rich.cells import cell_len, set_cell_size
from rich.console import Console

from dh_grader.catalogue import Exercise, exercise_files, load_catalogue, load_exercise
from dh_grader.cli import spoken, user_language
from dh_grader.settings import Settings, load_settings
from dh_grader.submissions.bodies import find_exercise, nearest
from dh_grader.translations import Language, Sentence, language_named, paragraph, say

# --- Handle SIGINT and SIGTERM so that no unfinished files and no processes are left


# The exit codes of a shell: 128 plus the number of the signal.
INTERRUPTED: Final = 130
TERMINATED: Final = 143
# A second signal within this time is ignored: many programs send theirs twice (seconds).
_REPEATED_WITHIN: Final = 1.0


class _Signals:
    def __init__(self) -> None:
        self._last: tuple[int, float] | None = None

    def receive(self, number: int, _: object) -> None:
        # A further signal during the cleanup is ignored.
        now = time.monotonic()
        if self._last is None or now - self._last[1] > _REPEATED_WITHIN:
            self._last = number, now
            _end(number)

    def check(self) -> None:
        # Python drops exceptions that are raised during garbage collection or the release of a
        # lock.
        if self._last is not None:
            _end(self._last[0])


@contextmanager
def interruptible() -> Iterator[Callable[[], None]]:
    """Clean up files and processes before SIGTERM or Ctrl-C ends this process.

    Yields a function that ends the process after a signal. Call this function between two pieces of
    work.
    """
    # Without it, the process would go on if the exception of a signal was lost.
    signals = _Signals()
    with _handled(signals.receive):
        try:
            yield signals.check
        except BaseException:
            signals.check()
            raise


@contextmanager
def _handled(handler: Callable[[int, object], None]) -> Iterator[None]:
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    # Keep ignoring signals that were ignored at the start, as in the background of a script.
    numbers = [n for n in (signal.SIGINT, signal.SIGTERM) if signal.getsignal(n) != signal.SIG_IGN]
    before = {number: signal.signal(number, handler) for number in numbers}
    try:
        yield
    finally:
        for number, former in before.items():
            signal.signal(number, former)


def _end(number: int) -> NoReturn:
    if number == signal.SIGINT:
        raise KeyboardInterrupt
    raise SystemExit(TERMINATED)


# --- Output to the terminal, errors that end the program, and the installed exercises


BELOW_PASS_MARK = 1
UNUSABLE = 2
# The exit code of a shell for SIGPIPE (the reader of a pipe has gone): 128 plus its number.
BROKEN_PIPE = 141


class _Terminal(Console):
    def on_broken_pipe(self) -> None:
        try:
            # Discards buffered output: Python would fail again when it flushes it at exit.
            super().on_broken_pipe()
        except SystemExit:
            raise SystemExit(BROKEN_PIPE) from None


def stdout() -> Console:
    """Return a console for standard output."""
    # Without a terminal and without COLUMNS, the console has 80 columns.
    width = None if sys.stdout.isatty() or "COLUMNS" in os.environ else 80
    return _Terminal(file=sys.stdout, width=width, highlight=False, markup=False, soft_wrap=False)


def unwritable(file: Path | str, error: OSError) -> Sentence:
    """Return the message that a file cannot be written."""
    return say("{file}: cannot be written: {reason}", file=str(file), reason=str(error.strerror))


def unreadable(file: Path | str, error: OSError) -> Sentence:
    """Return the message that a file cannot be read."""
    return say("{file}: cannot be read: {reason}", file=str(file), reason=str(error.strerror))


def tell(message: str) -> None:
    """Print a message in the language of the user."""
    typer.echo(spoken(message))


def tell_verdict(is_fine: bool | None, message: str) -> None:
    """Print the result of a check; ``is_fine`` is None if the message only informs."""
    words = {True: spoken(say("ok")), False: spoken(say("WRONG")), None: ""}
    width = max(map(cell_len, words.values())) + 2
    typer.echo(set_cell_size(words[is_fine], width) + spoken(message))


def complain(message: str | Exception, language: Language | None = None) -> None:
    """Print a message to standard error, in a language, by default that of the user."""
    text = str(message)
    # The ``str`` of an error forgets the template of its sentence.
    if isinstance(message, Exception) and message.args and message.args[0] == text:
        text = message.args[0]
    said = text if isinstance(message, Exception) else message
    print(spoken(said, language), file=sys.stderr)  # noqa: T201 - a program's own error output


def give_up(message: str | Exception) -> NoReturn:
    """Print a message to standard error, and exit because the input is unusable."""
    complain(message)
    raise SystemExit(UNUSABLE)


def installed() -> Mapping[str, Exercise]:
    """Return the exercises of this installation. Raises SettingsError or CatalogueError."""
    return load_catalogue(*load_settings().exercises_dir)


def installed_exercise(exercise_id: str) -> Exercise:
    """Return the installed exercise or variant with this id.

    Raises SettingsError, CatalogueError or UnknownExerciseError.
    """
    # Only the file of this exercise is read.
    plain_id = exercise_id.partition("~")[0]
    plain = load_exercise(installed_file(plain_id))
    return find_exercise({plain_id: plain}, exercise_id)


def named_exercise(name: str) -> Exercise:
    """Return the exercise in a file ``….toml``, or the installed exercise with this id.

    Raises SettingsError, CatalogueError or UnknownExerciseError.
    """
    own = own_file(name)
    return installed_exercise(name) if own is None else load_exercise(own)


def own_file(name: str) -> Path | None:
    """Return the path of an exercise file if ``name`` is ``….toml``; None for an id."""
    return Path(name) if name.endswith(".toml") else None


def installed_file(exercise_id: str) -> Path:
    """Return the path of the file of an installed exercise.

    Raises SettingsError, CatalogueError or UnknownExerciseError.
    """
    files = {file.stem: file for file in exercise_files(*load_settings().exercises_dir)}
    return find_exercise(files, exercise_id)


# --- A progress bar for long runs on a terminal


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


# --- Options of the command line that take one of several words


_Choice = TypeVar("_Choice", bound=StrEnum)


def one_of(name: str, known: Iterable[str]) -> str:
    """Return ``name`` if it is a known word. Raises typer.BadParameter."""
    names = list(known)
    if name in names:
        return name
    meant = nearest(name, names)
    unknown = say("{name!r} is not one of {names}.", name=name, names=", ".join(names))
    hint = say("Did you mean {meant}?", meant=meant) if meant else ""
    raise typer.BadParameter(spoken(paragraph(unknown, hint)))


def choice(of: type[_Choice]) -> Callable[[str], _Choice]:
    """Return a parser for an option whose values are those of an enumeration."""
    return lambda text: of(one_of(text, [each.value for each in of]))


def listed(of: type[StrEnum]) -> str:
    """Return the values of an enumeration as ``--help`` shows them: ``[a|b]``."""
    return f"[{'|'.join(each.value for each in of)}]"


def report_language(settings: Settings, output_format: str) -> Language:
    """Return the language of reports."""
    # Without a setting, reports in the format ``text`` are in the language of the user.
    if output_format == "text" and "language" not in settings.model_fields_set:
        return user_language()
    found = language_named(settings.language)
    assert found is not None, "the settings have only known languages"
    return found
