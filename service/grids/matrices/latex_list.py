r"""Several matrices in one LaTeX text, each with its name: ``A_1 = \begin{bmatrix} … A_2 = …``."""

import re
from collections.abc import Iterator
from typing import Final

from service.grids.cutting.grid import too_many_matrices
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.source_text import SourceText
from service.grids.formats.latex import (
    ARGUMENTS,
    BEGIN,
    PLAIN,
    after_brace,
    after_wrappers,
    check_wrapper,
    never_begun,
    never_ended,
    other_end,
    without_comments,
)
from service.grids.scripts.program_text import text_around
from service.regex import regex

_CLOSERS: Final = regex(r"(?:[ \t]|\\(?:right|[bB]igg?r?)\s?\\?[\])}.]|[\])}])*")
# Operators after a matrix that change it. After a line end, ^0 may begin the next name.
_CHANGES: Final = regex(
    r"[\^_'*/+\d-]|\\(?:cdot|times|circ|ast|div)(?![A-Za-z])|\s+(?:[_'*/+-]|\^\{?\\?[^\d{\\])"
)
_STATEMENTS: Final = regex(
    r"\\\\|\$\$?|\\[\[(]|\n[ \t]*\n|\\(?:begin|end)\{[a-z]{4,10}\*?\}(?:\{[^{}]{0,20}\})?"
    r"|\\item(?![A-Za-z])|\\q?quad(?![A-Za-z])|;"
)
_HEADING: Final = regex(
    r"(?:[A-Za-z]{1,14}\s{1,3}){0,3}(?:[A-Za-z_^]{0,4}[\d_^{} ]{1,12}|[A-Z]_?\{?[en]\}?)"
    r"\)?[:.]?(?=[\s$\\]|\Z)"
)
# A product after the last matrix, ``T = A_1 A_2``, which is ignored.
_PRODUCTS: Final = regex(r"[\s$,.;&\\(){}\[\]A-Za-z0-9_^]*=[\s$,.;&\\(){}\[\]A-Za-z0-9_^=]*")
_BLANKS: Final = " \t\r\n&,.:"


def several(source: SourceText) -> list[tuple[SourceText, SourceText]]:
    """Return the matrices of a text as pairs (name, matrix); the name may be empty.

    Raises GridError for an environment without an end, or for text that may change a matrix.
    """
    source = without_comments(source)
    found: list[tuple[SourceText, SourceText]] = []
    after = 0
    innermost = _innermost(source)
    if len(innermost) > GRID_LIMITS.matrices:
        raise too_many_matrices(source.whole)
    for start, end in innermost:
        front = source.cut(after, start)
        if found:
            _check_after(front)
        found.append((_name(front), source.cut(start, end)))
        after = end
    if not found:
        return [(source.cut(0, 0), source)]
    rest = source.cut(after, len(source.text))
    _check_after(rest)
    if not _PRODUCTS.fullmatch(rest.text):
        check_wrapper(rest)
    return found


def _innermost(source: SourceText) -> list[tuple[int, int]]:
    return sorted([*_environments(source), *_plain(source)])


def _environments(source: SourceText) -> Iterator[tuple[int, int]]:
    begun: list[re.Match[str]] = []
    innermost = False
    for mark in BEGIN.finditer(source.text):
        if mark[2] not in ARGUMENTS:
            continue
        if mark[1] == "begin":
            begun.append(mark)
        elif not begun:
            raise never_begun(source, mark)
        elif begun[-1][2] != mark[2]:
            raise other_end(source, begun[-1], mark)
        else:
            begin = begun.pop()
            if innermost:
                yield begin.start(), mark.end()
        innermost = mark[1] == "begin"
    if begun:
        raise never_ended(source, begun[-1])


def _plain(source: SourceText) -> Iterator[tuple[int, int]]:
    end = 0
    for mark in PLAIN.finditer(source.text):
        if mark.start() >= end:
            end = after_brace(source, mark.end())
            yield mark.start(), end


def _check_after(rest: SourceText) -> None:
    """Raise GridError if the text after a matrix begins with an operator."""
    closers = _CLOSERS.match(rest.text)
    at = closers.end() if closers else 0
    if _CHANGES.match(rest.text, at):
        raise text_around(rest.cut(at, len(rest.text)))


def _name(front: SourceText) -> SourceText:
    right = front.text.rfind("=") + 1
    if not right:
        rest = front.cut(after_wrappers(front.text), len(front.text)).strip(_BLANKS)
        heading = _HEADING.match(rest.text)
        end = heading.end() if heading else 0
        check_wrapper(rest.cut(end, len(rest.text)))
        return rest.cut(0, end)
    check_wrapper(front.cut(right, len(front.text)))
    statements = front.cut(0, right).split(_STATEMENTS)
    for statement in reversed(statements):
        left = statement.cut(0, statement.text.find("=")).strip(_BLANKS)
        if "=" in statement.text and left.text:
            return left
    return front.cut(0, 0)
