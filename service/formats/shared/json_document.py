"""JSON that is safe to print to a terminal or the log of a build."""

import json
from collections.abc import Mapping
from typing import Final

from service.regex import regex

# In UTF-8: the start of a build's command (`##[…]`), and control characters that JSON allows.
_UNPRINTABLE: Final = regex(rb"#(?=#)|\x7f|\xc2[\x80-\x9f]")


def json_document(content: Mapping[str, object]) -> bytes:
    """Return the content as indented UTF-8 JSON."""
    # Names of files may contain bytes that are not UTF-8; these are replaced.
    text = json.dumps(content, indent=2, ensure_ascii=False)
    return printable(text.encode("utf-8", "replace")) + b"\n"


def printable(document: bytes) -> bytes:
    """Return equivalent JSON that is safe to print to a terminal or the log of a build."""
    return _UNPRINTABLE.sub(lambda sign: b"\\u%04x" % ord(sign[0].decode()), document)
