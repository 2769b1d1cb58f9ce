"""The table or matrix in a LaTeX, Markdown or MATLAB document, and sentences beside it."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from html import unescape
from itertools import zip_longest
from typing import Final
from xml.etree import ElementTree as ET

from dh_grader.grading.reading.entries import comments, units_in
from dh_grader.grading.reading.headers import METRES, QUANTITIES, THETA_OFFSET, read_header
from dh_grader.pasting import ASSIGNMENT, GridError, read_grid, read_robot
from dh_grader.pasting.around import UNIT, is_correction, names_unit
from dh_grader.regex import regex

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


def changing_remark(text: str, around: Iterable[str], length_unit: str | None) -> str:
    """Return the first sentence around a table or matrix that may change its meaning, or "".

    ``length_unit`` is the unit of the lengths in the exercise, or None if it is not known.
    """
    numbers: set[str] | None = None
    for sentence in _remarks_sentences(around):
        if is_correction(sentence):
            return sentence
        units = _MEASURED.sub(" ", _COMMAND.sub(" ", _CIRCLE.sub("°", sentence)))
        if not names_unit(units):
            continue
        if numbers is None:
            numbers = set(_kinds_of_numbers(text))
        # Angles without a unit are in radians.
        if "angle" in numbers and _ANGLES.search(_RADIANS.sub("", units)):
            return sentence
        if "length" in numbers and _lengths(units) - {METRES.get(length_unit or "")}:
            return sentence
    return ""


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
