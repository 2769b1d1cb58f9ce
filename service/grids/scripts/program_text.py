"""Program text around a matrix: comments, line continuation, prompts, an assignment, a call."""

import re
from dataclasses import dataclass
from typing import Final

from service.grids.cutting.grid import GridError, too_many_rows
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.pairs import BRACKET, CLOSES, split, strict_pairs
from service.grids.cutting.source_text import SourceText, joined

# Functions that make a matrix of their argument and change nothing in it.
MAKERS: Final = frozenset(
    {"array", "asarray", "mat", "matrix", "Matrix", "ImmutableMatrix", "MutableDenseMatrix"}
    | {"ImmutableDenseMatrix", "Array", "list", "tuple", "sym", "simplify", "trigsimp", "expand"}
    | {"trigreduce", "ratsimp"}
)
# Imports, and symbols that are declared.
_STATEMENT: Final = (
    r"[ \t]*(?:(?:import|from|syms|clc|clear|close|format|pkg|load|with)\b.*"
    r"|[\w, \t]{1,80}=[ \t]*(?:\w{1,20}\.)?(?:symbols|Symbol|var|sym)\([^()\[\]{}]{0,200}\)[ \t;]*)"
)
_HARMLESS: Final = re.compile(rf"(?:{_STATEMENT}|[ \t]*)(?:\n|\Z)")
_HARMLESS_LINE: Final = re.compile(rf"^{_STATEMENT}$", re.MULTILINE)
# The left sides of an equation or assignment: T = A1*A2 = …, A1(q1) := …, A1 : …
_NAMES: Final = re.compile(
    r"\s*(?:(?!\d+[.*\s])[\w\\](?:[\w.{}^\\'*@→ \t]|\([\w,:→ ]{0,40}\)|\[\d{1,2}\]){0,80}"
    r"(?::=?|=)(?!=)\s*){0,4}"
    r"(?:\(sym \d+ ?[x×] ?\d+ matrix\)\s*)?"
)
# A name on a line of its own, above what it names: MATLAB's ans =.
_TITLE: Final = re.compile(
    r"\s*(?:[^\W\d][\w{}^]{0,20}(?:\([\w,: ]{0,40}\))?[ \t]*:?=[ \t]*\r?\n\s*){1,3}"
)
_CALL: Final = re.compile(
    r"\s*([A-Za-z_][\w.]{0,60})[ \t]*\(\s*(?=[\[({\d]|[A-Za-z_][\w.]{0,60}\()"
)
# Of the Robotics Toolbox for MATLAB, and of that for Python.
_OF_ROBOTS: Final = frozenset(
    {"Link", "Revolute", "Prismatic", "RevoluteDH", "PrismaticDH", "RevoluteMDH", "PrismaticMDH"}
    | {"SerialLink", "DHRobot"}
)
_MOST_FORMS: Final = 3
_NESTED: Final = re.compile(r"[({]\s*[\[({]|\[|\{\s*['\"]")
_KEYWORD: Final = re.compile(r"\s*(?:dtype|order|copy|ndmin|storage|shape|datatype)\s*=")
# Behind % stands a comment, or the name of a constant in Maxima.
_REMARK: Final = re.compile(
    r"\.\.\.[^\n]*(?:\n|$)|%(?!(?:pi|theta|alpha)(?![A-Za-z]))[^\n]*|#[^\n]*"
)
_COMMENTS: Final = {"(*": "*)", "/*": "*/"}
_REMARK_SIGNS: Final = ("...", "%", "#", *_COMMENTS)
# What begins a remark or a string, and what ends a string.
_SIGN: Final = re.compile(r"""['"\\\n%#]|\.\.\.|[(/]\*""")
# Mathematica: functions that change nothing in a matrix, in front of it or behind.
_FORM: Final = re.compile(
    r"(?:MatrixForm|TraditionalForm|InputForm|Simplify|FullSimplify|TrigReduce|Expand)\["
)
_BEHIND: Final = re.compile(
    r"//\s{0,3}(?:MatrixForm|TraditionalForm|InputForm|Simplify|FullSimplify|TrigReduce|Expand)\Z"
)
TAIL: Final = " \t\r\n;,.$"


@dataclass(frozen=True, slots=True)
class WrittenMatrix:
    """A matrix in program text.

    ``groups`` are the contents of the outermost brackets: one in most texts, several where each
    row has brackets. ``maker`` is the name of the function that takes them, ``shape`` the rows and
    columns that it is given.
    """

    groups: tuple[SourceText, ...]
    maker: str = ""
    shape: tuple[int, int] | None = None


def begins_as_matrix(text: str) -> bool:
    """Whether the text begins with a matrix in brackets, after harmless lines and a name."""
    plain = without_remarks(SourceText.of(text)).text
    return _head(plain) is not None


def without_title(source: SourceText) -> SourceText:
    """The text without a name on a line of its own at the top, as MATLAB prints it."""
    title = _TITLE.match(source.text)
    return source.cut(title.end(), len(source.text)) if title else source


def unwrap(source: SourceText, calls: int = 3) -> WrittenMatrix:
    """The brackets' contents, at most ``calls`` calls deep.

    Raises GridError where the brackets are unbalanced, or are not all of the text.
    """
    source = without_remarks(source)
    head = _head(source.text)
    if head is None:
        message = "No matrix begins here. Paste the matrix alone, each row in brackets."
        raise GridError("no_grid", message, source.whole)
    start, call = head
    source = _without_forms(source.cut(start, len(source.text)).strip(TAIL))
    if call:
        return _unwrap_call(source, call, calls)
    return WrittenMatrix(tuple(_groups(source)))


def _without_forms(source: SourceText) -> SourceText:
    """The matrix without the functions of Mathematica that only change its form."""
    for _ in range(_MOST_FORMS):
        behind = _BEHIND.search(source.text, len(source.text) - 24)
        if behind is None:
            break
        source = source.cut(0, behind.start()).strip(TAIL)
    for _ in range(_MOST_FORMS):
        form = _FORM.match(source.text)
        if form is None or strict_pairs(source)[form.end() - 1] != len(source.text):
            break
        source = source.cut(form.end(), len(source.text) - 1).strip(TAIL)
    return source


def without_remarks(source: SourceText) -> SourceText:
    """The text without comments and line continuations, except those in strings."""
    text = source.text
    if not any(map(text.__contains__, _REMARK_SIGNS)):
        return source
    pieces: list[SourceText] = []
    start = i = 0
    quote = ""
    last = max(map(text.rfind, _COMMENTS.values()))
    while len(pieces) < 2 * GRID_LIMITS.separators and (sign := _SIGN.search(text, i)):
        i, letter = sign.start(), sign[0][0]
        if quote:
            if letter == "\\":
                i += 1
            elif letter in {quote, "\n"}:
                quote = ""
        elif letter in "'\"":
            if i == 0 or not (text[i - 1].isalnum() or text[i - 1] in ")]}.'"):
                quote = letter
        elif letter not in "\\\n" and (end := _remark_end(text, i, last)):
            blank = SourceText(" ", [source.starts[i]], [source.ends[i]])
            pieces += [source.cut(start, i), blank]
            start = i = end
            continue
        i += 1
    return joined([*pieces, source.cut(start, len(text))], source.whole[0])


def _remark_end(text: str, start: int, last: int) -> int:
    """The place behind the remark that begins at ``start``, 0 where none does.

    Behind ``last`` no comment in brackets ends.
    """
    closer = _COMMENTS.get(text[start : start + 2]) if start < last else None
    end = text.find(closer, start + 2) if closer else -1
    if end >= 0:
        return end + 2
    remark = _REMARK.match(text, start)
    return remark.end() if remark else 0


def _head(text: str) -> tuple[int, re.Match[str] | None] | None:
    """The place where a matrix begins, with its first bracket or with the call that makes it."""
    at = behind_names(text)
    at += len(text[at:]) - len(text[at:].lstrip())
    if form := _FORM.match(text, at):
        return (at, None) if _NESTED.match(text, form.end()) else None
    if call := _CALL.match(text, at):
        name = call[1].rpartition(".")[2]
        if name in MAKERS or text[call.end()] == "[":
            return call.start(1), call
    if _NESTED.match(text, at) is None:
        return None
    # Round brackets begin many an expression; they are a list only if they hold all there is.
    if text[at] == "(" and not _ends_the_text(text, at):
        return None
    return at, None


def without_harmless_lines(source: SourceText) -> SourceText:
    """The text without the lines that make no matrix, such as imports."""
    return joined(source.split(_HARMLESS_LINE), source.whole[0])


def behind_names(text: str) -> int:
    """The place behind harmless lines and the left side of an equation, where a matrix begins."""
    at = 0
    while at < len(text) and (line := _HARMLESS.match(text, at)):
        at = line.end()
    names = _NAMES.match(text, at)
    assert names is not None
    return names.end()


def _ends_the_text(text: str, start: int) -> bool:
    depth = 0
    for bracket in BRACKET.finditer(text, start):
        depth += 1 if bracket[0] in CLOSES else -1
        if depth == 0:
            return not text[bracket.end() :].strip(TAIL)
    return False


def _groups(source: SourceText) -> list[SourceText]:
    """The contents of brackets in a row. Raises GridError for anything else."""
    ends = strict_pairs(source)
    groups: list[SourceText] = []
    i = 0
    while i < len(source.text):
        if source.text[i] in CLOSES:
            if len(groups) > GRID_LIMITS.rows:
                raise too_many_rows("more", source.whole)
            groups.append(source.cut(i + 1, ends[i] - 1))
            i = ends[i]
        elif source.text[i] in TAIL:
            i += 1
        else:
            raise text_around(source.cut(i, len(source.text)))
    return groups


def _unwrap_call(source: SourceText, call: re.Match[str], calls: int) -> WrittenMatrix:
    name, inside = call[1].rpartition(".")[2], call.end() - call.start(1)
    if name not in MAKERS or not calls:
        message = f"`{call[1]}(…)` of a matrix is not worked out here. Paste the result."
        if name in _OF_ROBOTS:
            message = (
                f"`{call[1]}(…)` describes a robot and is no matrix. Paste the matrix, worked out."
            )
        raise GridError("unknown_call", message, source.span(0, len(call[1])))
    opened = source.text.index("(")
    ends = strict_pairs(source)
    if ends[opened] != len(source.text):
        raise text_around(source.cut(ends[opened], len(source.text)))
    arguments = split(source.cut(inside, len(source.text) - 1), ",")
    arguments = [argument.strip() for argument in arguments if not _KEYWORD.match(argument.text)]
    arguments = [argument for argument in arguments if argument.text]
    shape = None
    if len(arguments) == 3 and all(_is_small(argument.text) for argument in arguments[:2]):
        shape = int(arguments[0].text), int(arguments[1].text)
        arguments = arguments[2:]
    if len(arguments) == 1 and _CALL.match(arguments[0].text):
        return unwrap(arguments[0], calls - 1)
    groups = [group for argument in arguments for group in _groups(argument)]
    return WrittenMatrix(tuple(groups), name, shape)


def _is_small(text: str) -> bool:
    return text.isascii() and text.isdigit() and len(text) < 3


def text_around(piece: SourceText) -> GridError:
    """The error for text around the matrix that may change its meaning."""
    piece = piece.strip()
    first = piece.text.split("\n", 1)[0][:30]
    shown = "".join(filter(str.isprintable, first)).strip()
    message = "Empty brackets stand next to the matrix. Delete them."
    if piece.text:
        message = "An invisible character stands next to the matrix. Delete it."
    if shown:
        message = (
            f"`{shown}` stands next to the matrix and may change it. Paste the matrix alone, "
            "worked out."
        )
    return GridError("text_around", message, piece.span(0, len(piece.text)))
