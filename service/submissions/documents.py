"""The one table or matrix in a document: what would be pasted of it.

A file of LaTeX or Markdown has words around the answer, and a MATLAB script has statements, which a
pasted text may not have. Where there is not exactly one table, the text stays as it is, and the
reader says what it lacks.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Final

from service.grids import ASSIGNMENT

_ENVIRONMENT: Final = re.compile(
    r"\\begin\{(tabular[x*]?|longtable|array|smallmatrix|[pbBvV]?matrix)\}"
)

_ASSIGNED: Final = re.compile(r"^[ \t]*([A-Za-z]\w{0,60})[ \t]*=[ \t]*\[", re.MULTILINE)

_NAME: Final = re.compile(r"[A-Za-z]\w*")
# A value for a name, other than itself as a symbol: q1 = sym('q1').
_GIVEN: Final = re.compile(
    r"(?:^|[;,])[ \t]*([A-Za-z]\w{0,60})[ \t]*=(?!=)(?![ \t]*sym\(['\"]\1['\"][,)])", re.MULTILINE
)
_SEVERAL_GIVEN: Final = re.compile(r"\][ \t]*=(?!=)")
# A value for a name, or for some of its entries.
_CHANGED: Final = re.compile(r"\b([A-Za-z]\w{0,60})[ \t]*(?:\([^()\n]{0,80}\)[ \t]*)?=(?!=)")


def pasted_from(text: str, suffix: str) -> str:
    """The text that would be pasted of a document whose name has this ending."""
    tables = _TABLES.get(suffix)
    if tables is None:
        return text
    found = tables(text)
    first = next(found, None)
    return text if first is None or next(found, None) is not None else first


def _latex(text: str) -> Iterator[str]:
    """The environments that hold tables and matrices."""
    at = 0
    while opening := _ENVIRONMENT.search(text, at):
        end = f"\\end{{{opening[1]}}}"
        closing = text.find(end, opening.end())
        if closing < 0:
            return
        at = closing + len(end)
        yield text[opening.start() : at]


def _markdown(text: str) -> Iterator[str]:
    """The blocks of code, and the lines with bars that stand together."""
    block: list[str] = []
    is_code = False
    for line in [*text.splitlines(), ""]:
        is_fence = line.lstrip().startswith(("```", "~~~"))
        if not is_fence and (is_code or "|" in line):
            block.append(line)
            continue
        if len(block) > 1:
            yield "\n".join(block)
        block = []
        is_code = is_fence and not is_code


def _matlab(text: str) -> Iterator[str]:
    """The matrices that are written out and assigned, as far as nothing else changes a letter.

    In front of a matrix stand the statements that give its letters values, for the reader to tell.
    """
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
            return
        matrices.append("\n".join([*values, matrix]))
    yield from matrices


def _values_given(text: str, letters: set[str]) -> list[str] | None:
    """The statements that give these letters values; None where one is given a matrix or a list."""
    found = []
    for given in _GIVEN.finditer(text):
        if given[1] in letters:
            assignment = ASSIGNMENT.match(text, given.start(1))
            if assignment is None:
                return None
            found.append(assignment["line"].rstrip())
    return found


def _closing(text: str, start: int) -> int:
    """The place behind the bracket that closes the one before ``start``, or 0."""
    depth = 1
    for bracket in re.finditer(r"[\[\]]", text[start:]):
        depth += 1 if bracket[0] == "[" else -1
        if depth == 0:
            return start + bracket.end()
    return 0


_TABLES: Final[Mapping[str, Callable[[str], Iterator[str]]]] = {
    ".tex": _latex,
    ".md": _markdown,
    ".m": _matlab,
}
