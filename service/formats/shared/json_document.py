"""JSON that may be printed as well as read."""

import json
import re
from collections.abc import Mapping
from typing import Final

# In UTF-8: a build's command `##[…]`, and the controls that JSON may hold as they are.
_UNPRINTABLE: Final = re.compile(rb"#(?=#)|\x7f|\xc2[\x80-\x9f]")


def json_document(content: Mapping[str, object]) -> bytes:
    """The content as UTF-8 JSON to be read by people, too."""
    # Bytes that are not UTF-8, in the name of a file, are replaced.
    text = json.dumps(content, indent=2, ensure_ascii=False)
    return printable(text.encode("utf-8", "replace")) + b"\n"


def printable(document: bytes) -> bytes:
    """The same JSON, in which a terminal finds no controls and a build no commands of its own."""
    return _UNPRINTABLE.sub(lambda sign: b"\\u%04x" % ord(sign[0].decode()), document)
