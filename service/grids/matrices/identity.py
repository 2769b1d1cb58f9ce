"""The identity matrix by its name: ``eye(4)``, ``np.identity(3)``, ``I_4``, or only ``I``."""

from typing import Final

from service.grids.cutting.grid import Grid
from service.grids.cutting.source_text import SourceText
from service.grids.scripts.program_text import without_harmless_lines, without_remarks
from service.regex import regex

# The format of a matrix whose text does not say its size. It has the most rows that are asked for.
ANY_SIZE: Final = "identity-of-any-size"
_LARGEST: Final = 4
# Characters of a program that makes nothing but the matrix.
_LONGEST: Final = 400
_MAY_BE: Final = regex(r"eye|ident|I")
_NAME: Final = r"(?:[A-Za-z][\w^{}]{0,20}(?:\([\w, ]{0,20}\))?[ \t]{0,4}:?=[ \t]{0,4}){0,2}"
_CALL: Final = (
    r"(?:[A-Za-z]{1,8}\.)?(?:eye|identity|ident|IdentityMatrix)[ \t]?"
    r"[(\[]\s?(?P<called>[2-4])(?:,\s?(?P=called))?\s?[)\]]"
)
_LETTER: Final = (
    r"(?:\\(?:mathbf|mathrm|boldsymbol|bm)\{I\}|I)"
    r"(?:_?\{?(?P<size>[2-4])(?:\s?(?:[x×]|\\times)\s?(?P=size))?\}?)?"
)
_IDENTITY: Final = regex(rf"\$*{_NAME}(?:{_CALL}|{_LETTER})\$*;?")


def identity(source: SourceText) -> Grid | None:
    """Return the identity matrix that the text names; None for any other text."""
    if len(source.text) > _LONGEST or not _MAY_BE.search(source.text):
        return None
    source = without_harmless_lines(without_remarks(source)).strip()
    found = _IDENTITY.fullmatch(source.text)
    if found is None:
        return None
    stated = found["called"] or found["size"]
    size = int(stated or _LARGEST)
    cells = [[source.spelled("1" if i == j else "0") for j in range(size)] for i in range(size)]
    return Grid("identity" if stated else ANY_SIZE, tuple(map(tuple, cells)))
