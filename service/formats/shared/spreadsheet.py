"""Lines of comma-separated values (RFC 4180, UTF-8) that no spreadsheet reads as formulas."""

import csv
import io
from collections.abc import Iterable
from typing import Final

from service.formats.shared.plain_text import number, visible
from service.regex import regex

# Some spreadsheets run a cell with such a beginning as a formula (OWASP, "CSV Injection"). Where a
# comma is the decimal sign, they also end a cell at a semicolon, whatever quotes are around it.
_FORMULA: Final = regex(r"""(?:^|(?<=;))(?=[\s"]*[=+\-@＝＋－＠])""")

# The headings of a list of grades, as Moodle names them.
GRADEBOOK_HEAD: Final = ("Identifier", "Grade", "Maximum Grade", "Feedback comments")


def line(cells: Iterable[str | float | None]) -> bytes:
    """Return one line of cells; a text that looks like a formula gets a leading apostrophe."""
    written = io.StringIO(newline="")
    csv.writer(written, lineterminator="\r\n").writerow([_cell(cell) for cell in cells])
    return written.getvalue().encode()


def _cell(value: str | float | None) -> str:
    if value is None:
        return ""
    return without_formulas(value) if isinstance(value, str) else number(value)


def without_formulas(text: str) -> str:
    """Return the text in one line, with an apostrophe before all that looks like a formula."""
    return _FORMULA.sub("'", visible(text))
