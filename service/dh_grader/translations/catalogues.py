"""Catalogues of translations: their texts (``.po``), and what gettext reads (``.mo``).

Git has only the texts. A wheel has only the compiled catalogues: ``hatch_build.py`` compiles them.
In a checkout, a catalogue is compiled when it is first read, and again after its text has changed.
"""

import hashlib
import os
import re
import struct
from collections.abc import Iterator, Sequence
from contextlib import suppress
from gettext import GNUTranslations
from io import BytesIO
from pathlib import Path
from typing import Final

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
