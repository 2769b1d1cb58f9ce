"""Find comments and captions in a pasted text, and the units that they name."""

import re
from collections.abc import Iterable, Iterator
from itertools import chain, islice
from typing import Final

from service.expressions import AngleUnit, Kind
from service.grading.reading.entry import Reader
from service.grading.reading.pasted import once
from service.grading.reading.tables.words import ANGLE_UNITS, METRES, in_plain_words
from service.grids import GridError
from service.grids.cutting.source_text import line_number
from service.grids.scripts.titles import is_correction
from service.regex import regex
from service.translations import say

_COMMENT: Final = regex(r"(?:[%#]{1,3}|//|[(/]\*)[ \t]{0,40}((?:(?!\*[)/])[^\n%#]){2,80})")
_CAPTION: Final = regex(
    r"\\caption\s{0,4}\{([^{}]{2,200})\}|<caption[^<>]{0,80}>([^<>]{2,200})</caption>",
    re.IGNORECASE,
)
_MOST_COMMENTS: Final = 40
_WORD: Final = regex(r"[^\W\d_]+|°")
_DIGIT: Final = regex(r"\d")
# A script that converts numbers leaves none in millimetres.
CONVERTS_LENGTHS: Final = regex(r"/\s?1000?(?!\d)|\de-[23]")
# In a sentence, these are also other words.
_NO_UNITS: Final = frozenset({"m", "in", "foot"})


def refuse_other_lengths(text: str, kinds: Iterable[Kind], reader: Reader) -> None:
    """Raise GridError if a comment or a caption gives lengths a unit that is not the exercise's."""
    # ``kinds`` are the quantities of the entries.
    # Without lengths, all comments are accepted.
    if "length" in kinds:
        once("lengths", text, reader, lambda: _refuse_other_lengths(text, reader))


def _refuse_other_lengths(text: str, reader: Reader) -> None:
    refuse_corrections(text)
    if CONVERTS_LENGTHS.search(text):
        return
    for comment in comments_and_captions(text):
        _, lengths = units_in(comment[comment.lastindex or 0])
        if lengths - {METRES.get(reader.length_unit or "")}:
            message = say(
                "Line {line} names a unit of length. Delete the line, and write lengths as the "
                "exercise does.",
                line=line_number(text, comment.start()),
            )
            raise GridError("text_around", message, comment.span())


def refuse_corrections(text: str) -> None:
    """Raise GridError if a comment says that the table or matrix is wrong."""
    for comment in comments(text):
        if is_correction(comment[1]):
            message = say(
                "The sentence in line {line} may correct the table. Write the correction into the "
                "table, and delete the sentence.",
                line=line_number(text, comment.start()),
            )
            raise GridError("text_around", message, comment.span())


def comments(text: str) -> Iterator[re.Match[str]]:
    """Yield the comments; the last group of each match is the text of the comment."""
    return islice(_COMMENT.finditer(text), _MOST_COMMENTS)


def comments_and_captions(text: str) -> Iterator[re.Match[str]]:
    """Yield the comments and captions that contain no digit."""
    captions = islice(_CAPTION.finditer(text), _MOST_COMMENTS)
    for found in chain(comments(text), captions):
        if not _DIGIT.search(found[found.lastindex or 0]):
            yield found


def units_in(comment: str) -> tuple[set[AngleUnit], set[float]]:
    """Return the units of angles and of lengths in a comment."""
    words = {*_WORD.findall(in_plain_words(comment))} - _NO_UNITS
    angles = {ANGLE_UNITS[word] for word in words if word in ANGLE_UNITS}
    return angles, {METRES[word] for word in words if word in METRES}
