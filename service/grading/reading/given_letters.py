"""Replace letters by the numbers that a script gives them, as in ``d1 = 0.1625``."""

# The numbers count only if the exercise has no lengths as letters; otherwise letters are its
# symbols.

from dataclasses import replace
from itertools import islice
from typing import Final

from service.expressions.errors import Note
from service.grading.reading.entry import Reader
from service.grading.reading.tables.column_headers import read_header
from service.grids import Grid, GridCell, without_tuples
from service.grids.cutting.source_text import joined
from service.regex import regex
from service.translations import say

_NUMBER: Final = regex(
    r"(?:^|[;,\n])[ \t]*([A-Za-z]\w{0,20})[ \t]*=[ \t]*([-+]?(?:\d{1,9}\.?\d{0,12}|\.\d{1,12}))"
    r"[ \t\r]*(?=[;,\n%#]|\Z)"
)
_ASSIGNED: Final = regex(r"(?<![\w.])(\w{1,21})[ \t]{0,40}[-+*/]?=(?!=)")
# The last letter of an assignment to several letters, whose value may be another number.
_LAST: Final = regex(r"(?<![\w.])[A-Za-z]\w{0,20}\s{0,9},\s{0,9}([A-Za-z]\w{0,20})\s{0,9}=(?!=)")
# A letter in a value. The z of the cell ``z = 0`` is the name of a value in a list.
_NAME: Final = regex(r"(?<![\w.\\])[A-Za-z]\w*(?![\w(\[]|[ \t]*=(?!=))")
_MOST: Final = 40


def with_given_letters(grid: Grid, text: str, reader: Reader) -> Grid:
    """Replace letters that a text defines by their numbers; return the grid and a note."""
    given = _given(text, reader)
    used: dict[str, None] = {}
    rows = tuple(tuple(_cell(cell, given, used) for cell in row) for row in grid.rows)
    if not used:
        return grid
    message = say(
        "The numbers that the text gives to {letters} were used.", letters=", ".join(used)
    )
    notes = [note for note in grid.notes if note.code != "given_numbers"]
    return replace(grid, rows=rows, notes=(*notes, Note("used_numbers", message, (0, len(text)))))


def _given(text: str, reader: Reader) -> dict[str, str]:
    # Letters that the text sets once and the exercise does not know.
    slides = reader.vocabulary.sliding.values()
    if any(each.kind == "length" and each not in slides for each in reader.vocabulary.symbols):
        return {}
    text = without_tuples(text)
    names = _ASSIGNED.findall(text) + _LAST.findall(text)
    return {
        each[1]: each[2]
        for each in islice(_NUMBER.finditer(text), _MOST)
        if names.count(each[1]) == 1 and not reader.read(each[1], "number").readable
    }


def _cell(cell: GridCell, given: dict[str, str], used: dict[str, None]) -> GridCell:
    names = [name for name in _NAME.finditer(cell.text) if name[0] in given]
    if not names or read_header(cell.text):
        return cell
    pieces, start = [], 0
    for name in names:
        used[name[0]] = None
        value = given[name[0]] if name[0] == cell.text else f"({given[name[0]]})"
        pieces += [cell.cut(start, name.start()), cell.cut(*name.span()).spelled(value)]
        start = name.end()
    return joined([*pieces, cell.cut(start, len(cell.text))], cell.at)
