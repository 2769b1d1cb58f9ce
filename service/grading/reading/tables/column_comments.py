"""Read the columns of a table without headers from a comment: ``% theta [deg], d, a, alpha``."""

import re
from itertools import islice
from typing import Final

from service.expressions.errors import Span
from service.grading.reading.entry import Reader
from service.grading.reading.tables.column_headers import Header, read_header
from service.grading.reading.tables.words import ANGLE_UNITS, METRES, in_plain_words
from service.grids import GridError
from service.kinematics.chain import COLUMNS
from service.translations import say

_COMMENT: Final = re.compile(r"(?:[%#]{1,3}|//)[ \t]{0,40}([^\n%#]{2,80})")
_MOST_COMMENTS: Final = 40
_BETWEEN_NAMES: Final = re.compile(r"[\s,;|&:]+")
_BEFORE_UNIT: Final = re.compile(r"\s{1,8}(?=[(\[])")
_WORD: Final = re.compile(r"[^\W\d_]+|°")
_DIGIT: Final = re.compile(r"\d")
# In a sentence, these are also other words.
_NO_UNITS: Final = frozenset({"m", "in", "foot"})


def columns_in_comments(text: str, reader: Reader) -> tuple[Header, ...] | None:
    """Return the headers in a comment such as ``% theta d a alpha``, or None.

    Raises GridError if two comments name two orders, or if a comment names a unit other than the
    reader's without the columns.
    """
    found: dict[tuple[Header, ...], Span] = {}
    units: list[Span] = []
    for comment in islice(_COMMENT.finditer(text), _MOST_COMMENTS):
        named = _columns(comment[1])
        if named is not None:
            found[named] = comment.span(1)
        elif not _DIGIT.search(comment[1]) and _names_other_unit(comment[1], reader):
            units.append(comment.span(1))
    if len(found) > 1:
        message = say("Two comments name the columns in two orders. Put headers above the columns.")
        raise GridError("unknown_header", message, [*found.values()][1])
    if units:
        message = say(
            "This line names a unit, but not its columns. Delete the line, and write the units "
            "into the headers, such as theta [deg]."
        )
        raise GridError("text_around", message, units[0])
    return next(iter(found), None)


def _columns(comment: str) -> tuple[Header, ...] | None:
    """Return the headers of a, α, d and θ in a comment, in its order."""
    words = _BETWEEN_NAMES.split(_BEFORE_UNIT.sub("", comment.strip(" \t[]()")))
    headers = [read_header(word) for word in words]
    for i in range(len(headers) - len(COLUMNS) + 1):
        order = tuple(header for header in headers[i : i + len(COLUMNS)] if header)
        if sorted(header.column for header in order) == sorted(COLUMNS):
            return order
    return None


def _names_other_unit(comment: str, reader: Reader) -> bool:
    """True if a comment names a unit in which the reader would not read the table."""
    words = {*_WORD.findall(in_plain_words(comment))} - _NO_UNITS
    angles = {ANGLE_UNITS[word] for word in words if word in ANGLE_UNITS}
    lengths = {METRES[word] for word in words if word in METRES}
    return not angles <= {reader.angle_unit} or not lengths <= {
        METRES.get(reader.length_unit or "")
    }
