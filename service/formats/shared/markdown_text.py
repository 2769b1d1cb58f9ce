"""Untrusted texts as GitHub's Markdown, which is also safe in similar kinds of Markdown."""

import re
from collections.abc import Iterator, Sequence
from typing import Final

from service.formats.shared.messages import POINTS, ROW, SIGNS, Message
from service.formats.shared.part_results import LONGEST, MESSAGES_TOLD, PartResult
from service.formats.shared.plain_text import code_pieces, first_lines, shortened, visible
from service.grading import RowReport
from service.regex import regex
from service.translations import told

# A character reference is plain text in every dialect; backslashes escape different characters in
# different dialects. The point of `www.` and the colon of `://` would start a link.
_MARKUP: Final = regex(
    r"[\\`*\[\]<>|~$&]|(?<!\w)_|_(?!\w)|#(?=\w)|(?<=www)\.|:(?=/)", re.IGNORECASE
)
# GitHub looks for mentions and issues in the rendered text. An invisible character hides them.
_MENTION: Final = regex(r"@(?=\w)|&#35;(?=\d)")
_ROWS: Final = 40


def escaped(text: str) -> str:
    """Return Markdown that shows exactly this text, in a line or in the cell of a table."""
    references = _MARKUP.sub(lambda sign: f"&#{ord(sign[0])};", visible(text))
    return _MENTION.sub(lambda sign: f"{sign[0]}&#8203;", references)


def sentence(text: str) -> str:
    """Return the text of a message as Markdown; text between backticks becomes code."""
    # Code contains no markup, and no backtick that could end it early.
    told = (f"`{piece}`" if is_code else escaped(piece) for piece, is_code in code_pieces(text))
    # Separate two adjacent pieces of code, which would be read as one.
    return "".join(told).replace("``", "` `")


def part_details(result: PartResult) -> str:
    """Return a part as Markdown: a table with a sign for each cell, and a list of messages."""
    report, translation = result.report, result.language.translation
    if report is None:
        return f"- {escaped(shortened(result.file.problem, LONGEST))}\n"
    blocks = [_table(result, report.rows)] if report.rows else []
    items = list(first_lines(map(_item, result.messages()), MESSAGES_TOLD, translation))
    if items := [*items, *map(escaped, result.marks())]:
        blocks.append("".join(f"- {item}\n" for item in items))
    return "\n".join(blocks)


def _table(result: PartResult, rows: Sequence[RowReport]) -> str:
    widest = max((row.cells for row in rows), key=len)
    translation = result.language.translation
    row_head, points_head = told(ROW, translation), told(POINTS, translation)
    head = [row_head, *(cell.label for cell in widest), points_head]
    lines = [_line(head), "|---|" + ":-:|" * len(widest) + "--:|\n"]
    for row in rows[:_ROWS]:
        signs = [SIGNS[cell.verdict] for cell in row.cells]
        blanks = [""] * (len(widest) - len(signs))
        lines.append(_line([row.label, *signs, *blanks, result.row_points(row)]))
    if len(rows) > _ROWS:
        lines.append(_line(["…", *[""] * (len(widest) + 1)]))
    return "".join(lines)


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(map(escaped, cells))} |\n"


def _item(message: Message) -> str:
    pieces = _pieces(message)
    return " ".join(filter(None, pieces))


def _pieces(message: Message) -> Iterator[str]:
    yield message.label
    yield f"**{escaped(message.places)}:**" if message.places else ""
    yield sentence(shortened(message.text, LONGEST))
    yield escaped(shortened(message.offers, LONGEST))
    yield escaped(shortened(message.example, LONGEST))
