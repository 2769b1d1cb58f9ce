"""The languages of the service, and the choice of a language for a reader."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from gettext import NullTranslations
from pathlib import Path
from typing import Final

from service.translations.catalogues import has_catalogue, read_catalogue

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
