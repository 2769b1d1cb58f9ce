"""The frame of a page: one file that needs no other, for light and dark screens and for paper.

It has no script, and a policy that forbids any: whatever somebody wrote stays text.
"""

import base64
import hashlib
from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element, tostring

from service.formats.shared.markup import element

_STYLE_FILE: Final = Path(__file__).with_name("templates") / "report.css"
_SHARED_STYLE: Final = _STYLE_FILE.read_text(encoding="utf-8")
CLOSING: Final = b"</body>\n</html>\n"


def style_sheet(file: Path) -> str:
    """The style of all pages and, behind it, that of one sort of page."""
    return _SHARED_STYLE + file.read_text(encoding="utf-8")


def opening(title: str, style: str) -> bytes:
    """The page up to its content; ``CLOSING`` closes it."""
    head = [
        element("meta", charset="utf-8"),
        element("meta", http_equiv="Content-Security-Policy", content=_policy(style)),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("meta", name="color-scheme", content="light dark"),
        element("title", title),
    ]
    sheet = b"<style>%b</style>" % style.encode()
    lines = [b"<!doctype html>", b'<html lang="en">', b"<head>", *map(written, head), sheet]
    return b"\n".join([*lines, b"</head>", b"<body>", b""])


def written(content: Element) -> bytes:
    """The element as HTML in UTF-8."""
    html: bytes = tostring(content, encoding="utf-8", method="html")
    return html


def style_sources(*styles: str) -> str:
    """These styles and no other, as a policy allows them."""
    marks = (hashlib.sha256(style.encode()).digest() for style in styles)
    return " ".join(f"'sha256-{base64.b64encode(mark).decode()}'" for mark in marks)


def _policy(style: str) -> str:
    return f"default-src 'none'; style-src {style_sources(style)}"
