"""Find the sentence beside a table in a document that may change the meaning of the table.

A document has other lines, cells, paragraphs and comments around the table or matrix, which no
reader of tables sees. One of them may say "All angles are in degrees", or "Row 4 is wrong".
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import zip_longest
from typing import Final

from service.grading.reading.tables.column_headers import QUANTITIES, THETA_OFFSET, read_header
from service.grading.reading.tables.words import METRES
from service.grading.reading.unit_comments import units_in
from service.grids import GridError, read_grid, read_robot
from service.grids.scripts.titles import UNIT, is_correction, names_unit
from service.regex import regex

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
    for sentence in _sentences(around):
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


def _sentences(around: Iterable[str]) -> Iterator[str]:
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
