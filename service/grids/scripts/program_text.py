"""Remove the program text around a matrix: comments, line continuations, assignments, calls."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from service.grids.cutting.grid import GridError, too_many_rows
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.once import once
from service.grids.cutting.pairs import BRACKET, CLOSES, split, strict_pairs
from service.grids.cutting.source_text import SourceText, joined
from service.regex import regex
from service.translations import say

# Functions that make a matrix of their argument without changing its values.
MAKERS: Final = frozenset(
    {"array", "asarray", "mat", "matrix", "Matrix", "ImmutableMatrix", "MutableDenseMatrix"}
    | {"ImmutableDenseMatrix", "Array", "list", "tuple", "sym", "simplify", "trigsimp", "expand"}
    | {"trigreduce", "ratsimp", "SE3"}
)
# Imports, and declarations of symbols.
_STATEMENT: Final = (
    r"[ \t]*(?:(?:import|from|syms|clc|clear|close|format|pkg|load|with)\b.*"
    r"|def \w{1,40}\([^()\n]{0,100}\)[^()\n:]{0,40}:[ \t]*"
    r"|(?:\w{1,12}\.)?(?:print|pprint|disp|display)\([^()\n]{0,100}\)[ \t;]*"
    r"|[\w, \t]{1,80}=[ \t]*(?:\w{1,20}\.)?(?:(?:dynamic)?symbols|Symbol|var|sym)"
    r"\([^()\[\]{}]{0,200}\)[ \t;]*)"
)
_HARMLESS: Final = regex(rf"(?:{_STATEMENT}|[ \t]*)(?:\n|\Z)")
_HARMLESS_LINE: Final = regex(rf"^{_STATEMENT}$", re.MULTILINE)
# The left sides of an equation or assignment: T = A1*A2 = …, A1(q1) := …, A1 : …
_NAMES: Final = regex(
    r"\s*(?:return\s|(?:const )?std::vector<[\w:<>, ]{1,60}>\s)?"
    r"(?:(?!\d+[.*\s])[\w\\](?:[\w.{}^\\'*@→ \t]|\([\w,:→ ]{0,40}\)|\[\d{1,2}\]){0,80}"
    r"(?::=?|=)(?!=)\s*){0,4}"
    r"(?:\(sym \d+ ?[x×] ?\d+ matrix\)\s*)?"
)
# A function of MATLAB, Octave or Julia: function R = rotx(phi) … end.
_FUNCTION: Final = regex(
    r"\s*function\s+(?:\[?(?P<output>\w{1,40})\]?\s*=\s*)?\w{1,40}\s*"
    r"(?:\([\w, ~]{0,100}\))?[ \t]*[\n;,](?P<body>(?s:.)*?)(?:(?<=[\s;])end(?:function)?[\s;]*)?"
)
# A function of Python: its first line, its last line, and lines below it that only call it.
_DEF: Final = regex(r"def \w{1,40}\([^()\n]{0,200}\)[^()\n]{0,60}:[ \t]*(?:#.*)?\r?$")
_RETURN: Final = regex(r"[ \t]+return[ \t]+\(?([A-Za-z]\w{0,40})\)?[ \t;]*(?:#.*)?\r?")
_CALLS: Final = regex(
    r"[ \t]*(?:#.*|(?:[A-Za-z]\w{0,40}[ \t]*=[ \t]*)?(?:\w{1,20}\.)?\w{1,40}\([^@*/+\n]*\)"
    r"|if __name__ ?== ?['\"]__main__['\"]:.*)?\s*"
)
_ASSIGNED: Final = regex(r"[ \t]*([A-Za-z]\w{0,40})[ \t]*=(?!=)")
_UNPACKED: Final = regex(
    r"[ \t]*[(\[]?(?P<names>[A-Za-z]\w{0,20}(?:[ \t]{0,4},[ \t]{0,4}[A-Za-z]\w{0,20}){1,11})[)\]]?"
    r"[ \t]*=[ \t]*\w{1,20}[ \t;]*(?:#.*)?\r?"
)
_LAST_NUMBER: Final = regex(r"(\d{1,2})\Z")
_RETURNS: Final = regex(r"[ \t]+return(?!\w)")
# A name on a line of its own above its value: MATLAB's ``ans =``.
_TITLE: Final = regex(
    r"\s*(?:[^\W\d][\w{}^]{0,20}(?:\([\w,: ]{0,40}\))?[ \t]*:?=[ \t]*\r?\n\s*){1,3}"
)
_CALL: Final = regex(r"\s*([A-Za-z_][\w.]{0,60})[ \t]*\(\s*(?=[\[({\d]|[A-Za-z_][\w.]{0,60}\()")
# Classes of the Robotics Toolboxes for MATLAB and for Python.
_ROBOT_CLASSES: Final = frozenset(
    {"Link", "Revolute", "Prismatic", "RevoluteDH", "PrismaticDH", "RevoluteMDH", "PrismaticMDH"}
    | {"SerialLink", "DHRobot"}
)
_MOST_FORMS: Final = 3
_NESTED: Final = regex(r"[({]\s*[\[({]|\[|\{\s*['\"]")
_KEYWORD: Final = regex(r"\s*(?:dtype|order|copy|ndmin|storage|shape|datatype)\s*=")
# A comment after % or #. In Maxima, % begins the name of a constant.
_REMARK: Final = regex(
    r"\.\.\.[^\n]*(?:\n|$)|//[^\n]*|%(?!(?:pi|theta|alpha)(?![A-Za-z]))[^\n]*|#[^\n]*"
)
_COMMENTS: Final = {"(*": "*)", "/*": "*/"}
_REMARK_SIGNS: Final = ("...", "%", "#", "//", *_COMMENTS)
# What begins a remark or a string. In Scilab, // begins a comment after a statement or on a line of
# its own; elsewhere it is a division.
_SIGN: Final = regex(
    r"""(?:['"%#]|\.\.\.|(?:\A[ \t]{0,40}|(?<=[;\n])[ \t]{0,39})(?P<slashes>//)|[(/]\*)"""
)
# A string, which ends with its line if its quotation mark is missing.
_STRINGS: Final = {
    quote: regex(rf"{quote}(?:[^\\{quote}\n]|\\.)*(?:{quote}|\n|\\?\Z)", re.DOTALL)
    for quote in ("'", '"')
}
# Mathematica's functions that leave a matrix equal, written before it or after it.
_FORM: Final = regex(
    r"(?:MatrixForm|TraditionalForm|InputForm|Simplify|FullSimplify|TrigReduce|Expand)\["
)
_FORM_AFTER: Final = regex(
    r"//\s{0,3}(?:MatrixForm|TraditionalForm|InputForm|Simplify|FullSimplify|TrigReduce|Expand)\Z"
)
TAIL: Final = " \t\r\n;,.$"


@dataclass(frozen=True, slots=True)
class WrittenMatrix:
    """A matrix in program text.

    ``groups`` are the texts in its outermost brackets: usually one, or one for each row. ``maker``
    is the name of the function around the brackets. ``shape`` has the numbers of rows and columns
    from the function's arguments.
    """

    groups: tuple[SourceText, ...]
    maker: str = ""
    shape: tuple[int, int] | None = None


@once
def begins_as_matrix(text: str) -> bool:
    """True if a matrix in brackets begins the text, possibly after imports and a name."""
    plain = without_remarks(SourceText.of(text)).text
    return _head(plain) is not None


def without_title(source: SourceText) -> SourceText:
    """Return the text without a first line that is only a name, such as ``ans =``."""
    title = _TITLE.match(source.text)
    return source.cut(title.end(), len(source.text)) if title else source


def without_function(source: SourceText) -> SourceText:
    """Return the body of the one function in a text, if the body sets the function's output."""
    found = _FUNCTION.fullmatch(source.text)
    if found is None or "function" in found["body"]:
        return _without_def(source)
    body = source.cut(*found.span("body"))
    output = found["output"]
    is_output = re.compile(rf"(?:^|;)[ \t]*(?:return\s|{output or 'return'}[ \t]*=)", re.MULTILINE)
    return body if not output or is_output.search(body.text) else source


def _without_def(source: SourceText) -> SourceText:
    """Return the statements of the one function of Python in a text that returns a matrix.

    Calls below the function are left out. Any other text is returned unchanged.
    """
    lines = source.lines()
    heads = [i for i, line in enumerate(lines) if _DEF.match(line.text)]
    if len(heads) != 1:
        return source
    [head] = heads
    after = next((i for i in range(head + 1, len(lines)) if lines[i].text[:1].strip()), len(lines))
    body = [i for i in range(head + 1, after) if lines[i].text.strip()]
    returns = [i for i in body if _RETURNS.match(lines[i].text)]
    if len(returns) != 1 or not all(_CALLS.fullmatch(line.text) for line in lines[after:]):
        return source
    returned = _RETURN.fullmatch(lines[body[-1]].text)
    if returned is None and "[" not in lines[returns[0]].text:
        return source
    first, last = body[0], body[-1] if returned else body[-1] + 1
    kept = [line for line in lines[first:last] if not _unpacks(line.text)]
    names = [found[1] for line in kept if (found := _ASSIGNED.match(line.text))]
    if returned and names.count(returned[1]) != 1:
        return source
    pieces = [*lines[:head], *kept]
    return joined([each for line in pieces for each in (line, line.spelled("\n"))], source.at)


def _unpacks(line: str) -> bool:
    """True if a line names the elements of an argument in order: ``q1, q2, q3 = q``."""
    unpacked = _UNPACKED.fullmatch(line)
    names = unpacked["names"].split(",") if unpacked else []
    numbers = [found[1] for name in names if (found := _LAST_NUMBER.search(name.strip()))]
    return bool(names) and numbers == [str(i + 1) for i in range(len(names))]


def unwrap(source: SourceText, calls: int = 3) -> WrittenMatrix:
    """Return the matrix in a text, without the program text around it.

    Raises GridError for unbalanced brackets, or for other text next to the matrix.
    """
    # At most ``calls`` function calls may enclose the matrix.
    source = without_remarks(source)
    head = _head(source.text)
    if head is None:
        message = say("No matrix begins here. Paste the matrix alone, each row in brackets.")
        raise GridError("no_grid", message, source.whole)
    start, call = head
    source = _without_forms(source.cut(start, len(source.text)).strip(TAIL))
    if call:
        return _unwrap_call(source, call, calls)
    return WrittenMatrix(tuple(_groups(source)))


def _without_forms(source: SourceText) -> SourceText:
    for _ in range(_MOST_FORMS):
        form = _FORM_AFTER.search(source.text, len(source.text) - 24)
        if form is None:
            break
        source = source.cut(0, form.start()).strip(TAIL)
    for _ in range(_MOST_FORMS):
        form = _FORM.match(source.text)
        if form is None or strict_pairs(source)[form.end() - 1] != len(source.text):
            break
        source = source.cut(form.end(), len(source.text) - 1).strip(TAIL)
    return source


def without_remarks(source: SourceText) -> SourceText:
    """Return the text without comments and line continuations; strings stay as they are."""
    pieces: list[SourceText] = []
    start = 0
    for i, end in _remarks(source.text):
        blank = source.cut(i, i + 1).spelled(" ")
        pieces += [source.cut(start, i), blank]
        start = end
    if not pieces:
        return source
    return joined([*pieces, source.cut(start, len(source.text))], source.whole[0])


@once
def _remarks(text: str) -> list[tuple[int, int]]:
    # Return where each comment and each continuation of a line begins and ends.
    if not any(map(text.__contains__, _REMARK_SIGNS)):
        return []
    found: list[tuple[int, int]] = []
    i = 0
    last = {opener: text.rfind(closer) for opener, closer in _COMMENTS.items()}
    while len(found) < GRID_LIMITS.separators and (sign := _SIGN.search(text, i)):
        i = sign.start("slashes") if sign["slashes"] else sign.start()
        letter = text[i]
        if letter in "'\"":
            is_string = i == 0 or not (text[i - 1].isalnum() or text[i - 1] in ")]}.'")
            string = _STRINGS[letter].match(text, i) if is_string else None
            i = string.end() if string else i + 1
        elif end := _remark_end(text, i, last):
            found.append((i, end))
            i = end
        else:
            i += 1
    return found


def _remark_end(text: str, start: int, last: Mapping[str, int]) -> int:
    # Return the place after the remark that begins at ``start``, or 0 if none begins there.
    # ``last`` is the last place at which a block comment of each kind ends.
    opener = text[start : start + 2]
    if opener in _COMMENTS:
        closer = _COMMENTS[opener]
        return text.index(closer, start + 2) + 2 if start + 2 <= last[opener] else 0
    remark = _REMARK.match(text, start)
    return remark.end() if remark else 0


def _head(text: str) -> tuple[int, re.Match[str] | None] | None:
    at = after_names(text)
    at += len(text[at:]) - len(text[at:].lstrip())
    if form := _FORM.match(text, at):
        return (at, None) if _NESTED.match(text, form.end()) else None
    if call := _CALL.match(text, at):
        name = call[1].rpartition(".")[2]
        if name in MAKERS or text[call.end()] == "[":
            return call.start(1), call
    if _NESTED.match(text, at) is None:
        return None
    # Round brackets also begin expressions; they are a list only if they enclose the whole text.
    if text[at] == "(" and not _ends_the_text(text, at):
        return None
    return at, None


def without_harmless_lines(source: SourceText) -> SourceText:
    """Return the text without imports and declarations."""
    return joined(source.split(_HARMLESS_LINE), source.whole[0])


def after_names(text: str) -> int:
    """Return the position after imports, declarations and the left side of an equation."""
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
    ends = strict_pairs(source)
    groups: list[SourceText] = []
    i = 0
    while i < len(source.text):
        if source.text[i] in CLOSES:
            if len(groups) > GRID_LIMITS.rows:
                raise too_many_rows(source.whole)
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
        message = say(
            "`{function}(…)` of a matrix is not worked out here. Paste the result.",
            function=call[1],
        )
        if name in _ROBOT_CLASSES:
            message = say(
                "`{function}(…)` describes a robot and is no matrix. Paste the matrix, worked out.",
                function=call[1],
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
    """Return the error for text next to a matrix that may change the matrix's meaning."""
    piece = piece.strip()
    first = piece.text.split("\n", 1)[0][:30]
    shown = "".join(filter(str.isprintable, first)).strip()
    message = say("Empty brackets stand next to the matrix. Delete them.")
    if piece.text:
        message = say("An invisible character stands next to the matrix. Delete it.")
    if shown:
        message = say(
            "`{text}` stands next to the matrix and may change it. Paste the matrix alone, "
            "worked out.",
            text=shown,
        )
    return GridError("text_around", message, piece.span(0, len(piece.text)))
