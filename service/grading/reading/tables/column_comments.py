"""Comments and captions of a table: the columns and units that they name.

``% theta [deg], d, a, alpha`` gives the columns of a table without headers. A unit without columns,
such as ``% lengths in mm``, may apply to the table, so the text is refused.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import Final

from service.expressions import AngleUnit
from service.expressions.errors import Span
from service.grading.reading.entry import Reader
from service.grading.reading.tables.column_headers import Header, read_header
from service.grading.reading.tables.words import ANGLE_UNITS, METRES, in_plain_words
from service.grids import GridError
from service.kinematics.chain import COLUMNS
from service.translations import say

_COMMENT: Final = re.compile(r"(?:[%#]{1,3}|//)[ \t]{0,40}([^\n%#]{2,80})")
_CAPTION: Final = re.compile(
    r"\\caption\s{0,4}\{([^{}]{2,200})\}|<caption[^<>]{0,80}>([^<>]{2,200})</caption>",
    re.IGNORECASE,
)
_MOST_COMMENTS: Final = 40
_BETWEEN_NAMES: Final = re.compile(r"[\s,;|&:]+")
_BEFORE_UNIT: Final = re.compile(r"\s{1,8}(?=[(\[])")
_WORD: Final = re.compile(r"[^\W\d_]+|°")
_DIGIT: Final = re.compile(r"\d")
# Numbers in a table with π, or in a script that converts them, are not in degrees or millimetres.
_CONVERTS_ANGLES: Final = re.compile(
    r"(?<![^\W\d_])(?:pi|deg2rad|radians)(?![^\W\d_])|π|°", re.IGNORECASE
)
_CONVERTS_LENGTHS: Final = re.compile(r"/\s?1000?(?!\d)|\de-[23]")
_OTHER_ANGLES: Final = re.compile(
    r"limit|qlim|range|freedom|grenze|bereich|límite|rango", re.IGNORECASE
)
# In a sentence, these are also other words.
_NO_UNITS: Final = frozenset({"m", "in", "foot"})


def columns_in_comments(text: str) -> tuple[Header, ...] | None:
    """Return the headers in a comment such as ``% theta d a alpha``, or None.

    Raises GridError if two comments name two orders.
    """
    found: dict[tuple[Header, ...], Span] = {}
    for comment in _comments(text):
        named = _columns(comment[1])
        if named is not None:
            found[named] = comment.span(1)
    if len(found) > 1:
        message = say("Two comments name the columns in two orders. Put headers above the columns.")
        raise GridError("unknown_header", message, [*found.values()][1])
    return next(iter(found), None)


def refuse_other_units(text: str, headers: Sequence[Header], reader: Reader) -> None:
    """Raise GridError if a comment or a caption names a unit, but no header and no column does.

    A unit in which the reader reads the table anyway, and a comment with numbers, are ignored.
    """
    has_angles = any(header.angle_unit for header in headers) or _CONVERTS_ANGLES.search(text)
    has_lengths = any(header.metres for header in headers) or _CONVERTS_LENGTHS.search(text)
    captions = islice(_CAPTION.finditer(text), _MOST_COMMENTS)
    for comment in (*_comments(text), *captions):
        written = comment[comment.lastindex or 0]
        if _DIGIT.search(written) or _OTHER_ANGLES.search(written) or _columns(written):
            continue
        angles, lengths = _units(written)
        others = set() if has_angles else angles - {reader.angle_unit}
        if others or (not has_lengths and lengths - {METRES.get(reader.length_unit or "")}):
            message = say(
                "This line names a unit, but not its columns. Delete the line, and write the "
                "units into the headers, such as theta [deg]."
            )
            raise GridError("text_around", message, comment.span())


def _comments(text: str) -> Iterator[re.Match[str]]:
    return islice(_COMMENT.finditer(text), _MOST_COMMENTS)


def _columns(comment: str) -> tuple[Header, ...] | None:
    """Return the headers of a, α, d and θ in a comment, in its order."""
    words = _BETWEEN_NAMES.split(_BEFORE_UNIT.sub("", comment.strip(" \t[]()")))
    headers = [read_header(word) for word in words]
    for i in range(len(headers) - len(COLUMNS) + 1):
        order = tuple(header for header in headers[i : i + len(COLUMNS)] if header)
        if sorted(header.column for header in order) == sorted(COLUMNS):
            return order
    return None


def _units(comment: str) -> tuple[set[AngleUnit], set[float]]:
    """Return the units of angles and of lengths in a comment."""
    words = {*_WORD.findall(in_plain_words(comment))} - _NO_UNITS
    angles = {ANGLE_UNITS[word] for word in words if word in ANGLE_UNITS}
    return angles, {METRES[word] for word in words if word in METRES}
