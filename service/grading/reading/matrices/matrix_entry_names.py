"""Find the matrix entry that a name means, as in T(1,4) = l1 c1 and r_12 = -s1."""

import unicodedata
from typing import Final

from service.expressions import LeftSide, Vocabulary
from service.expressions.vocabulary.symbols import normal_form
from service.grading.feedback import Finding
from service.grading.reading.written_names import misnamed_value, name_of
from service.regex import regex
from service.translations import say

# Letters that name matrices; p_12 and l_12 are not matrix entries. If the index is in brackets, the
# letter may have frames: T_0^4(1,4).
_LETTER: Final = r"\\?(?:[a-z]+\s*\{\s*)?(?<![a-z])[aghjmrt]\s*\}?"
_GLUED: Final = regex(rf"{_LETTER}_?\{{?\s*([1-9])\s*,?\s*([1-9])\s*\}}?")
_IN_BRACKETS: Final = regex(
    rf"{_LETTER}[\s_^{{}}0-9]*(?:[({{]\s*([0-9]{{1,2}})\s*,\s*([0-9]{{1,2}})\s*[)}}]"
    r"|\[\s*([0-9]{1,2})\s*(?:,|\]\s*\[)\s*([0-9]{1,2})\s*\])"
)


def misnamed_entry(
    raw: object, place: tuple[int, int], size: tuple[int, int], vocabulary: Vocabulary
) -> Finding | None:
    """Return a finding if a value has the name of a matrix entry other than ``place``.

    ``place`` counts from 0; ``size`` is the matrix's rows and columns.
    """
    # Indices in square brackets may count from 0.
    name = name_of(raw, vocabulary)
    if name is None or normal_form(name.name) in vocabulary.by_name:
        return None
    named = _places_of(name)
    if place in named or not any(i < size[0] and j < size[1] for i, j in named):
        return None
    row, column = place
    return misnamed_value(name, say("row {row}, column {column}", row=row + 1, column=column + 1))


def _places_of(name: LeftSide) -> list[tuple[int, int]]:
    plain = unicodedata.normalize("NFKC", name.name).lower()
    found = _GLUED.fullmatch(plain) or _IN_BRACKETS.fullmatch(plain)
    if found is None:
        return []
    row, column = (int(each) for each in found.groups() if each is not None)
    from_one = (row - 1, column - 1)
    counts = [from_one, (row, column)] if name.name.endswith("]") else [from_one]
    return [(i, j) for i, j in counts if i >= 0 and j >= 0]
