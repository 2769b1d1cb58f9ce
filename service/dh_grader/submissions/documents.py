"""The table or matrix in a LaTeX, Markdown or MATLAB document or a notebook, and its remarks."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from html import unescape
from itertools import zip_longest
from typing import Any, Final
from xml.etree import ElementTree as ET

from dh_grader.grading.reading.entries import comments, is_beside_code, units_in
from dh_grader.grading.reading.headers import (
    LABEL,
    METRES,
    QUANTITIES,
    THETA_OFFSET,
    Header,
    read_header,
)
from dh_grader.pasting import ASSIGNMENT, GridError, read_grid, read_robot
from dh_grader.pasting.around import UNIT, is_sentence, names_unit
from dh_grader.pasting.remarks import Claim, claims, contradicts, may_change
from dh_grader.pasting.uses import changing_statement
from dh_grader.regex import regex
from dh_grader.submissions.bodies import MalformedError, read_json
from dh_grader.translations import say


class UnusableFileError(Exception):
    """The file has no usable submission; the message says why."""


@dataclass(frozen=True, slots=True)
class Excerpt:
    """A piece of a file that may be the answer to a part.

    ``name`` is the name of a sheet, or empty. An excerpt of a higher ``level`` counts only if none
    of a lower level can be read. ``around`` are the lines and cells around it, and ``beside`` the
    remarks on its cells. ``changed`` is a later statement that changes it, or empty.
    """

    text: str
    name: str = ""
    level: int = 0
    around: tuple[str, ...] = ()
    beside: tuple[str, ...] = ()
    changed: str = ""


# --- Find the table or matrix in a LaTeX, Markdown or MATLAB document
#
# Such a document may have other words or statements around the answer.


# --- Find the sentence beside a table in a document that may change the meaning of the table
#
# A document has other lines, cells, paragraphs and comments around the table or matrix, which no
# reader of tables sees. One of them may say "All angles are in degrees", or "Row 4 is wrong".


_LONGEST: Final = 160
_SENTENCE_END: Final = regex(r"(?<=[.!?])\s+(?=[A-ZÄÖÜÉ¿])|(?<=[。！？；])")
# A command of LaTeX and its package options, after a degree sign was found.
_CIRCLE: Final = regex(r"\\(?:circ|degree)(?![A-Za-z])")
_COMMAND: Final = regex(r"\\(?:documentclass|usepackage)\s?(?:\[[^][]{0,200}\])?|\\[A-Za-z]{1,30}")
# A unit after a number belongs to this number.
_MEASURED: Final = regex(
    rf"(?<![\w.,])\d{{1,9}}(?:[.,]\d{{1,9}})?(?:[ \t~$^{{}}-]{{0,4}})(?:{UNIT.pattern})",
    UNIT.flags,
)
_ANGLES: Final = regex(
    r"(?<![^\W\d_])(?:deg(?:rees?)?|degrés?|grad|grados?|gradi)(?![^\W\d_])|°|度", UNIT.flags
)
_RADIANS: Final = regex(
    r"(?<![^\W\d_])(?:rad(?:ian\w{0,4})?|bogenma(?:ß|ss))(?![^\W\d_])|弧度", UNIT.flags
)
_METRES: Final = regex(r"(?<!\w)(?:in|en) m(?!\w)", UNIT.flags)
_CHINESE: Final = {"毫米": 0.001, "厘米": 0.01, "米": 1.0}
_NUMBER: Final = regex(r"(?<![\w.,])(\d{1,12}(?:[.,]\d{1,12})?)(?![\w.,])")
_CONVERTED: Final = regex(r"(?<![^\W\d_])(?:pi|deg2rad|radians)(?![^\W\d_])|π", UNIT.flags)
_SEPARATORS: Final = regex(r"[,;&|\t\n\[\](){}=]|\\\\")
# A smaller number may be a factor.
_LARGEST_FACTOR: Final = 2
_FEWEST_HEADERS: Final = 2


def changing_remark(
    text: str, around: Iterable[str], length_unit: str | None, beside: Iterable[str] = ()
) -> str:
    """Return the first sentence around a table or matrix that may change its meaning, or "".

    ``length_unit`` is the unit of the lengths in the exercise, or None if it is not known.
    ``beside`` are remarks on cells, such as the comments of a spreadsheet.
    """
    table = _Table.of(text)
    beside = tuple(beside)
    for sentence in _remarks_sentences((*around, *beside)):
        if _changes(sentence, table) or _gives_unit(sentence, table, length_unit):
            return sentence
    for sentence in _remarks_sentences((*_said_within(text), *table.asides)):
        # The reader of tables has judged the units in its text.
        if _changes(sentence, table):
            return sentence
    for remark in (*beside, *table.remarks, *_said_beside_code(text)):
        if may_change(remark, of_cell=True):
            return " ".join(remark.split())
    return ""


def _changes(sentence: str, table: "_Table") -> bool:
    return may_change(sentence) or any(map(table.contradicts, claims(sentence)))


def _gives_unit(sentence: str, table: "_Table", length_unit: str | None) -> bool:
    units = _MEASURED.sub(" ", _COMMAND.sub(" ", _CIRCLE.sub("°", sentence)))
    if not names_unit(units) and not CONVERTS_ANGLES.search(sentence):
        return False
    # Angles without a unit are in radians.
    is_code = CONVERTS_ANGLES.search(sentence) is not None
    if "angle" in table.numbers and (is_code or _ANGLES.search(_RADIANS.sub("", units))):
        return True
    others = _lengths(units) - {METRES.get(length_unit or "")}
    return "length" in table.numbers and bool(others)


# A statement that converts degrees to radians.
CONVERTS_ANGLES: Final = regex(
    r"[^\n]{0,80}(?:deg2rad|\bradians\(|(?:pi|π)\s?/\s?180(?!\d)|\b(?:cos|sin)d\()[^\n]{0,80}"
)


def _said_within(text: str) -> Iterator[str]:
    # The sentences and comments in a text that was read as a whole.
    yield from (line for line in text.splitlines() if is_sentence(line) and is_prose(line))
    yield from (comment[1] for comment in comments(text))


def is_prose(line: str) -> bool:
    """True if a line is no row of a table: it has few signs between cells, or many words."""
    signs = sum(map(line.count, "\t|&;"))
    return signs < _FEWEST_SIGNS and len(line.split()) > line.count(",") * _MOST_WORDS


_FEWEST_SIGNS: Final = 3
# The most words between two commas of a row.
_MOST_WORDS: Final = 2


def _said_beside_code(text: str) -> Iterator[str]:
    return (each[1] for each in comments(text) if is_beside_code(text, each.start()))


@dataclass(frozen=True, slots=True)
class _Table:
    """The cells of a table that words beside it may speak of."""

    headers: tuple[Header | None, ...]
    rows: tuple[tuple[str, ...], ...]
    # "angle" or "length" if numbers without a unit may be in another unit.
    numbers: frozenset[str]
    # The words in its rows, and the rows of words.
    remarks: tuple[str, ...] = ()
    asides: tuple[str, ...] = ()

    @classmethod
    def of(cls, text: str) -> "_Table":
        """Return the table in a text; it has no rows if the text has none."""
        rows = _rows(text)
        numbers = frozenset(_kinds_of_numbers(text))
        widest = max(map(_filled, rows), default=0)
        if widest < len(QUANTITIES):
            return cls((), (), numbers)
        names = next((i for i, row in enumerate(rows[:_MOST_ABOVE]) if _has_headers(row)), None)
        body = [tuple(row) for row in rows[0 if names is None else names + 1 :]]
        headers: list[Header | None] = [Header(column) for column in QUANTITIES]
        if names is not None:
            headers = [read_header(cell) for cell in rows[names]]
        elif widest > len(QUANTITIES):
            headers = [Header(LABEL), *headers]
        words = [cell for row in body if _filled(row) >= len(QUANTITIES) for cell in row]
        asides = [" ".join(filter(None, row)) for row in rows if 0 < _filled(row) < len(QUANTITIES)]
        return cls(
            tuple(headers),
            tuple(row for row in body if _filled(row) >= len(QUANTITIES)),
            numbers,
            tuple(filter(_HAS_WORD.search, words)),
            tuple(filter(_HAS_WORD.search, asides)),
        )

    def contradicts(self, claim: Claim) -> bool:
        """True if a sentence gives a cell another value than the table."""
        for i, header in enumerate(self.headers):
            if header is not None and header.column == claim.column:
                row = self._row(claim.row + (1 if header.shifted and claim.row > 0 else 0))
                return i < len(row) and contradicts(claim.value, row[i])
        return False

    def _row(self, number: int) -> tuple[str, ...]:
        labels = [i for i, header in enumerate(self.headers) if header and header.column == LABEL]
        if number > 0 and labels:
            for row in self.rows:
                if labels[0] < len(row) and _LAST_NUMBER.findall(row[labels[0]])[-1:] == [
                    str(number)
                ]:
                    return row
        if number > len(self.rows) or not self.rows:
            return ()
        return self.rows[number - 1 if number > 0 else -1]


def _filled(row: Sequence[str]) -> int:
    return sum(map(bool, map(str.strip, row)))


def _has_headers(row: Sequence[str]) -> bool:
    known = [header for cell in row if (header := read_header(cell))]
    return sum(header.column in QUANTITIES for header in known) >= _FEWEST_HEADERS


_HAS_WORD: Final = regex(r"[^\W\d_]{3}|[\u4e00-\u9fff]{2}")
_LAST_NUMBER: Final = regex(r"\d{1,3}")
# The most rows above the headers.
_MOST_ABOVE: Final = 5


def _remarks_sentences(around: Iterable[str]) -> Iterator[str]:
    for line in around:
        for sentence in _SENTENCE_END.split(line):
            if sentence.strip():
                yield " ".join(sentence.split())


def _lengths(sentence: str) -> set[float | None]:
    found: set[float | None] = {*units_in(_ANGLES.sub(" ", sentence))[1]}
    found |= {metres for name, metres in _CHINESE.items() if name in sentence}
    if _METRES.search(sentence):
        found.add(METRES["m"])
    return found


def _kinds_of_numbers(text: str) -> Iterator[str]:
    """Yield "angle" or "length" for each number without a unit that may be in another unit."""
    rows = _rows(text)
    headers = [read_header(cell) for cell in rows[0]] if rows else []
    known = [header for header in headers if header and header.column in QUANTITIES]
    has_headers = len(known) >= _FEWEST_HEADERS
    has_angles = bool(_CONVERTED.search(text))
    for i, column in enumerate(zip_longest(*rows, fillvalue="")):
        if not any(map(_is_bare, column)) or _is_label(column):
            continue
        header = headers[i] if has_headers and i < len(headers) else None
        if not has_headers:
            yield "length"
            if not has_angles:
                yield "angle"
        elif header is not None:
            kind = "angle" if header.column == THETA_OFFSET else QUANTITIES.get(header.column, "")
            if (kind == "angle" and not header.angle_unit) or (
                kind == "length" and header.metres is None
            ):
                yield kind


def _rows(text: str) -> list[list[str]]:
    try:
        robot = read_robot(text)
        grid = robot.grid if robot else read_grid(text, of_table=True)
    except GridError:
        return [[cell] for cell in _SEPARATORS.split(text)]
    rows = [[cell.text for cell in row] for row in grid.rows]
    return rows if robot is None or robot.has_headers else [[*QUANTITIES], *rows]


def _is_bare(cell: str) -> bool:
    if _CONVERTED.search(cell) or UNIT.search(cell):
        return False
    values = [float(value.replace(",", ".")) for value in _NUMBER.findall(cell)]
    is_number = _NUMBER.fullmatch(cell.strip(" -+−$")) is not None
    return any(value > _LARGEST_FACTOR or (is_number and value != 0) for value in values)


def _is_label(column: Sequence[str]) -> bool:
    digits = [int(cell) for cell in column if cell.isdecimal()]
    return len(digits) > 1 and digits == list(range(digits[0], digits[0] + len(digits)))


def shortened(sentence: str) -> str:
    """Return a sentence for a message, without the end of a long one."""
    return sentence if len(sentence) <= _LONGEST else f"{sentence[:_LONGEST]}…"


# --- Write a formula of Word's equation editor in one line


def local_name(element: ET.Element) -> str:
    """Return the name of an element without its namespace."""
    return element.tag.rpartition("}")[2]


def written_formula(element: ET.Element) -> str:
    """Return a formula of Word's equation editor as one would type it."""
    name = local_name(element)
    if name == "t":
        return element.text or ""
    if name.endswith("Pr"):
        return ""
    written = _FORMULAS.get(name)
    if written is None:
        return "".join(map(written_formula, element))
    return written(_Parts(element))


class _Parts:
    """The written parts of a formula: numerator, index and so on, by Word's names."""

    def __init__(self, element: ET.Element) -> None:
        self.all: Final = [(local_name(each), each) for each in element]

    def __getitem__(self, name: str) -> str:
        return "".join(written_formula(each) for own, each in self.all if own == name)


def _power(parts: _Parts) -> str:
    return f"{parts['e']}°" if parts["sup"] in ("∘", "°") else f"{parts['e']}^({parts['sup']})"


def _root(parts: _Parts) -> str:
    degree = parts["deg"].strip()
    return f"sqrt({parts['e']})" if degree in ("", "2") else f"({parts['e']})^(1/({degree}))"


def _bracketed(parts: _Parts) -> str:
    inner = ", ".join(written_formula(each) for name, each in parts.all if name == "e")
    # A matrix has brackets of its own.
    return inner if inner.startswith("[[") else f"({inner})"


def _matrix(parts: _Parts) -> str:
    rows = (
        ", ".join(written_formula(each) for each in row if local_name(each) == "e")
        for name, row in parts.all
        if name == "mr"
    )
    return f"[{', '.join(f'[{row}]' for row in rows)}]"


def _index(text: str) -> str:
    return text if text.isalnum() else f"{{{text}}}"


# Other structures, such as sums, are no answers; their text must not be taken for one.
_FORMULAS: Final[Mapping[str, Callable[[_Parts], str]]] = {
    "f": lambda parts: f"({parts['num']})/({parts['den']})",
    "sSup": _power,
    "sSub": lambda parts: f"{parts['e']}_{_index(parts['sub'])}",
    "sSubSup": lambda parts: f"{parts['e']}_{_index(parts['sub'])}^({parts['sup']})",
    "rad": _root,
    "func": lambda parts: f"{parts['fName']}({parts['e']})",
    "d": _bracketed,
    "m": _matrix,
    **dict.fromkeys(
        ("nary", "limLow", "limUpp", "eqArr", "groupChr", "acc", "sPre"), lambda _: "(formula)"
    ),
}


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
    lines = (
        unescape(_DOCUMENTS_TAG.sub(" ", line)) for piece in pieces for line in _LINE.split(piece)
    )
    return tuple(line for line in lines if line.strip())


_ROW: Final = regex(r"<tr(?![A-Za-z0-9-])", re.IGNORECASE)
_ROW_END: Final = regex(r"</(?:tr|table)(?![A-Za-z0-9-])[^<>]{0,200}>", re.IGNORECASE)
_LINE: Final = regex(
    r"</?(?:p|div|br|li|caption|h[1-6])(?![A-Za-z0-9-])[^<>]{0,2000}>", re.IGNORECASE
)
_DOCUMENTS_TAG: Final = regex(r"</?[A-Za-z][^<>]{0,2000}>")


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


# --- Notebooks ---


def notebook_excerpts(data: bytes) -> Iterator[Excerpt]:
    """Yield the pieces of a notebook that may be the answer. Raises UnusableFileError."""
    try:
        content: Any = read_json(data)
        cells = content["cells"] if "cells" in content else content["worksheets"][0]["cells"]
        found = [(str(cell["cell_type"]), _source(cell), list(_outputs(cell))) for cell in cells]
    except (MalformedError, KeyError, IndexError, TypeError) as error:
        raise UnusableFileError(say("is not a usable notebook")) from error
    code = [source for kind, source, _ in found if kind == "code" and source.strip()]
    texts = [source for kind, source, _ in found if kind != "code" and source.strip()]
    lines = tuple(line for text in texts for line in text.splitlines() if "|" not in line)
    said = tuple(comment[1] for source in code for comment in comments(source))
    # A function that converts angles shows that those of the table are in degrees.
    lines = (*lines, *(found[0] for source in code for found in CONVERTS_ANGLES.finditer(source)))
    for text in texts:
        if (table := pasted_from(text, ".md")) != text:
            yield Excerpt(table, around=(*lines, *said))
    if code:
        yield Excerpt("\n".join(code), around=lines)
        for i, each in enumerate(code if len(code) > 1 else ()):
            changed = changing_statement(each, "\n".join(code[i + 1 :]))
            yield Excerpt(each, level=1, around=(*lines, *said), changed=changed)
    yield from (
        Excerpt(text, level=1, around=(*lines, *said, *around_rows(text))) for text in texts
    )
    # What the code printed last counts only if nothing else is there.
    printed = [text for _, _, outputs in found for text in outputs if text.strip()]
    if printed:
        yield Excerpt(printed[-1], level=2)


def _source(cell: Mapping[str, Any]) -> str:
    return _joined_lines(cell.get("source", cell.get("input", "")))


def _joined_lines(lines: object) -> str:
    if isinstance(lines, str):
        return lines
    if not isinstance(lines, list):
        raise TypeError
    return "".join(lines)


def _outputs(cell: Mapping[str, Any]) -> Iterator[str]:
    for output in cell.get("outputs") or ():
        text = output.get("text") or (output.get("data") or {}).get("text/plain") or ""
        yield _joined_lines(text)


# --- Read the text of a file in any encoding, and web pages as a person typed them

# The most tags in one file. A document of two megabytes from Word has about as many; a hostile file
# has a tag in every third byte, and each tag takes more time than a thousand letters.
MAX_TAGS: Final = 60_000


def too_much() -> UnusableFileError:
    """Return the error about a file with too many parts."""
    return UnusableFileError(
        say("holds more than a hand-in needs; leave only the table or matrix in it")
    )


def struck_out(text: str) -> str:
    """Return struck-out text as Markdown writes it, which no reader of tables takes."""
    inner = text.strip(" ~")
    before, _, after = text.partition(inner) if inner else (text, "", "")
    return f"{before}~~{inner.replace('~', '')}~~{after}" if inner else text


# --- The text of a file


def decoded(data: bytes) -> str:
    """Return the text of a file in UTF-8, UTF-16 or Windows-1252. Raises UnusableFileError."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        try:
            return data.decode("utf-16")
        except UnicodeError as error:
            raise UnusableFileError(
                say("is not text: it begins like UTF-16, but is invalid")
            ) from error
    if b"\0" in data:
        return _wide(data)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        pass
    # Python leaves five bytes of Windows-1252 undefined; no text has them.
    if any(byte < 32 and byte not in b"\t\n\r\f" for byte in data):
        raise UnusableFileError(say("is not text"))
    try:
        text = data.decode("cp1252")
    except UnicodeDecodeError as error:
        raise _other_encoding() from error
    if _IMPLAUSIBLE.search(text):
        raise _other_encoding()
    return text


# Signs that no text in Windows-1252 has at such places, but one in GBK, in the code page of a Mac,
# of DOS, or in Cyrillic letters, which is decoded as Windows-1252: "Á¬¸Ë³¤¶È", "180¡", "180ø",
# "LŠnge", "¹/2".
_IMPLAUSIBLE: Final = regex(
    r"[¬¸¶¤¦¨¯]|[À-ÖØ-öø-ÿ¡-§©-¯±-¶¸-º¼-¿×÷ŠšŒœŽžŸƒˆ˜]{4}|[²³µ¼½¾±][À-ÖØ-öø-ÿ]"
    r"|\w[¡§]|\d ?ø(?!\w)|[€†‡…ˆ‰][a-z]|[A-Za-z][ŠŽŒŸ€†‡ˆ‰](?=[a-z\s])|(?<![\w)])¹"
)


def _other_encoding() -> UnusableFileError:
    return UnusableFileError(
        say(
            "is not text in UTF-8 or Windows-1252; if it is a text, save it as UTF-8, and hand it "
            "in again"
        )
    )


def _wide(data: bytes) -> str:
    """Return the text of a file in UTF-16 without a byte order mark. Raises UnusableFileError.

    The file must be certain: half of its letters are ASCII, and all of them can be printed.
    """
    for encoding, first in (("utf-16-le", 1), ("utf-16-be", 0)):
        high, low = data[first::2], data[1 - first :: 2]
        if len(data) % 2 == 0 and 0 not in low and 2 * high.count(0) >= len(high):
            with suppress(UnicodeDecodeError):
                text = data.decode(encoding)
                if all(sign.isprintable() or sign in "\t\n\r\f" for sign in text):
                    return text
    raise UnusableFileError(
        say("is not text: it has zero bytes; if it is a text, save it as UTF-8")
    )


# --- Web pages

_TABLE: Final = regex(r"<(?:table|tr)(?![A-Za-z0-9-])", re.IGNORECASE)
# What begins a new line on a web page.
_BREAK: Final = regex(
    r"</?(?:p|div|br|li|ul|ol|pre|h[1-6]|blockquote|section|article|body|html|head)"
    r"(?![A-Za-z0-9-])[^<>]{0,2000}>",
    re.IGNORECASE,
)
# The start of an element that a browser does not show.
_HIDDEN: Final = regex(r"<(head|style|script|title)(?![A-Za-z0-9-])|<!--|<!", re.IGNORECASE)
_TAG: Final = regex(r"</?[A-Za-z][^<>]{0,2000}>")
_STRUCK_TAG: Final = regex(
    r"<(s|del|strike|span(?=[^<>]{1,400}line-through))(?![A-Za-z0-9-])[^<>]{0,2000}>([^<>]{1,400})"
    r"</\1>",
    re.IGNORECASE,
)
_RAISED: Final = regex(r"<sup(?![A-Za-z0-9-])[^<>]{0,2000}>([^<>]{1,40})</sup>", re.IGNORECASE)


def typed_text(page: str) -> str:
    r"""Return the lines that a person typed into a platform's editor, which sends a web page.

    >>> typed_text("<p>0,&nbsp;0, 0, q1<br>l1, 0, 0, q2</p>")
    '0, 0, 0, q1\nl1, 0, 0, q2'
    """
    is_preformatted = re.search("<pre(?![A-Za-z0-9-])", page, re.IGNORECASE) is not None
    page = _visible(page)
    if not is_preformatted and _BREAK.search(page):
        # Line ends in the source of a page mean no more than blanks.
        page = " ".join(page.split("\n"))
    page = _STRUCK_TAG.sub(lambda found: struck_out(found[2]), page)
    page = _RAISED.sub(lambda found: "°" if found[1] in "oO0°" else f"^({found[1]})", page)
    text = unescape(_TAG.sub("", _BREAK.sub("\n", page))).replace("\u00a0", " ")
    lines = (line.strip(" ") for line in text.splitlines())
    return "\n".join(line for line in lines if line.strip())


def _visible(page: str) -> str:
    """Return a web page without its head, styles, scripts and comments."""
    lowered = page.lower()
    pieces = []
    start = position = 0
    unclosed: set[str] = set()
    while found := _HIDDEN.search(lowered, position):
        opening = found[0]
        closing = {"<!--": "-->", "<!": ">"}.get(opening, f"</{opening[1:]}")
        close = -1 if opening in unclosed else lowered.find(closing, found.end())
        end = lowered.find(">", close) + 1 if close >= 0 else 0
        position = found.end()
        if end:
            pieces.append(page[start : found.start()])
            start = position = end
        else:
            # Such an element is not searched for again, so that the time stays linear.
            unclosed.add(opening)
    return "".join(pieces) + page[start:]


def web_page(data: bytes) -> Iterator[Excerpt]:
    """Yield the tables of a web page, and its text. Raises UnusableFileError."""
    page = decoded(data)
    if page.count("<") + page.count("&") > MAX_TAGS:
        raise too_much()
    page = _visible(page)
    has_table = _TABLE.search(page) is not None
    if has_table:
        yield Excerpt(page, around=around_rows(page))
    text = typed_text(page)
    if text:
        yield Excerpt(text, level=1 if has_table else 0)
