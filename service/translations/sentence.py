"""Sentences for people: a template in English with named values.

A sentence is its English text, and keeps its template and values, so that it can be translated
later. A value is a name, a number, a formula or another sentence. ::

    say("Joint {joint} slides, and its variable is {name}.", joint=3, name="d3")
"""

# The extraction finds the templates in the calls of ``say``, ``say_count`` and ``template``, so
# each template must be one string constant there.

from collections.abc import Mapping, Sequence
from functools import reduce
from typing import Any, Final, Protocol, TypeAlias

SentenceValue: TypeAlias = str | int

_NO_VALUES: Final[Mapping[str, SentenceValue]] = {}


class Translation(Protocol):
    """The catalogue of translations of a language, such as ``gettext.GNUTranslations``."""

    def gettext(self, message: str, /) -> str:
        """Return the template in the language."""

    def ngettext(self, one: str, many: str, count: int, /) -> str:
        """Return the language's template for this count."""


class Sentence(str):
    """A text in English that remembers its ``template`` and ``values``.

    ``plural`` is the template for any ``count`` but 1. If nothing is counted, ``plural`` is empty.
    """

    __slots__ = ("plural", "template", "values")

    template: str
    plural: str
    values: Mapping[str, SentenceValue]

    def __new__(
        cls, template: str, values: Mapping[str, SentenceValue] = _NO_VALUES, plural: str = ""
    ) -> "Sentence":
        """Return the sentence of a template and its values."""
        chosen = plural if plural and values["count"] != 1 else template
        self = super().__new__(cls, chosen.format_map(values))
        self.template, self.plural, self.values = template, plural, values
        return self

    def __getnewargs__(self) -> tuple[Any, ...]:
        """Return the arguments that make an equal sentence, for ``pickle``."""
        return self.template, self.values, self.plural


def say(template: str, /, **values: SentenceValue) -> Sentence:
    """Return the sentence of a template, in which a value replaces its ``{name}``."""
    return Sentence(template, values)


def say_count(one: str, many: str, /, *, count: int, **values: SentenceValue) -> Sentence:
    """Return the sentence of the template ``one`` if ``count`` is 1, otherwise of ``many``."""
    return Sentence(one, {"count": count, **values}, many)


def template(text: str, /) -> str:
    """Return the text, and mark it for extraction as a template that is filled later."""
    return text


def listed(words: Sequence[str]) -> str:
    """Return the words with commas between them and "and" before the last."""
    if len(words) < 2:
        return words[0] if words else ""
    first = reduce(lambda one, other: say("{one}, {other}", one=one, other=other), words[:-1])
    return say("{first} and {last}", first=first, last=words[-1])


def paragraph(*sentences: str) -> str:
    """Return complete sentences as one text; empty sentences are left out."""
    said = [each for each in sentences if each]
    if len(said) < 2:
        return said[0] if said else ""
    return say("{first} {second}", first=paragraph(*said[:-1]), second=said[-1])


def joined(separator: str, sentences: Sequence[str]) -> Sentence:
    """Return complete sentences, joined by a separator such as a line break."""
    # The separator must be one that every language uses. A blank is not, because Chinese has no
    # blanks: see ``paragraph``.
    values = {f"sentence{i}": sentence for i, sentence in enumerate(sentences)}
    return Sentence(separator.join(f"{{{name}}}" for name in values), values)


def bulleted(sentences: Sequence[str]) -> Sentence:
    """Return sentences as the items of a Markdown list."""
    return joined("\n", [Sentence("- {item}", {"item": each}) for each in sentences])


def told(text: str, translation: Translation | None) -> str:
    """Return a sentence in a language (None is English); other texts are returned unchanged."""
    # The translation of the empty text is the head of a catalogue.
    if translation is None or not isinstance(text, Sentence) or not text.template:
        return text
    if text.plural:
        found = translation.ngettext(text.template, text.plural, int(text.values["count"]))
    else:
        found = translation.gettext(text.template)
    values = {
        name: told(value, translation) if isinstance(value, str) else value
        for name, value in text.values.items()
    }
    return found.format_map(values)
