"""The static files of the pages, which are served under names with a hash of the content.

A changed file gets another name, so browsers may cache each file without a limit. All files are
served from one folder, so no two of them may have the same name.
"""

# The names are made when the service starts; there is no build step. In the source, a module
# imports another one by its path, such as ``"../shared/dom.js"``. Each language but English has one
# more file, the dictionary of the scripts.

import hashlib
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from graphlib import TopologicalSorter
from pathlib import Path
from typing import Final

from service.regex import regex
from service.translations import LANGUAGES, Language
from service.web.script_words import dictionary, sentences_in, with_dictionaries

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
