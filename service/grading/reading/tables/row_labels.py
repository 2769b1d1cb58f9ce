"""Order the rows of a pasted table by their labels: 1, 2, 3 … and e for the end effector."""

import unicodedata
from collections.abc import Sequence
from typing import Final

from service.grading.feedback import Finding, reading_note
from service.grading.reading.tables.words import PLACES, in_plain_words
from service.grids import GridCell, GridError
from service.regex import regex
from service.translations import say

LAST: Final = 10_000
_LONGEST: Final = 30
_WORDS: Final = "|".join(sorted(PLACES - {"#", "name", "label"}, key=len, reverse=True))
# Glied Nr. 1, articulation n° 1.
_NUMERO: Final = r"(?:n[or°]|num|nummer|number|numero|#)\.?\s?"
_NUMBER: Final = regex(
    rf"(?:(?:{_WORDS}|[ijklnta#])[\s.]?)?(\d{{1,2}})\.?|(?:{_WORDS})?\s?{_NUMERO}(\d{{1,2}})"
)
# 1. Gelenk, 第1关节, and the numbers of Chinese.
_ORDINAL: Final = regex(rf"第\s?(\d{{1,2}})(?:\s?joint)?|(\d{{1,2}})\.\s?(?:{_WORDS})")
_NUMERALS: Final = str.maketrans("一二三四五六七八九", "123456789")
_STEP: Final = regex(r"(\d{1,2})\s?(?:-|→|->|to)\s?(\d{1,2})")
_END: Final = frozenset(
    {"e", "ee", "tool", "tcp", "tip", "end", "effector", "end effector", "end-effector", "n+1"}
    | {"endeffektor", "werkzeug", "effecteur", "outil", "efector final", "herramienta"}
)


def label_place(text: str) -> int | None:
    """Return the number in a row's label, LAST for an end effector; None if it is not a label.

    Examples: ``1``, ``Link 1``, ``J1``, ``{1}``, ``0→1``; ``e``, ``tool``, ``end effector``.
    """
    if len(text) > _LONGEST:
        return None
    plain = in_plain_words(unicodedata.normalize("NFKC", text).translate(_NUMERALS))
    for mark in "${}_\\()*`":
        plain = plain.replace(mark, "")
    plain = " ".join(plain.split())
    if plain in _END:
        return LAST
    if step := _STEP.fullmatch(plain):
        return int(step[2]) if int(step[2]) == int(step[1]) + 1 else None
    number = _NUMBER.fullmatch(plain) or _ORDINAL.fullmatch(plain)
    return int(number[number.lastindex or 1]) if number else None


def is_label(text: str) -> bool:
    """True if a cell is the label of a row."""
    return label_place(text) is not None


def in_order(labels: Sequence[GridCell]) -> tuple[list[int], tuple[Finding, ...]]:
    """Return the indices of the rows in the order of their labels, and findings on the order.

    Raises GridError if two rows share a label.
    """
    # Rows keep their order if a row has no label.
    typed = list(range(len(labels)))
    places = [label_place(label.text) for label in labels]
    known = [place for place in places if place is not None]
    if len(known) < len(places):
        if not any(label.text for label in labels):
            return typed, ()
        unknown = next(i for i in typed if places[i] is None)
        message = say(
            "Not all rows have a number, so the rows were read in the order in which they stand."
        )
        return typed, (reading_note("row_labels", message, labels[unknown].whole),)
    if len(set(known)) < len(known):
        again = next(i for i in typed if known[i] in known[:i])
        raise GridError(
            "duplicate_row",
            say(
                "Two rows have the label {label}. Give each row its own.",
                label=labels[again].text[:_LONGEST],
            ),
            labels[again].whole,
        )
    order = sorted(typed, key=known.__getitem__)
    if order == typed:
        return typed, ()
    moved = next(i for i in typed if order[i] != i)
    message = say("The rows were put in the order of their labels.")
    return order, (reading_note("rows_reordered", message, labels[moved].whole),)
