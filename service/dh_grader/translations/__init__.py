"""Sentences and their translations.

Each language has a folder with the sentences of reports (``sentences.po``), of pages
(``pages.po``) and of the command line (``commands.po``). This package imports no other.
"""

import errno
import hashlib
import os
import re
import struct
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, reduce
from gettext import GNUTranslations, NullTranslations
from io import BytesIO
from pathlib import Path
from typing import Any, Final, Protocol, TypeAlias

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

# --- Catalogues of translations, which are compiled when they are first read
#
# hatch_build.py runs this file by itself, so it needs nothing but the standard library.


_LINE: Final = re.compile(
    r'(?:(msgctxt|msgid|msgid_plural|msgstr(?:\[\d+\])?)[ \t]+)?"((?:[^"\\]|\\.)*)"\s*'
)
_ESCAPED: Final = re.compile(r"\\(.)")
_CONTROLS: Final = {"n": "\n", "t": "\t", "r": "\r"}
# The line of the header of a compiled catalogue that says of which text it is.
_SOURCE: Final = "x-compiled-from"
_MAGIC: Final = 0x950412DE


def read_catalogue(folder: Path, domain: str) -> GNUTranslations | None:
    """Return a catalogue of translations, or None if the folder has none for the domain."""
    text = _content(folder / f"{domain}.po")
    ready = _content(folder / f"{domain}.mo")
    if text is None:
        return None if ready is None else GNUTranslations(BytesIO(ready))
    if ready is not None:
        # A process may have been killed, or the disk been full, before the file was on the disk.
        with suppress(OSError, ValueError, struct.error):
            found = GNUTranslations(BytesIO(ready))
            if found.info().get(_SOURCE) == _digest(text):
                return found
    compiled = compiled_catalogue(text, f"{folder.name}/{domain}.po")
    _write(folder / f"{domain}.mo", compiled)
    return GNUTranslations(BytesIO(compiled))


def has_catalogue(folder: Path, domain: str) -> bool:
    """True if the folder has a catalogue for the domain."""
    return any((folder / f"{domain}{suffix}").is_file() for suffix in (".po", ".mo"))


def compiled_catalogue(text: bytes, name: str) -> bytes:
    """Return the ``.mo`` file of a ``.po`` file; raise ValueError if the text is invalid."""
    messages = dict(_messages(text.decode("utf-8"), name))
    messages[""] = f"{messages.get('', '')}{_SOURCE}: {_digest(text)}\n"
    pairs = sorted((one.encode(), other.encode()) for one, other in messages.items())
    # The format: https://www.gnu.org/software/gettext/manual/html_node/MO-Files.html
    header, entry = struct.calcsize("<7I"), struct.calcsize("<2I")
    tables = header, header + len(pairs) * entry
    place = header + 2 * len(pairs) * entry
    index, content = bytearray(), bytearray()
    for each in zip(*pairs, strict=True):
        for words in each:
            index += struct.pack("<2I", len(words), place + len(content))
            content += words + b"\0"
    return struct.pack("<7I", _MAGIC, 0, len(pairs), *tables, 0, place) + index + content


def _messages(text: str, name: str) -> Iterator[tuple[str, str]]:
    """Yield the sentences with a complete translation, as pairs in the form of a ``.mo`` file."""
    for block in re.split(r"\n\s*\n", text):
        lines = [line.strip() for line in block.strip().split("\n")]
        if any(line.startswith("#,") and "fuzzy" in line for line in lines):
            continue
        fields = _fields([line for line in lines if line and line[0] != "#"], name)
        forms = [words for field, words in fields.items() if field.startswith("msgstr")]
        if "msgid" in fields and all(forms):
            context = [f"{fields['msgctxt']}\4"] if "msgctxt" in fields else []
            numbers = [f"\0{fields['msgid_plural']}"] if "msgid_plural" in fields else []
            yield "".join((*context, fields["msgid"], *numbers)), "\0".join(forms)


def _fields(lines: Sequence[str], name: str) -> dict[str, str]:
    fields: dict[str, str] = {}
    field = ""
    for line in lines:
        found = _LINE.fullmatch(line)
        field = found[1] or field if found else ""
        if found is None or not field or (found[1] and field in fields):
            raise ValueError(f"{name}: not a line of a catalogue, or no blank line above: {line}")
        fields[field] = fields.get(field, "") + _ESCAPED.sub(_unescaped, found[2])
    return fields


def _unescaped(found: re.Match[str]) -> str:
    return _CONTROLS.get(found[1], found[1])


def _digest(text: bytes) -> str:
    return hashlib.sha256(text).hexdigest()


def _content(file: Path) -> bytes | None:
    try:
        return file.read_bytes()
    except OSError:
        return None


def _write(file: Path, content: bytes) -> None:
    """Write a file as a whole, or not at all where the folder is read-only."""
    # Several processes may do so at once, and under Windows a file cannot be replaced while
    # another process reads it.
    new = file.with_name(f"{file.stem}.{os.urandom(8).hex()}.mo")
    with suppress(OSError):
        try:
            new.write_bytes(content)
            new.replace(file)
        finally:
            new.unlink(missing_ok=True)


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


# What the operating system says in English about the files of students and tutors.
_REASONS: Final = {
    errno.EACCES: template("Permission denied"),
    errno.EISDIR: template("Is a directory"),
    errno.ENOENT: template("No such file or directory"),
    errno.ENOSPC: template("No space left on device"),
    errno.ENOTDIR: template("Not a directory"),
    errno.EROFS: template("Read-only file system"),
}


def reason_of(error: OSError) -> str:
    """Return why the operating system refused something."""
    reason = _REASONS.get(error.errno or 0)
    return say(reason) if reason and reason == error.strerror else str(error.strerror)


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
