"""Find the table or matrix in a LaTeX, Markdown or MATLAB document.

Such a document may have other words or statements around the answer.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from html import unescape
from typing import Final

from service.grading.reading.unit_comments import comments
from service.grids import ASSIGNMENT
from service.regex import regex

_ENVIRONMENT: Final = regex(r"\\begin\{(tabular[x*]?|longtable|array|smallmatrix|[pbBvV]?matrix)\}")

_ASSIGNED: Final = regex(r"^[ \t]*([A-Za-z]\w{0,60})[ \t]*=[ \t]*\[", re.MULTILINE)

_NAME: Final = regex(r"[A-Za-z]\w*")
# An assignment to a variable, except of itself as a symbol: q1 = sym('q1').
_GIVEN: Final = regex(
    r"(?:^|[;,])[ \t]*([A-Za-z]\w{0,60})[ \t]*=(?!=)(?![ \t]*sym\(['\"]\1['\"][,)])", re.MULTILINE
)
_SEVERAL_GIVEN: Final = regex(r"\][ \t]*=(?!=)")
# An assignment to a variable or to some of its entries.
_CHANGED: Final = regex(r"\b([A-Za-z]\w{0,60})[ \t]*(?:\([^()\n]{0,80}\)[ \t]*)?=(?!=)")


def pasted_from(text: str, suffix: str) -> str:
    """Return the only table or matrix in a document with this suffix, or else the whole text.

    Empty lines before it keep the numbers of its lines, which messages name.
    """
    tables = _TABLES.get(suffix)
    if tables is None:
        return text
    found = tables(text)
    first = next(found, None)
    if first is None or next(found, None) is not None:
        return text
    last = text.find(first.rpartition("\n")[2], text.find(first.partition("\n")[0]))
    above = text.count("\n", 0, max(last, 0)) - first.count("\n")
    return "\n" * above + first


def around_table(text: str, suffix: str) -> tuple[str, ...]:
    """Return the lines of a document that are not in what ``pasted_from`` returns."""
    table = pasted_from(text, suffix).strip("\n")
    if suffix == ".m":
        said = (comment[1] for comment in comments(text))
        return tuple(each for each in said if each not in table)
    lines = "\n".join(text.splitlines()) if suffix == ".md" else text
    rest = lines.replace(table, "\n") if len(table) < len(text) else ""
    return (*filter(str.strip, rest.splitlines()), *around_rows(text))


def around_rows(page: str) -> tuple[str, ...]:
    """Return the texts around the rows of the tables in a text with HTML tags."""
    first, *rows = _ROW.split(page)
    if not rows:
        return ()
    ends = (_ROW_END.split(row, maxsplit=1)[1:] for row in rows)
    pieces = (first, *(piece for end in ends for piece in end))
    lines = (unescape(_TAG.sub(" ", line)) for piece in pieces for line in _LINE.split(piece))
    return tuple(line for line in lines if line.strip())


_ROW: Final = regex(r"<tr(?![A-Za-z0-9-])", re.IGNORECASE)
_ROW_END: Final = regex(r"</(?:tr|table)(?![A-Za-z0-9-])[^<>]{0,200}>", re.IGNORECASE)
_LINE: Final = regex(
    r"</?(?:p|div|br|li|caption|h[1-6])(?![A-Za-z0-9-])[^<>]{0,2000}>", re.IGNORECASE
)
_TAG: Final = regex(r"</?[A-Za-z][^<>]{0,2000}>")


# A line of a CSV file that is one cell in quotation marks.
_QUOTED: Final = regex(r'\s{0,9}"((?:[^"]|"")*)"\s{0,9}')


def _column(text: str) -> Iterator[str]:
    # Spreadsheets put texts in quotation marks; a single column has no commas around them.
    found = [_QUOTED.fullmatch(line) for line in text.splitlines() if line.strip()]
    if found and all(found):
        yield "\n".join(cell[1].replace('""', '"') for cell in found if cell)


def _latex(text: str) -> Iterator[str]:
    at = 0
    while opening := _ENVIRONMENT.search(text, at):
        end = f"\\end{{{opening[1]}}}"
        closing = text.find(end, opening.end())
        if closing < 0:
            return
        at = closing + len(end)
        yield text[opening.start() : at]


def _markdown(text: str) -> Iterator[str]:
    block: list[str] = []
    is_code = False
    for line in [*text.splitlines(), ""]:
        is_fence = line.lstrip().startswith(("```", "~~~"))
        if not is_fence and (is_code or "|" in line):
            block.append(line)
            continue
        # A single row below another line may belong to the table.
        if len(block) > 1 or (block and block[0].lstrip().startswith("|")):
            yield "\n".join(block)
        block = []
        is_code = is_fence and not is_code


def _matlab(text: str) -> Iterator[str]:
    matrices: list[str] = []
    at = 0
    while len(matrices) < 2 and (opening := _ASSIGNED.search(text, at)):
        before, at = opening.start(), _closing(text, opening.end())
        matrix = text[before:at]
        values = _values_given(text[:before], set(_NAME.findall(matrix)))
        if (
            at == 0
            or values is None
            or _SEVERAL_GIVEN.search(text)
            or opening[1] in _CHANGED.findall(text, at)
        ):
            # The script changes a matrix or a variable in a way that this function cannot follow.
            return
        matrices.append("\n".join([*values, *_comments_above(text[:before]), matrix]))
    yield from matrices


def _comments_above(text: str) -> list[str]:
    # The comment directly above a matrix may say the order and the units of its columns.
    lines = text.rstrip("\r\n").splitlines()
    first = len(lines)
    while first and lines[first - 1].lstrip().startswith("%"):
        first -= 1
    return lines[first:]


def _values_given(text: str, letters: set[str]) -> list[str] | None:
    found = []
    for given in _GIVEN.finditer(text):
        if given[1] in letters:
            assignment = ASSIGNMENT.match(text, given.start(1))
            if assignment is None:
                return None
            found.append(assignment["line"].rstrip())
    return found


def _closing(text: str, start: int) -> int:
    depth = 1
    for bracket in re.finditer(r"[\[\]]", text[start:]):
        depth += 1 if bracket[0] == "[" else -1
        if depth == 0:
            return start + bracket.end()
    return 0


_TABLES: Final[Mapping[str, Callable[[str], Iterator[str]]]] = {
    ".csv": _column,
    ".tsv": _column,
    ".tex": _latex,
    ".md": _markdown,
    ".m": _matlab,
}
