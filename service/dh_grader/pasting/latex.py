r"""LaTeX: tabular, array, bmatrix and similar environments, or only rows (``a & b \\ c & d``)."""

import re
from collections.abc import Iterator
from typing import Final

from dh_grader.pasting.around import UNIT
from dh_grader.pasting.program import text_around
from dh_grader.pasting.source import (
    GRID_LIMITS,
    Grid,
    GridError,
    GridFormat,
    SourceText,
    grid,
    joined,
    too_many_matrices,
)
from dh_grader.regex import regex
from dh_grader.translations import say

# --- One matrix or table in LaTeX


# The number of arguments in braces after \begin{…}.
ARGUMENTS: Final = {
    "tabular": 1, "longtable": 1, "array": 1, "tabular*": 2, "tabularx": 2,
    "matrix": 0, "bmatrix": 0, "pmatrix": 0, "Bmatrix": 0, "smallmatrix": 0, "bsmallmatrix": 0,
    "psmallmatrix": 0, "matrix*": 0, "bmatrix*": 0, "pmatrix*": 0,
    "tblr": 1, "longtblr": 1, "talltblr": 1, "tabu": 1, "supertabular": 1, "tabulary": 2,
    "xltabular": 2, "NiceTabular": 1, "NiceArray": 1, "bNiceArray": 1, "pNiceArray": 1,
    "NiceMatrix": 0, "bNiceMatrix": 0, "pNiceMatrix": 0,
}  # fmt: skip
# Plain TeX, as Maxima prints it: \pmatrix{a & b \cr c & d \cr}.
PLAIN: Final = regex(r"\\[pbB]?matrix\s{0,4}(?=\{)")
BEGIN: Final = regex(r"\\(begin|end)[ \t]*\{([A-Za-z]{1,20}\*?)\}")
_TOKEN: Final = regex(r"\\(?:[A-Za-z]+|.)|[{}&]", re.DOTALL)
_ROW_ENDS: Final = frozenset({"\\\\", "\\tabularnewline", "\\cr"})
# Brackets are an option only if they cannot begin a cell, as in [q_1] + l_1.
_LENGTH: Final = (
    r"(?:\s{0,8}\[\s*[-+]?[0-9.]{1,8}\s*(?:pt|em|ex|mm|cm|in|\\(?:baselineskip|jot|tabcolsep"
    r"|(?:small|med|big)skipamount|(?:heavy|light|cmid)rulewidth))\s*\])?"
)
_DASHES: Final = r"(?:\s{0,8}\[[0-9.]{1,8}[a-z]{2}/[0-9.]{1,8}[a-z]{2}\])?"
_TRIM: Final = r"(?:\s{0,8}\([a-z]{0,4}\))?"
_COLOURS: Final = r"(?:\s{0,8}\[[a-zA-Z]{1,10}\])?"
_BRACED: Final = r"(?:\s{0,8}\{[^{}]{0,40}\})"
_GAP: Final = regex(rf"\*?{_LENGTH}")
# Commands that are no part of a cell, and the options that may follow each.
_OPTIONS: Final = {
    "hline|endhead|endfirsthead|endfoot|endlastfoot|displaystyle": "",
    "toprule|midrule|bottomrule|addlinespace": _LENGTH,
    "hdashline": _DASHES,
    "cmidrule": f"{_LENGTH}{_TRIM}{_BRACED}?",
    "cline|noalign": f"{_BRACED}?",
    "specialrule": f"{_BRACED}{{0,3}}",
    "rowcolor": f"{_COLOURS}{_BRACED}?",
}
_RULES: Final = regex(
    rf"\\(?:{'|'.join(f'(?:{name})(?![A-Za-z]){options}' for name, options in _OPTIONS.items())})"
)
_WORD: Final = r"(?!(?:pi|theta|alpha)\W)[^\W\d_]{2,20}"
# A row that is one cell over several columns, with words only: the title of the table or a note.
_TITLE: Final = regex(
    r"(?:\A|(?<=\\\\)|(?<=\\hline)|(?<=rule))\s*\\multicolumn\s?\{\d{1,2}\}\s?\{[^{}]{0,40}\}"
    r"\s?\{(?:\\(?:text[bi][ft]\{|(?:footnote|script)size|small|tiny|itshape)\s?)?"
    r"(?:\$?\^?\{?(?:\*|\\ast|\\dagger)\}?\$?[ :=]{0,4})?"
    rf"{_WORD}(?:[,:]?[ -]{_WORD}){{0,11}}"
    r"\.?\}{1,2}\s*(?:\\\\|\Z)"
)
# A cell over one column or one row, as generators of tables write each header.
_ONE_COLUMN: Final = regex(
    r"\\multi(?:column|row)\s?(?:\[\w\]\s?)?\{1\}\s?\{[^{}]{0,40}\}\s?(?=\{)"
)
# An escaped % does not begin a comment.
_COMMENT: Final = regex(r"\\.|%[^\n]*", re.DOTALL)
_POSITION: Final = regex(r"(?:\s{0,40}\[\s*[lcrtbhpsm!]{0,4}\s*\])?\s{0,40}")
# The outer options of tabularray: [t], [caption={…}].
_OUTER: Final = regex(r"(?:\s{0,40}\[[^\[\]]{0,400}\])?\s{0,40}")
# Options of nicematrix: [hvlines].
_NICE: Final = regex(
    r"\s{0,40}\[\s*(?:hv?lines|vlines|margin|small|rules|corners|nullify|columns-|rows-|first-|last-"
    r"|cell-|code-)[^\[\]&\\]{0,200}\]"
)
# Commands for bracket sizes mean nothing; they are half of the LaTeX that SymPy prints.
_SIZES: Final = regex(r"\\(?:left|right|[bB]igg?[lr]?)\s{0,4}(?=[()\[\]])")
_SPANNING: Final = frozenset({"\\multicolumn", "\\multirow", "\\SetCell"})
_WRAPPERS: Final = (
    regex(r"\s|[$,.;]|&|\\[\\\[\](),;:!> ]|\\q?quad(?![A-Za-z])"),
    regex(
        r"\\(?:begin|end)\s?\{(?:equation|displaymath|math|align|aligned|gather|gathered|table|center"
        r"|figure|document|split|multline|eqnarray|flalign|cases|itemize|enumerate)\*?\}"
        r"(?:\[[a-zA-Z!]{0,6}\])?|\\begin\{array\}\{[clr|]{0,12}\}|\\end\{array\}"
    ),
    regex(r"\\(?:left|right|[bB]igg?[lr]?)?\s?\\?[\[\](){}.]|[\[\](){}]"),
    regex(
        r"\\(?:centering|displaystyle|small|footnotesize|scriptsize|normalsize|large|noindent"
        r"|boxed|nonumber|notag|item)(?![A-Za-z])"
    ),
    regex(r"\\(?:documentclass|usepackage)\s?(?:\[[^\[\]]{0,200}\])?\{[^{}]{0,200}\}"),
    regex(
        r"\\(?:caption|label|tag|vspace|hspace|setlength|l?eqno|text|mbox)\*?"
        r"(?:\{(?:[^{}=]|\{[^{}]{0,80}\}){0,200}\}){1,2}"
    ),
)


def _matches(text: str) -> bool:
    if any(found[2] in ARGUMENTS or "matrix" in found[2] for found in BEGIN.finditer(text)):
        return True
    return ("\\\\" in text and "&" in text) or PLAIN.search(text) is not None


def _parse(source: SourceText) -> Grid:
    body = _body(without_comments(source))
    if not any(UNIT.search(title[0]) for title in _TITLE.finditer(body.text)):
        body = joined(body.split(_TITLE), body.at)
    rows = _rows(joined(body.split(_ONE_COLUMN), body.at))
    if not any(cell.text.strip() for cell in rows[-1]):
        rows.pop()
    return grid("LaTeX", rows, source.whole)


def without_comments(source: SourceText) -> SourceText:
    r"""Return the text without its comments; \% does not begin a comment."""
    return source.replaced(_COMMENT, lambda _, found: [] if found[0].startswith("%") else None)


def _body(source: SourceText) -> SourceText:
    text = source.text
    marks = [mark for mark in BEGIN.finditer(text) if mark[2] in ARGUMENTS]
    if not marks and (plain := PLAIN.search(text)):
        end = after_brace(source, plain.end())
        _check_in_front(source.cut(0, plain.start()))
        check_wrapper(source.cut(end, len(text)))
        return source.cut(plain.end() + 1, end - 1)
    if not marks:
        if other := next((mark for mark in BEGIN.finditer(text) if "matrix" in mark[2]), None):
            message = say(
                "This is a determinant or another form that is no plain matrix; use bmatrix."
            )
            raise GridError("not_a_matrix", message, source.span(*other.span()))
        return source
    first = marks[0]
    if first[1] == "end":
        raise never_begun(source, first)
    if len(marks) == 1:
        raise never_ended(source, first)
    last = marks[1]
    if last[1] == "begin":
        message = say(
            "One matrix or table inside another cannot be read. Write all entries in one."
        )
        raise GridError("nested_table", message, source.span(*last.span()))
    if last[2] != first[2]:
        raise other_end(source, first, last)
    _check_in_front(source.cut(0, first.start()))
    check_wrapper(source.cut(last.end(), len(text)))
    return source.cut(_after_arguments(source, first), last.start())


def never_begun(source: SourceText, mark: re.Match[str]) -> GridError:
    r"""Return the error for an ``\end{…}`` without its ``\begin{…}``."""
    message = say(
        "This ends a {environment} that has no beginning. Put {command} in front.",
        environment=mark[2],
        command=rf"\begin{{{mark[2]}}}",
    )
    return GridError("unbalanced_environment", message, source.span(*mark.span()))


def never_ended(source: SourceText, mark: re.Match[str]) -> GridError:
    r"""Return the error for a ``\begin{…}`` without its ``\end{…}``."""
    message = say(
        "This {environment} is never ended; {command} is missing.",
        environment=mark[2],
        command=rf"\end{{{mark[2]}}}",
    )
    return GridError("unbalanced_environment", message, source.span(*mark.span()))


def other_end(source: SourceText, begin: re.Match[str], end: re.Match[str]) -> GridError:
    r"""Return the error for a ``\begin{…}`` and an ``\end{…}`` with different names."""
    message = say("This does not fit {command}.", command=rf"\begin{{{begin[2]}}}")
    return GridError("unbalanced_environment", message, source.span(*end.span()))


def _check_in_front(front: SourceText) -> None:
    if after_wrappers(front.text) == len(front.text):
        return
    check_wrapper(front.cut(front.text.rfind("=") + 1, len(front.text)))


def check_wrapper(around: SourceText) -> None:
    """Raise GridError if the text next to a matrix is more than layout commands."""
    end = after_wrappers(around.text)
    if end < len(around.text):
        raise text_around(around.cut(end, len(around.text)))


def after_wrappers(text: str) -> int:
    """Return the position after the layout commands at the beginning of a text."""
    at = 0
    while at < len(text):
        found = next((match for token in _WRAPPERS if (match := token.match(text, at))), None)
        if found is None:
            break
        at = found.end()
    return at


def _after_arguments(source: SourceText, begin: re.Match[str]) -> int:
    at = begin.end()
    arguments = ARGUMENTS[begin[2]]
    if not arguments and begin[2].endswith("*"):
        return _after_position(source, at)
    for _ in range(arguments):
        following = _after_position(source, at, _OUTER if "tblr" in begin[2] else _POSITION)
        if source.text[following : following + 1] != "{":
            break
        at = after_brace(source, following)
    return _after_position(source, at, _NICE) if "Nice" in begin[2] else at


def _after_position(source: SourceText, at: int, options: re.Pattern[str] = _POSITION) -> int:
    position = options.match(source.text, at)
    return position.end() if position else at


def after_brace(source: SourceText, start: int) -> int:
    """Return the position after the brace that closes the opening brace at ``start``."""
    depth = 0
    for i in range(start, len(source.text)):
        depth += {"{": 1, "}": -1}.get(source.text[i], 0)
        if depth == 0:
            return i + 1
    raise GridError(
        "unbalanced_bracket", say("This {{ is never closed."), source.span(start, start + 1)
    )


def _rows(body: SourceText) -> list[list[SourceText]]:
    r"""Split into rows at \\ and into cells at &. Separators in braces are ignored."""
    text = body.text
    rows: list[list[SourceText]] = [[]]
    pieces: list[SourceText] = []
    start = i = depth = 0

    def end_cell(end: int) -> None:
        cell = joined([*pieces, body.cut(start, end)], body.span(start)[0])
        rows[-1].append(_without_sizes(cell))
        pieces.clear()

    while token := _TOKEN.search(text, i):
        word, at, i = token[0], token.start(), token.end()
        if word in "{}":
            depth = max(0, depth + (1 if word == "{" else -1))
        elif len(word) > 2 and (rule := _RULES.match(text, at)):
            pieces.append(body.cut(start, at))
            start = i = rule.end()
        elif word in _SPANNING:
            raise GridError(
                "spanning_cell",
                say(
                    "A cell over several columns or rows ({command}) cannot be read; "
                    "write each value in a cell of its own.",
                    command=word,
                ),
                body.span(at, i),
            )
        elif depth == 0 and word == "&":
            end_cell(at)
            start = i
        elif depth == 0 and word in _ROW_ENDS:
            end_cell(at)
            rows.append([])
            gap = _GAP.match(text, i)
            start = i = gap.end() if gap else i
    end_cell(len(text))
    return rows


def _without_sizes(cell: SourceText) -> SourceText:
    return joined(cell.split(_SIZES), cell.at) if _SIZES.search(cell.text) else cell


LATEX: Final = GridFormat(_matches, _parse)


# --- Several matrices in one LaTeX text, each with its name: ``A_1 = \begin{bmatrix} … A_2 = …``


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


def named_matrices(source: SourceText) -> list[tuple[SourceText, SourceText]]:
    """Return the matrices of a text as pairs (name, matrix); the name may be empty.

    Raises GridError for an environment without an end, or for text that may change a matrix.
    """
    source = without_comments(source)
    found: list[tuple[SourceText, SourceText]] = []
    after = 0
    innermost = sorted([*_environments(source), *_plain(source)])
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


def _environments(source: SourceText) -> Iterator[tuple[int, int]]:
    """Yield where each environment without another one inside begins and ends."""
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
