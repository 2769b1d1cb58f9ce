"""A parser of pages that allows only certain elements and attributes."""

from collections.abc import Mapping
from collections.abc import Set as AbstractSet
from html.parser import HTMLParser

import pytest

# The allowed attributes of each element. None of them is a script or a style, and only ``a`` may
# be a link.
ALLOWED: Mapping[str, AbstractSet[str]] = {
    "html": {"lang"}, "head": set(), "body": set(), "style": set(), "title": set(),
    "meta": {"charset", "http-equiv", "content", "name"}, "main": set(),
    "article": set(), "section": {"class"},
    "header": {"class"}, "footer": set(), "h1": set(), "h2": set(), "h3": set(), "p": {"class"},
    "div": {"class"}, "span": {"class", "title"}, "strong": set(), "code": set(), "ul": {"class"},
    "li": set(), "table": set(), "thead": set(), "tbody": set(), "tr": set(), "td": {"class"},
    "th": {"scope"}, "svg": {"class", "role", "aria-label", "viewbox"},
    "circle": {"class", "cx", "cy", "r", "stroke-width", "stroke-dasharray", "transform"},
    "text": {"x", "y", "text-anchor"},
    "math": set(), "mi": {"mathvariant"}, "mn": set(), "mo": {"form", "rspace", "stretchy"},
    "mrow": set(), "mspace": {"width"}, "mfrac": set(), "msqrt": set(), "msub": set(),
    "msup": set(), "msubsup": set(),
}  # fmt: skip
VOID = {"meta"}


class PageReader(HTMLParser):
    """Checks a page's elements and attributes, and collects its texts, links and ids."""

    def __init__(self, page: str, allowed: Mapping[str, AbstractSet[str]] = ALLOWED) -> None:
        super().__init__(convert_charrefs=True)
        self._allowed = allowed
        self.open: list[str] = []
        self.texts: list[str] = []
        self.links: list[str] = []
        self.names: list[str] = []
        self.feed(page)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        assert {name for name, _ in attrs} <= self._allowed[tag], tag
        self.links += [value or "" for name, value in attrs if name == "href"]
        self.names += [value or "" for name, value in attrs if name == "id"]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open[-1:] != ["style"]:
            self.texts.append(data)

    def handle_comment(self, data: str) -> None:
        pytest.fail(f"a comment: {data}")
