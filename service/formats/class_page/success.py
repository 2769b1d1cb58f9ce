"""Success per exercise, part, row and cell: the share of right answers, of those who answered."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Final
from xml.etree.ElementTree import Element

from service.formats.class_page.overview import Overview
from service.formats.class_page.words import folded, note, section
from service.formats.shared.graded import AnsweredPart
from service.formats.shared.markup import element
from service.formats.shared.messages import places_in_words
from service.formats.shared.plain_text import number, whole_percent
from service.grading import Place
from service.statistics import PartSuccess, Share
from service.statistics.success import columns

# The shares from which on a cell has the next colour; the number stands in it in any case.
_BANDS: Final = (0.0, 0.25, 0.5, 0.75, 0.9)
_WRONG_ENTRIES: Final = 15


def success(overview: Overview) -> Element:
    """The section on success."""
    parts = overview.statistics.parts
    content = [
        note(
            "The share of right answers, of those who answered. What could not be read counts as "
            "answered and not right. A table in frames of its own is right if it describes the "
            "same arm."
        ),
        _legend(),
    ]
    several = len(overview.exercises) > 1
    for exercise in overview.exercises.values():
        if several:
            content.append(element("h3", exercise.title))
        found = ((part, parts.get((exercise.id, part.id))) for part in exercise.parts)
        content += [
            _card(part, counted, "h4" if several else "h3") for part, counted in found if counted
        ]
    return section("success", "Success", *content)


def _legend() -> Element:
    edges = [f"{edge * 100:.0f}" for edge in (*_BANDS, 1.0)]
    entries = [
        element("li", f"{low}–{high} %", class_=f"share{i}")
        for i, (low, high) in enumerate(pairwise(edges))
    ]
    return element("ul", *entries, class_="legend", aria_label="Colours of shares")


def _card(part: AnsweredPart, counted: PartSuccess, heading: str) -> Element:
    share = counted.share
    told = "nobody answered" if share.value is None else f"{whole_percent(share.value)} right"
    badge = element("span", told, class_=f"badge {_band(share)}")
    header = element("header", element(heading, part.title), badge)
    card = element("section", header, class_="card", aria_label=part.title)
    card.append(element("p", _in_words(part, counted), class_="quiet inside"))
    if counted.rows:
        card.append(element("div", _table(part, counted), class_="cells", tabindex="0"))
        card.extend(_wrong_entries(counted))
    return card


def _in_words(part: AnsweredPart, counted: PartSuccess) -> str:
    share = counted.share
    words = f"{share.answered:,} of {counted.seen:,} answered, {share.correct:,} all right."
    if counted.mean_points is None:
        return words
    return f"{words} Mean of those who answered: {_points(part, counted.mean_points)}."


def _points(part: AnsweredPart, mean: float) -> str:
    return f"{number(mean)} / {number(part.points)} points"


def _table(part: AnsweredPart, counted: PartSuccess) -> Element:
    labels = columns(counted.rows.values())
    heads = (element("th", label, scope="col") for label in ["row", *labels, "whole row"])
    body = [
        element(
            "tr",
            element("th", label, scope="row"),
            *(_cell(row.cells[name].share if name in row.cells else None) for name in labels),
            _cell(row.share, whole_row=True),
        )
        for label, row in counted.rows.items()
    ]
    caption = element("caption", f"{part.title}: share of right entries", class_="unseen")
    head = element("thead", element("tr", *heads))
    return element("table", caption, head, element("tbody", *body))


def _cell(share: Share | None, *, whole_row: bool = False) -> Element:
    if share is None or share.value is None:
        return element("td", "–", class_="share-none")
    told = element("span", whole_percent(share.value), class_="share")
    count = element("span", f"{share.correct:,}/{share.answered:,}", class_="of")
    return element("td", told, count, class_=f"{_band(share)}{' whole-row' * whole_row}")


def _band(share: Share) -> str:
    if share.value is None:
        return "share-none"
    return f"share{sum(share.value >= low for low in _BANDS) - 1}"


def _wrong_entries(counted: PartSuccess) -> Iterator[Element]:
    found = counted.commonest_wrong(_WRONG_ENTRIES)
    if not found:
        return
    rows = [
        element(
            "tr",
            element("th", places_in_words([Place(wrong.row, wrong.cell)]), scope="row"),
            element("td", element("code", wrong.text)),
            element("td", f"{wrong.times:,}", class_="times"),
        )
        for wrong in found
    ]
    heads = (element("th", name, scope="col") for name in ("place", "as it was read", "times"))
    head = element("thead", element("tr", *heads))
    table = element("table", head, element("tbody", *rows), class_="entries")
    yield folded(
        ["Commonest wrong entries"], element("div", table, class_="cells", tabindex="0"), kind="in"
    )
