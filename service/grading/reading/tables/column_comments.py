"""Find the columns and units that comments and captions of a table name.

The comment ``% theta [deg], d, a, alpha`` gives the columns of a table without headers.
"""

# A unit without columns, such as ``% lengths in mm``, may apply to the table, so the text is
# refused.

import re
from collections.abc import Sequence
from typing import Final

from service.expressions.errors import Span
from service.grading.reading.entry import Reader
from service.grading.reading.tables.column_headers import Header, read_header
from service.grading.reading.tables.words import METRES
from service.grading.reading.unit_comments import (
    CONVERTS_LENGTHS,
    comments,
    comments_and_captions,
    refuse_corrections,
    units_in,
)
from service.grids import GridError
from service.grids.cutting.source_text import line_number
from service.kinematics.chain import COLUMNS
from service.regex import regex
from service.translations import say

_BETWEEN_NAMES: Final = regex(r"[\s,;|&:]+")
_BEFORE_UNIT: Final = regex(r"\s{1,8}(?=[(\[])")
# Numbers in a table with π, or in a script that converts them, are not in degrees or millimetres.
_CONVERTS_ANGLES: Final = regex(
    r"(?<![^\W\d_])(?:pi|deg2rad|radians)(?![^\W\d_])|π|°", re.IGNORECASE
)
_OTHER_ANGLES: Final = regex(r"limit|qlim|range|freedom|grenze|bereich|límite|rango", re.IGNORECASE)


def columns_in_comments(text: str) -> tuple[Header, ...] | None:
    """Return the headers in a comment such as ``% theta d a alpha``, or None.

    Raises GridError if two comments contradict each other.
    """
    found: dict[tuple[Header, ...], Span] = {}
    for comment in comments(text):
        named = _columns(comment[1])
        if named is not None:
            found[named] = comment.span(1)
    if len(found) > 1:
        message = say("Two comments name the columns in two orders. Put headers above the columns.")
        raise GridError("unknown_header", message, [*found.values()][1])
    return next(iter(found), None)


def refuse_other_units(text: str, headers: Sequence[Header], reader: Reader) -> None:
    """Raise GridError if a comment or a caption names a unit, but not the columns in this unit.

    Also raises GridError if a comment corrects the table.
    """
    # Units of angles are ignored if a header has one, and so are units of lengths. The reader's own
    # units and comments with numbers are ignored, too.
    refuse_corrections(text)
    has_angles = any(header.angle_unit for header in headers) or _CONVERTS_ANGLES.search(text)
    has_lengths = any(header.metres for header in headers) or CONVERTS_LENGTHS.search(text)
    for comment in comments_and_captions(text):
        written = comment[comment.lastindex or 0]
        if _OTHER_ANGLES.search(written) or _columns(written):
            continue
        angles, lengths = units_in(written)
        others = set() if has_angles else angles - {reader.angle_unit}
        if others or (not has_lengths and lengths - {METRES.get(reader.length_unit or "")}):
            message = say(
                "Line {line} names a unit, but not its columns. Delete the line, and write the "
                "units into the headers, such as theta [deg].",
                line=line_number(text, comment.start()),
            )
            raise GridError("text_around", message, comment.span())


def _columns(comment: str) -> tuple[Header, ...] | None:
    words = _BETWEEN_NAMES.split(_BEFORE_UNIT.sub("", comment.strip(" \t[]()")))
    headers = [read_header(word) for word in words]
    for i in range(len(headers) - len(COLUMNS) + 1):
        order = tuple(header for header in headers[i : i + len(COLUMNS)] if header)
        if sorted(header.column for header in order) == sorted(COLUMNS):
            return order
    return None
