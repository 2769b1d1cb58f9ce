"""Pieces that the sections of the index share."""

from collections.abc import Iterable, Sequence
from itertools import islice
from typing import Final
from urllib.parse import quote
from xml.etree.ElementTree import Element

from service.formats.class_page.overview import Overview, SubmissionLine
from service.formats.shared.markup import Child, element

# So many items of a list are shown, the others are folded.
FOLDED_FROM: Final = 12


def section(name: str, heading: str, *content: Element) -> Element:
    """A section of the page with its heading; links lead to its name."""
    return element("section", element("h2", heading), *content, id=name)


def note(*words: Child) -> Element:
    """A paragraph in quiet words."""
    return element("p", *words, class_="quiet")


def plural(count: int, noun: str) -> str:
    """``1 submission``, ``2,000 submissions``."""
    return f"{count:,} {noun}{'' if count == 1 else 's'}"


def link(overview: Overview, line: SubmissionLine) -> Element:
    """The name of a submission, which leads to its page."""
    return element("a", overview.shown(line), href=quote(line.page))


def names(overview: Overview, lines: Iterable[SubmissionLine]) -> Element:
    """The submissions as a list of links."""
    return element("ul", *(element("li", link(overview, line)) for line in lines), class_="names")


def folded(summary: Sequence[Child], *content: Element, kind: str = "item") -> Element:
    """Content that a click or a key unfolds."""
    return element("details", element("summary", *summary), *content, class_=kind)


def long_list(items: Sequence[Element]) -> list[Element]:
    """The first items in a card, and the others folded below."""
    rest = list(islice(items, FOLDED_FROM, None))
    shown = [element("div", *items[:FOLDED_FROM], class_="card list")]
    if rest:
        more = element("div", *rest, class_="card list")
        shown.append(folded([f"{len(rest):,} more"], more, kind="more"))
    return shown


def bar(share: float) -> Element:
    """A share, 0..1, as a bar; it stands beside its number and says nothing more."""
    filled = element("rect", width=f"{share * 100:.2f}", height="1")
    shape = {"viewBox": "0 0 100 1", "preserveAspectRatio": "none", "aria_hidden": "true"}
    return element("svg", filled, class_="bar", **shape)
