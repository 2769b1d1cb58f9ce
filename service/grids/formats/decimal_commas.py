"""Decimal commas in a grid whose cells are separated by other signs: ``0,1625;90°;0,4``.

Spreadsheets of most European countries write numbers so. A comma is never guessed to be a decimal
comma: each comma after a digit must be one, and at least one number must have no other meaning.
"""

import re
from collections.abc import Mapping
from dataclasses import replace
from itertools import chain
from typing import Final

from service.expressions.errors import Note
from service.grids.cutting.grid import Grid, GridCell, GridError
from service.grids.cutting.pairs import outside
from service.regex import regex
from service.translations import say

_NUMBER: Final = regex(r"(?<![\w.,])\d{1,15},\d{1,15}(?![\w.,]*[.,]\d)", re.ASCII)
# A number whose comma may stand between thousands: 1,000 or 12,500.
_THOUSANDS: Final = regex(r"[1-9]\d{0,2},\d{3}", re.ASCII)
# A point that may stand between thousands in the same language: 1.000 or 12.500,5.
_POINT: Final = regex(r"(?<![\d.])[1-9]\d{0,2}\.\d{3}(?!\d)", re.ASCII)
# A number with a sign between thousands and a decimal comma: 1.000,5. The reader of its cell names
# the sign.
_GROUPED: Final = regex(
    r"(?<![\w.,])[1-9]\d{0,2}(?:[.'’ \u00a0\u202f]\d{3})+,\d{1,15}(?![\w.,]*[.,]\d)", re.ASCII
)
# One line between semicolons may be several rows of a matrix.
_FEWEST: Final = 2


def with_decimal_points(grid: Grid) -> Grid:
    """Return the grid with points for its decimal commas, and a note; unchanged if unsure.

    Raises GridError if a point in another number may separate thousands.
    """
    if len(grid.rows) < _FEWEST or min(map(len, grid.rows)) < _FEWEST:
        return grid
    cells = [
        cell
        for cell in chain.from_iterable(grid.rows)
        if "," in cell.text and not _GROUPED.search(cell.text)
    ]
    found = [_numbers(cell.text) for cell in cells]
    numbers = [number for each in found for number in (each or {}).values()]
    is_sure = all(each is not None for each in found) and any(
        not _THOUSANDS.fullmatch(number) for number in numbers
    )
    if not is_sure:
        return grid
    for cell in chain.from_iterable(grid.rows):
        if (point := _POINT.search(cell.text)) and not _GROUPED.search(cell.text):
            raise _in_thousands(cell, point)
    message = say(
        "`{typed}` is read as {number}: the comma is a decimal comma.",
        typed=numbers[0],
        number=numbers[0].replace(",", "."),
    )
    first = next(cell for cell, each in zip(cells, found, strict=True) if each)
    rows = tuple(tuple(map(_with_points, row)) for row in grid.rows)
    note = Note("decimal_comma_read", message, first.whole)
    return replace(grid, rows=rows, notes=(*grid.notes, note))


def _in_thousands(cell: GridCell, number: re.Match[str]) -> GridError:
    message = say(
        "The point in `{typed}` may separate thousands, because other numbers here have a decimal "
        "comma. Write {thousands} or {number}.",
        typed=number[0],
        thousands=number[0].replace(".", ""),
        number=number[0].replace(".", ","),
    )
    return GridError("decimal_comma", message, cell.span(*number.span()))


def _numbers(text: str) -> Mapping[int, str] | None:
    # The numbers with a decimal comma outside brackets, by the place of the comma. None if another
    # comma follows a digit.
    found = {number.start() + number[0].index(","): number[0] for number in _NUMBER.finditer(text)}
    after_digit = [i for i in outside(text, ",") if text[i - 1 : i].isdigit()]
    if any(i not in found for i in after_digit):
        return None
    return {i: found[i] for i in after_digit}


def _with_points(cell: GridCell) -> GridCell:
    if "," not in cell.text or _GROUPED.search(cell.text):
        return cell
    places = _numbers(cell.text) or {}
    letters = ["." if i in places else letter for i, letter in enumerate(cell.text)]
    return replace(cell, text="".join(letters))
