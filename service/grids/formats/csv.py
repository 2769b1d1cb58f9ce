"""Cells separated by commas. A comma in brackets, as in atan2(y, x), is part of its cell."""

from typing import Final

from service.grids.cutting.grid import Grid, GridFormat, grid
from service.grids.cutting.pairs import outside
from service.grids.cutting.source_text import SourceText
from service.grids.formats.delimited import split_cells
from service.regex import regex

# The label of a row with a colon or bracket after it: "1: l1, 0", "Row 1: l1, 0", "a: l1, l2".
_LABEL: Final = regex(
    r"(?:[ij]\s?=\s?)?((?:[^\W\d_]{3,20}[ .]?|[JjLl])?\d{1,2}|(?:alpha|theta|[adαθ])(?=\s?:))"
    r"\s?[:)]\s{0,9}(?=\S)"
)


def _matches(text: str) -> bool:
    return any(True for _ in outside(text, ","))


def _parse(source: SourceText) -> Grid:
    rows = split_cells(source, ",", brackets=True)
    rows = [[row[0].strip(), *row[1:]] for row in rows if len(row) > 1 or row[0].text.strip()]
    filled = [row for row in rows if any(cell.text.strip() for cell in row)]
    labels = [_LABEL.match(row[0].text) for row in filled]
    if all(labels) and len(set(map(len, filled))) == 1:
        rows = [
            [row[0].cut(*label.span(1)), row[0].cut(label.end(), len(row[0].text)), *row[1:]]
            for row, label in zip(filled, labels, strict=True)
            if label
        ]
    return grid("CSV", rows, source.whole)


FORMAT: Final = GridFormat(_matches, _parse)
