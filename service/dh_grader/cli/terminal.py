"""The terminal: output in the language of the user, errors that end the program, and signals.

Reports are laid out in ``dh_grader.formats``.
"""

import gettext
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from gettext import NullTranslations
from pathlib import Path
from typing import Any, Final, NoReturn

import typer
from rich.cells import cell_len, set_cell_size
from rich.console import Console
from typer.core import TyperCommand

from dh_grader.translations import (
    ENGLISH,
    Language,
    Sentence,
    language_named,
    reason_of,
    say,
    template,
    told,
)

# --- Output to the terminal, and errors that end the program


# The exit codes of `grade`; others use the second one, too.
BELOW_PASS_MARK: Final = 1
UNUSABLE: Final = 2
# The exit codes of a shell: 128 plus the number of the signal. SIGPIPE comes if the reader of a
# pipe has gone.
INTERRUPTED: Final = 130
BROKEN_PIPE: Final = 141
TERMINATED: Final = 143


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
    return say("{file} cannot be written: {reason}", file=str(file), reason=reason_of(error))


def unreadable(file: Path | str, error: OSError) -> Sentence:
    """Return the message that a file cannot be read."""
    return say("{file} cannot be read: {reason}", file=str(file), reason=reason_of(error))


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


# --- Translate the command line into the language of the user
#
# Help texts are English in the source; ``translate_help`` translates them when a command is loaded.
# Output for programs, the names of commands and options, and exit codes have no language.


OWN_VARIABLE: Final = "DH_GRADER_LANGUAGE"
# The words that typer adds to help texts. It asks gettext for all but the last.
_USAGE: Final = template("Usage: ")
_TYPER_WORDS: Final = (
    template("Arguments"),
    template("Options"),
    template("Commands"),
    template("Error"),
    template("Aborted."),
    template("[default: {}]"),
    template("[required]"),
    template("Try [blue]'{command_path} {help_option}'[/] for help."),
    template("Show this message and exit."),
    _USAGE,
)


def user_language(variables: Mapping[str, str] = os.environ) -> Language:
    """Return the language that the environment names, or English.

    DH_GRADER_LANGUAGE decides. Without it, the first known language of the list LANGUAGE and of the
    locale decides. The locales C and POSIX mean English.
    """
    if own := variables.get(OWN_VARIABLE):
        return language_named(own) or ENGLISH
    named = (variables.get(name) for name in ("LC_ALL", "LC_MESSAGES", "LANG"))
    locale = _tag(next(filter(None, named), ""))
    # As in gettext: these locales have no languages.
    if locale in ("C", "POSIX"):
        return ENGLISH
    wanted = [*map(_tag, variables.get("LANGUAGE", "").split(":")), locale]
    return next(filter(None, map(language_named, wanted)), ENGLISH)


def _tag(locale: str) -> str:
    return locale.partition(".")[0].partition("@")[0]


def spoken(text: str, language: Language | None = None) -> str:
    """Return a sentence in a language, by default that of the user."""
    return told(text, (language or user_language()).translation_of_commands)


def translate_help(command: Any) -> Any:
    """Translate the help texts of a typer command and its subcommands; return the command."""
    translation = user_language().translation_of_commands
    if translation is not None:
        # typer asks gettext when it loads the module that shows help.
        gettext.translation = lambda *_, **__: translation  # type: ignore[assignment]
        command.context_class.formatter_class = _Formatter
        for each in with_help(command):
            for name in ("help", "short_help"):
                if text := getattr(each, name, None):
                    setattr(each, name, _translated(text, translation))
    return command


def with_help(command: Any) -> Iterable[Any]:
    """Yield a command, all its subcommands, and all their options and arguments."""
    yield command
    yield from command.get_params(typer.Context(command))
    for each in getattr(command, "commands", {}).values():
        yield from with_help(each)


def paragraphs(text: str) -> list[str]:
    """Return the paragraphs of a help text, each as one line."""
    return [" ".join(each.split()) for each in text.split("\n\n")]


def _translated(text: str, translation: NullTranslations) -> str:
    return "\n\n".join(translation.gettext(each) if each else "" for each in paragraphs(text))


class _Formatter(TyperCommand.context_class.formatter_class):  # type: ignore[name-defined, misc]
    def write_usage(self, prog: str, args: str = "", prefix: str | None = None) -> None:
        translation = user_language().translation_of_commands
        shown = translation.gettext(_USAGE) if translation else prefix
        super().write_usage(prog, args, shown)


# --- Handle SIGINT and SIGTERM so that no unfinished files and no processes are left


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
    work: without it, the process would go on if the exception of a signal was lost.
    """
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
