"""Markdown of whoever's text: GitHub's dialect, and what others make of the same characters."""

import re
from collections.abc import Iterator, Sequence
from typing import Final

from service.formats.shared.messages import SIGNS, Message
from service.formats.shared.part_results import LONGEST, MESSAGES_TOLD, PartResult
from service.formats.shared.plain_text import code_pieces, first_lines, shortened, visible
from service.grading import RowReport

# As a character reference a character is text in every dialect, while backslashes escape more
# in one than in another. The point of `www.` and the colon of `://` make a link of what follows.
_MARKUP: Final = re.compile(
    r"[\\`*\[\]<>|~$&]|(?<!\w)_|_(?!\w)|#(?=\w)|(?<=www)\.|:(?=/)", re.IGNORECASE
)
# People and issues are looked for in the finished text; an invisible sign hides them.
_MENTION: Final = re.compile(r"@(?=\w)|&#35;(?=\d)")
_ROWS: Final = 40


def escaped(text: str) -> str:
    """The text as Markdown that says just this, within a line and within the cell of a table."""
    references = _MARKUP.sub(lambda sign: f"&#{ord(sign[0])};", visible(text))
    return _MENTION.sub(lambda sign: f"{sign[0]}&#8203;", references)


def sentence(text: str) -> str:
    """The text of a message, in which pairs of backticks mean code."""
    # Nothing is markup inside, and no backtick is left there that could end it.
    told = (f"`{piece}`" if is_code else escaped(piece) for piece, is_code in code_pieces(text))
    # Two pieces of code side by side would be one.
    return "".join(told).replace("``", "` `")


def part_details(result: PartResult) -> str:
    """The part's rows as a table with a sign for each cell, and its messages as a list."""
    report = result.report
    if report is None:
        return f"- {escaped(shortened(result.file.problem, LONGEST))}\n"
    blocks = [_table(result, report.rows)] if report.rows else []
    if items := list(first_lines(map(_item, result.messages()), MESSAGES_TOLD)):
        blocks.append("".join(f"- {item}\n" for item in items))
    return "\n".join(blocks)


def _table(result: PartResult, rows: Sequence[RowReport]) -> str:
    widest = max((row.cells for row in rows), key=len)
    head = ["row", *(cell.label for cell in widest), "points"]
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
