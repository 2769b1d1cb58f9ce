"""Lines of comma-separated values (RFC 4180) in UTF-8 that no spreadsheet takes for formulas."""

import csv
import io
from collections.abc import Iterable
from typing import Final

from service.formats.shared.plain_text import visible

# A cell that begins so is run as a formula by one spreadsheet or another (OWASP, "CSV Injection").
_FORMULA_SIGNS: Final = ("=", "+", "-", "@", "＝", "＋", "－", "＠")

# The headings of a list of grades, as Moodle names them.
GRADEBOOK_HEAD: Final = ("Identifier", "Grade", "Maximum Grade", "Feedback comments")


def line(cells: Iterable[str | float | None]) -> bytes:
    """One line. Texts are visible ones, those that look like formulas behind an apostrophe."""
    written = io.StringIO(newline="")
    csv.writer(written, lineterminator="\r\n").writerow([_cell(cell) for cell in cells])
    return written.getvalue().encode()


def _cell(value: str | float | None) -> str:
    if value is None:
        return ""
    if not isinstance(value, str):
        return f"{value:.6f}".rstrip("0").rstrip(".")
    text = visible(value)
    return f"'{text}" if text.lstrip().startswith(_FORMULA_SIGNS) else text
