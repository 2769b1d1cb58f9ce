"""A piece of text that knows where its characters were typed, cut into cells and pairs.

It has the grid, the limits on its size, and the protocol of all formats. It knows no format.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from functools import cache, wraps
from html import unescape
from itertools import chain, pairwise
from typing import Any, Final, ParamSpec, TypeVar

from dh_grader.expressions.errors import Note, Span, TextError
from dh_grader.expressions.vocabulary import SPELLINGS
from dh_grader.regex import regex
from dh_grader.slices import checkpoint
from dh_grader.translations import say

# --- A piece of text that knows where each of its characters was typed


_LINE_END: Final = regex("\r\n|[\r\n\x85\u2028\u2029]")


@dataclass(frozen=True, slots=True)
class SourceText:
    """A piece of text, and the position [start, end) of each character in the typed text.

    ``at`` is the position of an empty piece. ``typed`` is the whole typed text.
    """

    text: str
    starts: Sequence[int]
    ends: Sequence[int]
    at: int = 0
    typed: str = ""

    @staticmethod
    def of(source: str) -> "SourceText":
        """Return the whole ``source`` as a piece."""
        return SourceText(source, range(len(source)), range(1, len(source) + 1), typed=source)

    def cut(self, start: int, end: int) -> "SourceText":
        """Return the characters [start, end) as a piece."""
        if start == 0 and end == len(self.text):
            return self
        return SourceText(
            self.text[start:end],
            self.starts[start:end],
            self.ends[start:end],
            self.span(start)[0],
            self.typed,
        )

    def span(self, start: int = 0, end: int | None = None) -> Span:
        """Return where the characters [start, end) are in the typed text."""
        length = len(self.text)
        start = min(max(start, 0), length)
        stop = start if end is None else min(max(end, start), length)
        if start < stop:
            return self.starts[start], self.ends[stop - 1]
        if start < length:
            return self.starts[start], self.starts[start]
        at = self.ends[-1] if length else self.at
        return at, at

    @property
    def whole(self) -> Span:
        """The position of the piece in the typed text."""
        return self.span(0, len(self.text))

    @property
    def line_number(self) -> int:
        """The number of the line of the typed text in which the piece begins, as editors count."""
        return line_number(self.typed, self.whole[0])

    def strip(self, letters: str | None = None) -> "SourceText":
        """Return the piece without blanks (or ``letters``) at either end."""
        left = len(self.text) - len(self.text.lstrip(letters))
        return self.cut(left, max(left, len(self.text.rstrip(letters))))

    def lines(self) -> list["SourceText"]:
        """Return the lines without their line ends."""
        return self.split(_LINE_END)

    def split(self, separator: re.Pattern[str]) -> list["SourceText"]:
        """Return the pieces before, between and after all matches of ``separator``."""
        pieces, start = [], 0
        for match in separator.finditer(self.text):
            pieces.append(self.cut(start, match.start()))
            start = match.end()
        return [*pieces, self.cut(start, len(self.text))]

    def cut_at(self, places: Iterable[int]) -> list["SourceText"]:
        """Return the pieces before, between and after the characters at these places."""
        return [self.cut(a + 1, b) for a, b in pairwise([-1, *places, len(self.text)])]

    def replaced(
        self,
        pattern: re.Pattern[str],
        by: Callable[["SourceText", re.Match[str]], Sequence["SourceText"] | None],
    ) -> "SourceText":
        """Return the piece with each match of ``pattern`` replaced by other pieces.

        ``by`` gets this piece and the match. The match stays if ``by`` returns None.
        """
        pieces: list[SourceText] = []
        start = 0
        for found in pattern.finditer(self.text):
            instead = by(self, found)
            if instead is not None:
                pieces += [self.cut(start, found.start()), *instead]
                start = found.end()
        if not pieces:
            return self
        return joined([*pieces, self.cut(start, len(self.text))], self.whole[0])

    def spelled(self, text: str) -> "SourceText":
        """Return a piece with this ``text``; each character has the place of this whole piece."""
        start, end = self.whole
        return SourceText(text, (start,) * len(text), (end,) * len(text), start, self.typed)


def line_number(typed: str, place: int) -> int:
    """Return the number of the line with the character ``place``. The first line is 1."""
    return 1 + sum(1 for _ in _LINE_END.finditer(typed, 0, place))


def joined(pieces: Iterable[SourceText], at: int) -> SourceText:
    """Join the pieces into one. ``at`` is the position of an empty result."""
    kept = [piece for piece in pieces if piece.text]
    if len(kept) == 1:
        return kept[0]
    return SourceText(
        "".join(piece.text for piece in kept),
        [*chain.from_iterable(piece.starts for piece in kept)],
        [*chain.from_iterable(piece.ends for piece in kept)],
        at,
        kept[0].typed if kept else "",
    )


# --- The limits on the size of a pasted text


@dataclass(frozen=True, slots=True)
class GridLimits:
    """Limits for one pasted text."""

    # ``rows`` allows twelve rows and a header, ``matrices`` the halves of twelve screw axes.
    # ``separators`` bounds the number of commas, bars, tabs, line ends and the like in the text,
    # including those between empty cells of a spreadsheet. The length of a cell is bounded by the
    # reader of expressions.

    characters: int = 26 * 1024
    rows: int = 13
    columns: int = 12
    matrices: int = 24
    separators: int = 1024


GRID_LIMITS = GridLimits()


# --- The grid that is read from a pasted text, and the protocol of all formats


# The vertical bars between the cells of a line.
BARS: Final = "|│┃║"
GridCell = SourceText
# Quotation marks of word processors around a whole cell.
_QUOTED: Final = regex(r"„[^„“”]+[“”]|“[^“”]+”|«[^«»]+»|»[^«»]+«")
# The remark that a value is the variable of its joint.
_VARIABLE: Final = regex(r"\s*[(\[](?:joint )?(?:variable|var\.?)[)\]]$", re.IGNORECASE)
_NUMBER: Final = regex(r"\d{1,2}\Z")
Rows = Sequence[Sequence[GridCell]]


class GridError(TextError):
    """The pasted text is not exactly one table or matrix. ``span`` is the place of the problem."""


@dataclass(frozen=True, slots=True)
class Grid:
    """Rows of cells; the rows may differ in length. ``format`` is the name of the text's format."""

    format: str
    rows: tuple[tuple[GridCell, ...], ...]
    notes: tuple[Note, ...] = ()
    # The empty rows with separators, each with the number of rows above it.
    empty: tuple[tuple[int, tuple[GridCell, ...]], ...] = ()

    def with_empty_rows(self, most: int) -> "Grid":
        """Return the grid with its empty rows, if it then has at most ``most`` rows.

        Otherwise the empty rows are only layout.
        """
        width = max(map(len, self.rows))
        fits = len(self.rows) + len(self.empty) <= most
        if not self.empty or not fits or any(len(row) < width for _, row in self.empty):
            return self
        rows = list(self.rows)
        for above, row in reversed(self.empty):
            rows.insert(above, row[:width])
        return replace(self, rows=tuple(rows), empty=())

    def without_half_row(self, fewest: int) -> "Grid":
        """Return the grid without a last row that was only begun, if ``fewest`` others remain.

        Such a row has only its number, and no other value.
        """
        *others, last = self.rows
        begun = [cell.text for cell in last if cell.text]
        is_short = len(last) < max(map(len, self.rows)) and last[0].text in begun
        if len(others) < fewest or not is_short or len(begun) != 1 or not _NUMBER.match(begun[0]):
            return self
        note = Note(
            "text_left_aside", say("The last row has only a number and was ignored."), last[0].whole
        )
        return replace(self, rows=tuple(others), notes=(*self.notes, note))

    @property
    def size(self) -> str:
        """The size as text: ``4 × 4``, or ``3 × 2 to 4`` if the rows differ in length."""
        shortest, longest = min(map(len, self.rows)), max(map(len, self.rows))
        if shortest == longest:
            return f"{len(self.rows)} × {longest}"
        # Translators: the size of a matrix whose rows have different lengths.
        return say(
            "{rows} × {shortest} to {longest}",
            rows=len(self.rows),
            shortest=shortest,
            longest=longest,
        )


@dataclass(frozen=True, slots=True)
class GridFormat:
    """One way to write a grid.

    ``matches`` returns True if a text seems to be in this format, and never raises. ``parse`` reads
    the text, or raises GridError. Both take linear time.
    """

    matches: Callable[[str], bool]
    parse: Callable[[SourceText], Grid]


@dataclass(frozen=True, slots=True)
class RobotTable:
    """The DH table of a robot, and the convention that the script names: standard or modified.

    With ``has_headers``, the first row contains headers. Otherwise the columns are a, α, d, θ.
    """

    grid: Grid
    convention: str | None = None
    has_headers: bool = False


def too_many_matrices(whole: Span) -> GridError:
    """Return the error for a text with too many matrices."""
    most = GRID_LIMITS.matrices
    message = say("A pasted text has at most {most} matrices; yours has more.", most=most)
    return GridError("too_many_matrices", message, whole)


def too_many_rows(whole: Span, found: int | None = None) -> GridError:
    """Return the error for a table with too many rows; ``found`` is their number, if known."""
    most = GRID_LIMITS.rows - 1
    if found is None:
        message = say("A table has at most {most} rows below a header; yours has more.", most=most)
    else:
        message = say(
            "A table has at most {most} rows below a header; yours has {found} in all.",
            most=most,
            found=found,
        )
    return GridError("too_many_rows", message, whole)


def too_many_cells(whole: Span) -> GridError:
    """Return the error for a text with too many separators."""
    message = say(
        "This has more than {most:,} commas, tabs, bars and line ends; "
        "paste only the table or matrix.",
        most=GRID_LIMITS.separators,
    )
    return GridError("too_many_cells", message, whole)


def grid(name: str, rows: Rows, whole: Span, notes: Iterable[Note] = ()) -> Grid:
    """Return a grid of these rows, without empty rows and empty outer columns.

    Raises GridError if all cells are empty or the grid is too large.
    """
    tidied = [[tidy(cell) for cell in row] for row in rows]
    filled: list[list[GridCell]] = []
    empty: list[tuple[int, tuple[GridCell, ...]]] = []
    for row in tidied:
        if any(cell.text for cell in row):
            filled.append(row)
        elif len(row) > 1:
            empty.append((len(filled), tuple(row)))
    if not filled:
        raise GridError("empty", say("All cells of this table or matrix are empty."), whole)
    filled = _without_empty_columns(filled)
    if len(filled) > GRID_LIMITS.rows:
        raise too_many_rows(whole, len(filled))
    widest = max(map(len, filled))
    if widest > GRID_LIMITS.columns:
        message = say(
            "A table has at most {most} columns; yours has {found}.",
            most=GRID_LIMITS.columns,
            found=widest,
        )
        raise GridError("too_many_columns", message, whole)
    return Grid(name, tuple(map(tuple, filled)), tuple(notes), tuple(empty))


def tidy(cell: GridCell) -> GridCell:
    """Return the cell without outer blanks and style marks: $…$, `…`, „…“."""
    cell = cell.strip()
    if _QUOTED.fullmatch(cell.text):
        cell = cell.cut(1, len(cell.text) - 1).strip()
    for mark in ("`", "**"):
        if len(cell.text) > 2 * len(mark) and cell.text.startswith(mark):
            inner = cell.cut(len(mark), len(cell.text) - len(mark))
            if cell.text.endswith(mark) and mark not in inner.text:
                cell = inner.strip()
    if "$" in cell.text and cell.text.count("$") % 2 == 0 and "\\$" not in cell.text:
        # Replace each $ by a blank, so that $a$$b$ does not become one name.
        cell = replace(cell, text=cell.text.replace("$", " ")).strip()
    if variable := _VARIABLE.search(cell.text[-20:]):
        cell = cell.cut(0, len(cell.text) - len(variable[0]))
    if cell.text.startswith("\\(") and cell.text.endswith("\\)"):
        cell = cell.cut(2, len(cell.text) - 2).strip()
    return cell


def _without_empty_columns(rows: list[list[GridCell]]) -> list[list[GridCell]]:
    while all(row and not row[-1].text for row in rows if len(row) == max(map(len, rows))):
        widest = max(map(len, rows))
        rows = [row[:-1] if len(row) == widest else row for row in rows]
    while len({len(row) for row in rows}) == 1 and not any(row[0].text for row in rows):
        rows = [row[1:] for row in rows]
    return rows


# --- Search a pasted text for the same thing only once, though several formats ask for it


P = ParamSpec("P")
R = TypeVar("R")

# To search a shorter text again costs no more than to remember what was found.
_WORTH_IT: Final = 200

# What was found in each text, while pasted texts are read.
_found: ContextVar[dict[tuple[object, str], Any] | None] = ContextVar("found", default=None)


@contextmanager
def remembering(found: dict[tuple[object, str], Any]) -> Iterator[None]:
    """Let each search ``once`` remember in ``found`` what it finds."""
    token = _found.set(found)
    try:
        yield
    finally:
        _found.reset(token)


def remembers(read: Callable[P, R]) -> Callable[P, R]:
    """Let a function that reads a pasted text make each search ``once``."""

    @wraps(read)
    def reads(*args: P.args, **named: P.kwargs) -> R:
        if _found.get() is not None:
            return read(*args, **named)
        with remembering({}):
            return read(*args, **named)

    return reads


def once(search: Callable[[str], R]) -> Callable[[str], R]:
    """Let a search remember what it finds in each text, until the pasted texts are read.

    The search takes linear time and gives way before it begins. Nobody may change its result.
    """

    @wraps(search)
    def searches(text: str) -> R:
        checkpoint()
        found = _found.get()
        if found is None or len(text) < _WORTH_IT:
            return search(text)
        key = search, text
        if key not in found:
            found[key] = search(text)
        result: R = found[key]
        return result

    return searches


# --- Find pairs of brackets and quotes. A separator inside a pair does not split a cell


Ends = Mapping[int, int]

CLOSES: Final = {"[": "]", "(": ")", "{": "}"}
_OPENS: Final = {closer: opener for opener, closer in CLOSES.items()}
_STRINGS: Final = {quote: regex(rf"{quote}(?:[^\\{quote}\n]|\\.)*{quote}") for quote in ("'", '"')}
BRACKET: Final = regex(r"[][(){}]")
_BRACKET_OR_LINE_END: Final = regex(r"[][(){}\n]")
_BRACKET_OR_QUOTE: Final = regex(r"""[][(){}'"]""")


@dataclass(frozen=True, slots=True)
class _Fault:
    """The place of a bracket or quotation mark without a partner."""

    # ``opened`` is the place of the innermost open bracket, or -1.
    at: int
    opened: int = -1
    is_quote: bool = False


@once
def pairs(text: str) -> Ends:
    """Map each opening bracket's position to the position after its partner on the same line.

    Brackets without a partner are left out.
    """
    found: dict[int, int] = {}
    stack: list[int] = []
    for sign in _BRACKET_OR_LINE_END.finditer(text):
        i, letter = sign.start(), sign[0]
        if letter in CLOSES:
            stack.append(i)
        elif letter in _OPENS:
            if stack and text[stack[-1]] == _OPENS[letter]:
                found[stack.pop()] = i + 1
        else:
            stack.clear()
    return found


def strict_pairs(source: SourceText) -> Ends:
    """Map the start of each bracket pair or string to the position after its end.

    Raises GridError for a bracket without a partner, or for a string without an end.
    """
    found = _strict(source.text)
    if isinstance(found, _Fault):
        raise _error(source, found)
    return found


@once
def _strict(text: str) -> Ends | _Fault:
    found: dict[int, int] = {}
    stack: list[int] = []
    at = 0
    for sign in _BRACKET_OR_QUOTE.finditer(text):
        i, letter = sign.start(), sign[0]
        if i < at:
            continue
        # After an operand, ' is a transpose and does not begin a string.
        if letter in CLOSES:
            stack.append(i)
        elif letter in _OPENS:
            if not stack or text[stack[-1]] != _OPENS[letter]:
                return _Fault(i, stack[-1] if stack else -1)
            found[stack.pop()] = i + 1
        elif i == 0 or text[i - 1].isspace() or text[i - 1] in "[({,;:=":
            string = _STRINGS[letter].match(text, i)
            if string is None:
                return _Fault(i, is_quote=True)
            found[i] = at = string.end()
    return _Fault(stack[-1]) if stack else found


def _error(source: SourceText, fault: _Fault) -> GridError:
    if not fault.is_quote:
        return _unbalanced(source, fault)
    message = say("This text has no quotation mark at its end. Add it, or delete this one.")
    return GridError("unclosed_quote", message, source.span(fault.at, fault.at + 1))


def _unbalanced(source: SourceText, fault: _Fault) -> GridError:
    at = fault.at
    bracket = source.text[at]
    if bracket in CLOSES:
        message = say(
            "This {bracket} is never closed; {partner} is missing.",
            bracket=bracket,
            partner=CLOSES[bracket],
        )
    elif fault.opened >= 0:
        open_one = source.text[fault.opened]
        message = say(
            "This {bracket} does not fit the {opening} at character {place}; "
            "{wanted} was expected.",
            bracket=bracket,
            opening=open_one,
            place=source.span(fault.opened)[0] + 1,
            wanted=CLOSES[open_one],
        )
    else:
        message = say(
            "This {bracket} was never opened; {partner} is missing.",
            bracket=bracket,
            partner=_OPENS[bracket],
        )
    return GridError("unbalanced_bracket", message, source.span(at, at + 1))


def outside(text: str, signs: str) -> Iterator[int]:
    """Yield the positions of the characters ``signs`` outside all pairs of brackets on a line."""
    # ``signs`` are written as in a class of a regular expression, such as r",\s".
    ends, at = pairs(text), 0
    for sign in _sign(signs).finditer(text):
        i = sign.start()
        if i < at:
            continue
        if sign[0] in CLOSES:
            at = ends.get(i, i)
        else:
            yield i


@cache
def _sign(signs: str) -> re.Pattern[str]:
    return re.compile(rf"[{signs}\[({{]")


def split(source: SourceText, separators: str) -> list[SourceText]:
    """Split a text at these separators, but not inside brackets and quotes.

    Raises GridError for a bracket or a quotation mark without a partner, and for too many pieces.
    """
    text, ends = source.text, strict_pairs(source)
    places, at = [], 0
    for found in _sign(re.escape(separators) + "'\"").finditer(text):
        i = found.start()
        if i < at:
            continue
        at = ends.get(i, i + 1)
        if found[0] in separators:
            places.append(i)
    if len(places) > GRID_LIMITS.separators:
        # Most of them are the commas of LaTeX's thin spaces.
        raise too_many_cells(source.whole)
    return source.cut_at(places)


# --- Split a row into elements at blanks, by MATLAB's rule for square brackets
#
# A sign with a blank before it but not after it begins a new element: ``[c1 -s1]`` has two
# elements, ``[c1 - s1]`` has one.


_SIGNS: Final = "+-−–"
_BINARY: Final = "*/^×·⋅∙∗•÷="
_UNIT: Final = regex(r"(?:deg|degrees?|rad|radians?)(?![A-Za-z0-9])|[°º˚]", re.IGNORECASE)
# A function's name alone is not an element, so the blank after it separates nothing.
_FUNCTION: Final = regex(rf"(?<![A-Za-z])(?:{'|'.join(SPELLINGS)})(?:(?:\^|\*\*)\d+)?$")
# The number of characters at the end of an element that decide whether it continues.
_DECISIVE: Final = 16
# The rest of a longer row stays in one piece.
_MAX_ELEMENTS: Final = 2 * GRID_LIMITS.columns


@dataclass(frozen=True, slots=True)
class BlankSeparated:
    """The elements of a row.

    ``signs`` are the words, such as -s1, that are separate elements only because of their sign.
    """

    elements: tuple[SourceText, ...]
    signs: tuple[SourceText, ...]


def split_blanks(row: SourceText) -> BlankSeparated:
    """Split a row into elements by MATLAB's rule for blanks; brackets stay in one piece."""
    words = _words(row.text)
    start, end = next(words, (0, 0))
    if not end:
        return BlankSeparated((), ())
    elements: list[SourceText] = []
    signs: list[SourceText] = []
    for next_start, next_end in words:
        if len(elements) == _MAX_ELEMENTS:
            end = len(row.text.rstrip())
            break
        left, right = row.text[max(start, end - _DECISIVE) : end], row.text[next_start:next_end]
        if not continues(left, right):
            elements.append(row.cut(start, end))
            if right[0] in _SIGNS:
                signs.append(row.cut(next_start, next_end))
            start = next_start
        end = next_end
    elements.append(row.cut(start, end))
    return BlankSeparated(tuple(elements), tuple(signs))


def continues(left: str, right: str) -> bool:
    """True if ``left`` and ``right``, with a blank between them, are parts of one element."""
    if left[-1] == "*" and left[-2:-1].strip(" \t\r\n.*"):
        # ``d3* 0`` is a joint variable marked by a star, and a zero; it is not a product.
        return False
    if left[-1] in _SIGNS or left[-1] in _BINARY:
        return True
    if right[0] in _SIGNS:
        return len(right) == 1
    if right[0] in _BINARY or right[:2] in {".*", "./", ".^"} or _UNIT.match(right):
        return True
    return _FUNCTION.search(left) is not None


def _words(text: str) -> Iterator[tuple[int, int]]:
    for a, b in pairwise(chain([-1], outside(text, r"\s"), [len(text)])):
        if a + 1 < b:
            yield a + 1, b


# --- Remove a separator after the last cell of a row, which separates nothing


_SEPARATORS: Final = "\t;,"
_LAST_SEPARATOR: Final = regex(r"[\t;,](?=[ \t]*(?:[\r\n\x85\u2028\u2029]|\Z))")
# A list of values in lines has fewer values in a line than the smallest matrix.
_FEWEST_CELLS: Final = 3


def without_last_signs(source: SourceText) -> SourceText:
    """Return the text without the tabs, semicolons or commas that are only at the ends of lines.

    A sign stays if it may separate cells or if the text has no other separators.
    """
    for sign in _SEPARATORS:
        ends = [end for end in _LAST_SEPARATOR.finditer(source.text) if end[0] == sign]
        if ends and len(ends) == source.text.count(sign):
            pieces = list(_without(source, ends))
            rest = joined(pieces, source.at)
            if _has_cells(rest, sign):
                source = rest
    return source


def _without(source: SourceText, ends: list[re.Match[str]]) -> Iterator[SourceText]:
    start = 0
    for end in ends:
        yield source.cut(start, end.start())
        start = end.end()
    yield source.cut(start, len(source.text))


def _has_cells(rest: SourceText, sign: str) -> bool:
    lines = [line.strip() for line in rest.lines() if line.text.strip()]
    if any(
        other != sign and any(other in line.text for line in lines) for other in _SEPARATORS + BARS
    ):
        return True
    # MATLAB's rows in lines that end with semicolons have their own format.
    counts = {len(split_blanks(line).elements) for line in lines} if sign != ";" else {0}
    return len(counts) == 1 and min(counts) >= _FEWEST_CELLS


# --- Tags and entities of HTML in a cell of Markdown: ``&theta;<sub>1</sub>`` is ``θ_{1}``


_MARKUP: Final = regex(
    r"<(?P<tag>su[bp])>(?P<inner>[^<>|]{1,20})</(?P=tag)>"
    r"|&(?:#\d{1,6}|#x[0-9a-f]{1,5}|[a-z]{1,12});",
    re.IGNORECASE,
)
_DEGREES: Final = frozenset({"o", "0", "°", "º"})


def without_tags(cell: SourceText) -> SourceText:
    """Return the cell with its tags and entities replaced by plain characters."""
    if "<" not in cell.text and "&" not in cell.text:
        return cell
    return cell.replaced(_MARKUP, _plain)


def _plain(cell: SourceText, found: re.Match[str]) -> list[SourceText]:
    inner = unescape(found["inner"] or "").strip()
    if not found["tag"]:
        text = unescape(found[0])
    elif found["tag"].lower() == "sub":
        text = f"_{{{inner}}}"
    elif inner in _DEGREES:
        text = "°"
    else:
        text = inner if inner == "*" else f"^({inner})"
    return [cell.cut(*found.span()).spelled(text)]
