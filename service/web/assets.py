"""The static files of the page, each under a name that holds a hash of its content.

A file that has changed has another name, so that a browser may keep each for ever. The names are
made when the service starts: there is no build step, and in the source a module imports
``"./dom.js"`` as it stands beside it.
"""

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from graphlib import TopologicalSorter
from pathlib import Path
from typing import Final

FOLDER: Final = Path(__file__).parent / "static"
_MEDIA_TYPES: Final = {".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml"}
# A file names another one in quotes, as beside it; a module may import one later, when it needs it.
# A pattern that begins with plain characters is searched for ten times as fast.
_NAMED: Final = re.compile(r'"\./([\w.-]+)"')
_LATER: Final = "import("


@dataclass(frozen=True, slots=True)
class Asset:
    """A file as it is served; ``needs`` are the plain names of those that it names itself.

    Modules that it imports later are not among them.
    """

    name: str
    content: bytes
    media_type: str
    needs: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Assets:
    """All files, by their plain names and by those under which they are served."""

    by_plain_name: Mapping[str, Asset]

    @property
    def by_name(self) -> dict[str, Asset]:
        """The files by the names under which they are served."""
        return {asset.name: asset for asset in self.by_plain_name.values()}

    def name(self, plain_name: str) -> str:
        """The name under which a file is served."""
        return self.by_plain_name[plain_name].name

    def modules(self, plain_name: str) -> list[str]:
        """The names of all modules that a module needs, it included, so that none is waited for."""
        found: dict[str, None] = {}
        waiting = [plain_name]
        while waiting:
            name = waiting.pop()
            if name.endswith(".js") and name not in found:
                found[name] = None
                waiting += self.by_plain_name[name].needs
        return [self.name(name) for name in found]


def load_assets(folder: Path = FOLDER) -> Assets:
    """The files of a folder. Raises LookupError where one names another that there is not."""
    files = {file.name: file for file in folder.iterdir() if file.suffix in _MEDIA_TYPES}
    texts = {name: file.read_text(encoding="utf-8") for name, file in files.items()}
    named = {name: list(_NAMED.finditer(text)) for name, text in texts.items()}
    assets: dict[str, Asset] = {}
    # Those that are named come first: a name is part of the content that is hashed.
    order = {name: [match[1] for match in found] for name, found in named.items()}
    for name in TopologicalSorter(order).static_order():
        if name not in files:
            raise LookupError(f"a static file names {name!r}, which does not exist")
        content = _NAMED.sub(lambda match: f'"./{assets[match[1]].name}"', texts[name]).encode()
        needs = tuple(
            match[1] for match in named[name] if not texts[name].endswith(_LATER, 0, match.start())
        )
        stem, suffix = files[name].stem, files[name].suffix
        hashed = f"{stem}-{hashlib.sha256(content).hexdigest()[:12]}{suffix}"
        assets[name] = Asset(hashed, content, _MEDIA_TYPES[suffix], needs)
    return Assets(assets)
