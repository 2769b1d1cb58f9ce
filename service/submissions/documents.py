"""The one table or matrix in a document: what would be pasted of it.

A file of LaTeX or Markdown has words around the answer, which a pasted text may not have. Where
there is not exactly one table, the text stays as it is, and the reader says what it lacks.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Final

_ENVIRONMENT: Final = re.compile(
    r"\\begin\{(tabular[x*]?|longtable|array|smallmatrix|[pbBvV]?matrix)\}"
)


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


_TABLES: Final[Mapping[str, Callable[[str], Iterator[str]]]] = {
    ".tex": _latex,
    ".md": _markdown,
}
