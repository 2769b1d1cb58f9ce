r"""Several matrices in one pasted text, each with the name before it.

The text may be ``A1 = […]`` above ``A2 = […]``, a list of matrices, or LaTeX with several
environments.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Final

from service.grids.cutting.grid import Grid, GridError, too_many_matrices
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.once import remembers
from service.grids.cutting.pairs import CLOSES, split, strict_pairs
from service.grids.cutting.source_text import SourceText, joined
from service.grids.formats import latex
from service.grids.matrices import latex_list
from service.grids.matrices.identity import identity
from service.grids.matrices.lists import lines_of
from service.grids.registry import grid_of, pasted_source
from service.grids.scripts.program_text import MAKERS, TAIL, without_harmless_lines, without_remarks
from service.regex import regex

_HIDDEN: Final = "\x01"
# A name such as A_1, T(q1) or A{2}; the content of its brackets is masked.
_NAME: Final = (
    r"(?:\{\})?(?!\d+[.*\s])[\w\\{^]"
    rf"(?:[\w.^\\'*@→ \t]|[({{\[]{_HIDDEN}{{0,40}}[)}}\]]){{0,48}}"
)
_NUMBERED: Final = r"(?:[A-Za-z]{1,14}[ \t]{1,3}){0,3}[A-Za-z_^]{0,4}[\d_^→]{1,8}"
_HEADING: Final = regex(
    rf"(?:^|[;,\n])[ \t]*(?P<name>{_NAME})(?::=|[:=])(?!=)"
    rf"|(?:^|\n)[ \t]*(?P<line>{_NUMBERED})[ \t]*(?=\r?\n)"
)
_COMMENT: Final = regex(rf"^[ \t]*(?:%+|#+|//+)[ \t]*({_NUMBERED})[ \t:=]*$", re.MULTILINE)
_PRODUCT: Final = regex(r"(?:[A-Za-z]{1,12}\()?[^\W\d]\w{0,20}(?:\s?[*@.]\s?[^\W\d]\w{0,20})+\)?")
_PROSE: Final = regex(r"[^\W\d]{0,20}(?:[ \n,.:;]{1,3}[^\W\d]{1,20}){0,40}")
# The brackets of a matrix, of a list around it, and of a function around the list.
_NESTING: Final = 3
# Each row of each matrix may be in brackets of its own.
_MOST_GROUPS: Final = GRID_LIMITS.rows**2
_GROUP: Final = regex(
    rf"(?:(?<![\w.])(?P<maker>[A-Za-z_][\w.]{{0,60}})[ \t]*)?[\[({{]{_HIDDEN}*[\])}}]"
)
_BLANK_LINES: Final = regex(r"\n(?:[ \t]*\r?\n)+")


@dataclass(frozen=True, slots=True)
class NamedGrid:
    """One of several matrices, or the error if the matrix cannot be read.

    ``name`` is the name before the matrix, or "".
    """

    name: SourceText
    grid: Grid | GridError


@remembers
def read_grids(text: str) -> tuple[NamedGrid, ...]:
    """Return the matrices in a pasted text, in order.

    Raises GridError if the text cannot be split into matrices. Takes linear time.
    """
    source = pasted_source(text, named=True)
    pieces = latex_list.several(source) if latex.FORMAT.matches(source.text) else _several(source)
    # Names and products alone are no matrix: let the reader of a matrix refuse the text.
    pieces = pieces or [(source.cut(0, 0), source)]
    if len(pieces) > GRID_LIMITS.matrices:
        raise too_many_matrices(source.whole)
    found = [NamedGrid(name, _read(piece)) for name, piece in pieces]
    return tuple(each for i, each in enumerate(found) if not _is_made_later(each, found[i + 1 :]))


def _is_made_later(each: NamedGrid, later: Sequence[NamedGrid]) -> bool:
    # True if a later matrix has the same name, and ``each`` is only a formula for it.
    # ``A1 = trotz(q1)`` above ``A1 = […]`` is an example.
    name = each.name.text
    if not isinstance(each.grid, GridError) or each.grid.code != "no_grid" or not name:
        return False
    return any(name == other.name.text for other in later)


def _read(piece: SourceText) -> Grid | GridError:
    try:
        return identity(piece) or grid_of(piece)
    except GridError as error:
        return error


def _several(source: SourceText) -> list[tuple[SourceText, SourceText]]:
    source = without_remarks(_headings_out_of_comments(source))
    source = without_harmless_lines(source)
    nameless = source.cut(0, 0)
    return [
        (nameless if i else name, piece)
        for name, content in _labelled(source)
        for i, piece in enumerate(_listed(content))
    ]


def _headings_out_of_comments(source: SourceText) -> SourceText:
    """Return the text with each comment line ``% A1`` replaced by the heading ``A1``."""
    pieces, start = [], 0
    for comment in _COMMENT.finditer(source.text):
        pieces += [source.cut(start, comment.start()), source.cut(*comment.span(1))]
        start = comment.end()
    return joined([*pieces, source.cut(start, len(source.text))], source.whole[0])


def _masked(source: SourceText) -> str:
    pieces, start, after = [], 0, 0
    text = source.text
    ends = strict_pairs(source)
    for at in sorted(ends):
        if at >= after:
            after = ends[at]
            pieces += [text[start : at + 1], _HIDDEN * (after - at - 2)]
            start = after - 1
    return "".join([*pieces, text[start:]])


def _labelled(source: SourceText) -> Iterator[tuple[SourceText, SourceText]]:
    name, start = source.cut(0, 0), 0
    for heading in _HEADING.finditer(_masked(source)):
        content = source.cut(start, heading.start())
        following = source.cut(*heading.span(heading.lastgroup or 0)).strip()
        if _holds_something(content):
            yield name, content
            name = following
        elif "\n" in source.text[start : heading.start() + 1] or not start:
            # T = A1*A2 = […] keeps its first name.
            name = following
        start = heading.end()
    content = source.cut(start, len(source.text))
    if not start or not _PRODUCT.fullmatch(content.text.strip(TAIL)):
        yield name, content


def _holds_something(content: SourceText) -> bool:
    # True unless the text is only prose or a product of named matrices.
    text = content.text.strip(TAIL)
    is_name = _PRODUCT.fullmatch(text) or _PROSE.fullmatch(text)
    return not is_name or identity(content) is not None


def _listed(content: SourceText) -> list[SourceText]:
    """Split a text without names into matrices: a list, consecutive brackets, or blocks."""
    inner = content
    for _ in range(_NESTING):
        groups = _groups(inner)
        if len(groups) > 1 and all(_is_matrix(group) for group in groups):
            return groups
        if len(groups) != 1:
            break
        inner = _content(groups[0])
    blocks = [block for block in content.split(_BLANK_LINES) if block.text.strip(TAIL)]
    if len(blocks) > 1 and all("\n" in block.text.strip() for block in blocks):
        return blocks
    return [content]


def _groups(content: SourceText) -> list[SourceText]:
    masked = _masked(content)
    groups = list(islice(_GROUP.finditer(masked), _MOST_GROUPS + 1))
    if len(groups) > _MOST_GROUPS or _GROUP.sub("", masked).strip(TAIL):
        return []
    return [content.cut(*group.span()) for group in groups]


def _content(group: SourceText) -> SourceText:
    opened = next(i for i, letter in enumerate(group.text) if letter in CLOSES)
    return group.cut(opened + 1, len(group.text) - 1)


def _is_matrix(group: SourceText) -> bool:
    """True if a bracket is a matrix and not a row."""
    # The bracket may be the argument of a function.
    content = _content(group)
    maker = group.text[: len(group.text) - len(content.text) - 2].strip().rpartition(".")[2]
    if maker:
        return maker in MAKERS
    return len(split(content, ";")) > 1 or lines_of(content) is not None
