"""Translate the command line into the language of the user.

Help texts are English in the source; ``translate_help`` translates them when a command is loaded.
"""

# Output for programs, the names of commands and options, and exit codes have no language.

import gettext
import os
from collections.abc import Iterable, Mapping
from gettext import NullTranslations
from typing import Any, Final

import typer
from typer.core import TyperCommand

from service.translations import ENGLISH, Language, language_named, template, told

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
    """Return the language that the environment names, or English."""
    # DH_GRADER_LANGUAGE decides. Without it, the first known language of the list LANGUAGE and of
    # the locale decides. The locales C and POSIX mean English.
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
