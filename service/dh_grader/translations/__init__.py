"""Sentences and their translations.

``sentence`` makes sentences, ``languages`` has the catalogues of translations. Each language has a
folder with the sentences of reports (``sentences.po``), of pages (``pages.po``) and of the command
line (``commands.po``).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, reduce
from gettext import NullTranslations
from pathlib import Path
from typing import Any, Final, Protocol, TypeAlias

from dh_grader.translations.catalogues import has_catalogue, read_catalogue

# This is the lowest package: it imports no other.


__all__ = [
    "ENGLISH",
    "LANGUAGES",
    "Language",
    "Sentence",
    "SentenceValue",
    "accepted_language",
    "bulleted",
    "joined",
    "language_named",
    "listed",
    "paragraph",
    "say",
    "say_count",
    "template",
    "told",
]


# --- Sentences for people: a template in English with named values
#
# A sentence is its English text, and keeps its template and values, so that it can be translated
# later. A value is a name, a number, a formula or another sentence. Example: ``joint`` and ``name``
# in ``say("Joint {joint} slides, and its variable is {name}.", joint=3, name="d3")``.
#
# The extraction finds the templates in the calls of ``say``, ``say_count`` and ``template``, so
# each template must be one string constant there.


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


# --- The languages of the service, and the choice of a language for a reader


_FOLDER: Final = Path(__file__).parent
# The catalogues of a language: the sentences of reports, those of pages, and the command line's.
DOMAINS: Final = ("sentences", "pages", "commands")


@dataclass(frozen=True)
class Language:
    """A language: its code, its name in that language, and its tag in HTML."""

    code: str
    name: str
    tag: str

    def __getstate__(self) -> dict[str, str]:
        """Return the language without its catalogue of translations."""
        # Other processes read the catalogue themselves.
        return {"code": self.code, "name": self.name, "tag": self.tag}

    @cached_property
    def translation(self) -> NullTranslations | None:
        """The catalogue of translations; None for English, the language of the templates."""
        return self._catalogue(("sentences", "pages"))

    @cached_property
    def translation_of_scripts(self) -> NullTranslations | None:
        """The catalogue of translations for scripts."""
        # It prefers the translations of pages to those of reports.
        return self._catalogue(("pages", "sentences"))

    @cached_property
    def translation_of_commands(self) -> NullTranslations | None:
        """The catalogue of translations for the command line."""
        # The command line also prints sentences of reports.
        return self._catalogue(("commands", "sentences"))

    def _catalogue(self, domains: Sequence[str]) -> NullTranslations | None:
        """Return the merged catalogues of these domains; an earlier domain takes precedence."""
        if self.code == "en":
            return None
        # A template that no catalogue has stays English.
        found = NullTranslations()
        for domain in reversed(domains):
            read = read_catalogue(_FOLDER / self.code, domain)
            if read is not None:
                read.add_fallback(found)
                found = read
        return found


ENGLISH: Final = Language("en", "English", "en")
_KNOWN: Final = (
    ENGLISH,
    Language("de", "Deutsch", "de"),
    Language("es", "Español", "es"),
    Language("fr", "Français", "fr"),
    Language("zh", "简体中文", "zh-Hans"),
)
# Those with a catalogue of reports. Tests check that all catalogues of a language are complete.
LANGUAGES: Final[Mapping[str, Language]] = {
    each.code: each
    for each in _KNOWN
    if each is ENGLISH or has_catalogue(_FOLDER / each.code, "sentences")
}


def language_named(tag: str | None) -> Language | None:
    """Return the language of a tag such as ``de``, ``de-AT`` or ``zh_CN``, or None."""
    return LANGUAGES.get((tag or "").replace("_", "-").partition("-")[0].strip().lower())


def accepted_language(header: str | None) -> Language:
    """Return the language for a reader, from the header ``Accept-Language``, or else English."""
    # The header may be invalid.
    wanted = []
    for i, each in enumerate((header or "")[:500].split(",")):
        tag, _, parameters = each.partition(";")
        language = language_named(tag)
        quality = _quality(parameters)
        if language and quality > 0:
            wanted.append((-quality, i, language))
    return min(wanted, key=lambda one: one[:2], default=(0, 0, ENGLISH))[2]


def _quality(parameters: str) -> float:
    name, _, value = parameters.partition("=")
    if name.strip().lower() != "q":
        return 1.0
    try:
        return float(value)
    except ValueError:
        return 0.0
