"""The static files of the pages, which are served under names with a hash of the content.

A changed file gets another name, so browsers may cache each file without a limit. All files are
served from one folder, so no two of them may have the same name.
"""

import hashlib
import json
import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from graphlib import TopologicalSorter
from pathlib import Path
from typing import Any, Final, NamedTuple

from dh_grader.regex import regex
from dh_grader.translations import LANGUAGES, Language

# Translate the sentences in the pages' scripts: one dictionary for each language.


# English needs none.


# A sentence in a script: the first argument of `worded`, or the first two of `wordedFor`.
_TEXT: Final = r"\s*(\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*')"
_WORDED: Final = regex(rf"\bworded\({_TEXT}")
_COUNTED: Final = regex(rf"\bwordedFor\({_TEXT},{_TEXT}")
# The place in words.js for the names of the dictionaries.
_PLACE: Final = "const FILES = {};"


class ScriptSentences(NamedTuple):
    """The English sentences of scripts; ``counted`` has pairs of a singular and a plural."""

    plain: tuple[str, ...]
    counted: tuple[tuple[str, str], ...]


def sentences_in(scripts: Iterable[str]) -> ScriptSentences:
    """Return the English sentences in all scripts."""
    # A vendored library is larger than all own scripts and has none.
    own = [script for script in scripts if "worded" in script]
    plain = (_unquoted(match[1]) for script in own for match in _WORDED.finditer(script))
    counted = (
        (_unquoted(match[1]), _unquoted(match[2]))
        for script in own
        for match in _COUNTED.finditer(script)
    )
    return ScriptSentences(tuple(plain), tuple(counted))


def dictionary(language: Language, sentences: ScriptSentences) -> str:
    """Return the JavaScript file with a language's translations of the sentences in scripts."""
    words: dict[str, str] = {}
    counts: dict[str, tuple[str, str]] = {}
    translation = language.translation_of_scripts
    if translation is not None:
        for text in sentences.plain:
            if (told := translation.gettext(text)) != text:
                words[text] = told
        for one, many in sentences.counted:
            forms = (translation.ngettext(one, many, 1), translation.ngettext(one, many, 2))
            if forms != (one, many):
                counts[one] = forms
    found: dict[str, Any] = {"tag": language.tag, "words": words, "counts": counts}
    return f"export default {json.dumps(found, ensure_ascii=False, sort_keys=True)};\n"


def with_dictionaries(script: str, names: dict[str, str]) -> str:
    """Return the script words.js with the addresses of the dictionaries inserted."""
    # ``script`` is the text of words.js, and ``names`` has the addresses by language.
    return script.replace(_PLACE, f"const FILES = {json.dumps(names)};")


def _unquoted(text: str) -> str:
    """Return the text of a string literal in JavaScript."""
    if text[0] == "'":
        text = '"' + text[1:-1].replace("\\'", "'").replace('"', '\\"') + '"'
    return str(json.loads(text))


# The names are made when the service starts; there is no build step. In the source, a module
# imports another one by its path, such as ``"../shared/dom.js"``. Each language but English has one
# more file, the dictionary of the scripts.


FOLDER: Final = Path(__file__).parent / "static"
_MEDIA_TYPES: Final = {".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml"}
# A file names another one by its path in quotes. A module may also import one later.
# A pattern that begins with plain characters is ten times as fast.
_NAMED: Final = regex(r'"(\.\.?/[\w./-]+\.(?:js|css|svg))"')
_LATER: Final = ("import(", "import.meta.resolve(")
# The script that loads the dictionaries.
_WORDS: Final = "words.js"


@dataclass(frozen=True, slots=True)
class Asset:
    """A static file, with the ``name`` and the ``content`` that browsers get.

    ``needs`` has the plain names of all files that this file refers to: the names without a hash.
    """

    # It does not have the modules that a script imports only when it needs them.

    name: str
    content: bytes
    media_type: str
    needs: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Assets:
    """All static files, by their plain names: the names without a hash."""

    by_plain_name: Mapping[str, Asset]

    @property
    def by_name(self) -> dict[str, Asset]:
        """Return the files by the names under which they are served."""
        return {asset.name: asset for asset in self.by_plain_name.values()}

    def name(self, plain_name: str) -> str:
        """Return the name, with a hash, under which a file is served."""
        return self.by_plain_name[plain_name].name

    def modules(self, plain_name: str) -> list[str]:
        """Return the names of a module and of all modules that it imports."""
        # Pages preload them.
        found: dict[str, None] = {}
        waiting = [plain_name]
        while waiting:
            name = waiting.pop()
            if name.endswith(".js") and name not in found:
                found[name] = None
                waiting += self.by_plain_name[name].needs
        return [self.name(name) for name in found]

    def words(self, language: Language) -> str | None:
        """Return the file name of a language's dictionary for scripts, or None if there is none."""
        found = self.by_plain_name.get(_dictionary_name(language))
        return None if found is None else found.name


def load_assets(folder: Path = FOLDER) -> Assets:
    """Return all static files in a folder and its subfolders.

    Raises LookupError for a reference to a missing file, or ValueError for equal file names.
    """
    found = [file for file in folder.rglob("*") if file.suffix in _MEDIA_TYPES]
    files = {file.name: file for file in found}
    if len(files) < len(found):
        raise ValueError(f"two static files have the same name: {sorted(map(str, found))}")
    texts = {name: file.read_text(encoding="utf-8") for name, file in files.items()}
    named = {name: list(_NAMED.finditer(text)) for name, text in texts.items()}
    targets = {name: [_target(files, name, match) for match in named[name]] for name in files}
    assets: dict[str, Asset] = {}
    if _WORDS in texts:
        languages = [each for each in LANGUAGES.values() if each.translation]
        sentences = sentences_in(texts.values())
        for each in languages:
            name = _dictionary_name(each)
            assets[name] = _asset(name, dictionary(each, sentences).encode())
        addresses = {each.code: f"./{_dictionary_name(each)}" for each in languages}
        texts[_WORDS] = with_dictionaries(texts[_WORDS], addresses)
    # The named files come first: a name is part of the content that is hashed.
    for name in TopologicalSorter(targets).static_order():
        content = _NAMED.sub(lambda match: f'"./{assets[_name(match)].name}"', texts[name]).encode()
        needs = tuple(
            target
            for target, match in zip(targets[name], named[name], strict=True)
            if not texts[name].endswith(_LATER, 0, match.start())
        )
        assets[name] = _asset(name, content, needs)
    return Assets(assets)


def _asset(name: str, content: bytes, needs: tuple[str, ...] = ()) -> Asset:
    stem, suffix = Path(name).stem, Path(name).suffix
    hashed = f"{stem}-{hashlib.sha256(content).hexdigest()[:12]}{suffix}"
    return Asset(hashed, content, _MEDIA_TYPES[suffix], needs)


def _dictionary_name(language: Language) -> str:
    return f"words-{language.code}.js"


def _name(match: re.Match[str]) -> str:
    return match[1].rpartition("/")[2]


def _target(files: Mapping[str, Path], name: str, match: re.Match[str]) -> str:
    # Return the plain name of the file to which a reference in the file ``name`` leads.
    path = Path(os.path.normpath(files[name].parent / match[1]))
    if files.get(path.name) != path:
        raise LookupError(f"the static file {name} names {path}, which does not exist")
    return path.name
