"""The text of programs around an answer: statements, strings, sessions, names.

Programs are never run; they are cut into statements with the place of each character. What the
statements for a robot mean is in ``robots.py``.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

from dh_grader.pasting.source import (
    BRACKET,
    CLOSES,
    GRID_LIMITS,
    GridError,
    SourceText,
    joined,
    once,
    split,
    strict_pairs,
    too_many_rows,
)
from dh_grader.regex import regex
from dh_grader.translations import say

# --- Remove the program text around a matrix: comments, line continuations, assignments, calls


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
_LEFT_SIDES: Final = regex(
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
_CALL_OF_MATRIX: Final = regex(
    r"\s*([A-Za-z_][\w.]{0,60})[ \t]*\(\s*(?=[\[({\d]|[A-Za-z_][\w.]{0,60}\()"
)
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
    if call := _CALL_OF_MATRIX.match(text, at):
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
    names = _LEFT_SIDES.match(text, at)
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
    if len(arguments) == 1 and _CALL_OF_MATRIX.match(arguments[0].text):
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
            "`{text}` stands next to the table or matrix and may change it. Paste it alone, "
            "worked out.",
            text=shown,
        )
    return GridError("text_around", message, piece.span(0, len(piece.text)))


# --- Split a script in MATLAB or Python into statements and calls


_ENDS: Final = ";,\n\r\x85\u2028\u2029"
# Lines that begin or end a block comment: %{ and %} in MATLAB, triple quotes in Python.
_BLOCK: Final = regex(r"[ \t]*(%\{|%\}|\"\"\"|''')?")
_CALL: Final = regex(r"(?:[A-Za-z_]\w{0,60}\.){0,4}([A-Za-z_]\w{0,60})[ \t]*\(")
_LONGEST_EXCERPT: Final = 40
# Blanks other than those of ASCII and the ends of lines: web pages have them in programs.
_BLANK: Final = regex(r"[^\S\x00-\x20\x85\u2028\u2029]")


def statements(source: SourceText) -> list[SourceText]:
    """Return the statements of a script in order, without comments.

    Raises GridError for unbalanced brackets, and for too many brackets.
    """
    # Brackets may span several lines.
    source = replace(source, text=_BLANK.sub(" ", source.text))
    plain = without_remarks(_without_blocks(without_prompts(source)))
    if sum(map(plain.text.count, CLOSES)) > GRID_LIMITS.separators:
        raise unread_script(
            say(
                "This script has more than {most:,} brackets. Paste only its links.",
                most=GRID_LIMITS.separators,
            ),
            source,
        )
    pieces = (piece.strip() for piece in split(plain, _ENDS))
    return [piece for piece in pieces if piece.text]


def _without_blocks(source: SourceText) -> SourceText:
    """Return the text without block comments."""
    if not any(mark in source.text for mark in ("%{", '"""', "'''")):
        return source
    return joined(_outside_blocks(source), source.at)


def _outside_blocks(source: SourceText) -> Iterator[SourceText]:
    closer = ""
    for line in source.lines():
        mark = _BLOCK.match(line.text)
        found = (mark and mark[1]) or ""
        if closer:
            closer = "" if closer in line.text else closer
        elif found and found != "%}":
            rest = line.text.partition(found)[2]
            closer = "%}" if found == "%{" else found
            closer = "" if closer in rest else closer
        else:
            yield line
        yield line.cut(0, 0).spelled("\n")


def split_call(source: SourceText) -> tuple[str, SourceText] | None:
    """Return a function's name and the text of its arguments; None if the text is not one call.

    Raises GridError for unbalanced brackets.
    """
    # Module names before the function's name, as in ``rtb.RevoluteDH(…)``, are left out.
    call = _CALL.match(source.text)
    if call is None or strict_pairs(source)[call.end() - 1] != len(source.text):
        return None
    return call[1], source.cut(call.end(), len(source.text) - 1)


def arguments(inside: SourceText) -> list[SourceText]:
    """Return the arguments of a call, or the elements of a list."""
    pieces = (piece.strip() for piece in split(inside, ","))
    return [piece for piece in pieces if piece.text]


def unread_script(message: str, source: SourceText) -> GridError:
    """Return the error for a script whose DH table is not certain."""
    return GridError("unread_script", message, source.whole)


def excerpt(source: SourceText) -> str:
    """Return the beginning of a piece of a script, to quote it in a message."""
    text = " ".join("".join(c if c.isprintable() else " " for c in source.text).split())
    return text if len(text) <= _LONGEST_EXCERPT else text[: _LONGEST_EXCERPT - 1] + "…"


# --- Strings of a program, in quotation marks


# A character in UTF-16, of one or two units, or an escaped punctuation mark.
_ESCAPE: Final = regex(
    r"\\(?:(u[dD][89abAB][0-9A-Fa-f]{2}\\u[dD][c-fC-F][0-9A-Fa-f]{2}|u[0-9A-Fa-f]{4})|([\\\"'/]))"
)


def unquoted(cell: SourceText) -> SourceText:
    """Return the cell without the quotation marks of a string, and with its escapes decoded."""
    # An escape that may begin a LaTeX command is not decoded: "\theta" stays \theta, though a
    # program would read a tab in it.
    quote = cell.text[:1]
    if quote not in {"'", '"'} or len(cell.text) < 2 or not cell.text.endswith(quote):
        return cell
    inner = cell.cut(1, len(cell.text) - 1)
    return inner.replaced(_ESCAPE, _decoded)


def _decoded(inner: SourceText, escape: re.Match[str]) -> list[SourceText]:
    letter = escape[2]
    if units := escape[1]:
        letter = bytes.fromhex(re.sub(r"[\\u]", "", units)).decode("utf-16-be", "replace")
    return [inner.cut(*escape.span()).spelled(letter)]


# --- Read the outputs of an interpreter session
#
# Prompts and labels of outputs are ``>> A1``, ``Out[3]//MatrixForm=``, ``(%o4)`` and the like.
# Inputs that have no output are kept, too.


_MARK: Final = regex(
    r"^[ \t]*(?:(?P<input>(?:Trial|EDU)?>>>?|In ?\[\d{0,5}\] ?:=?|\(?%i\d{1,5}\)?|octave:\d{1,5}>"
    r"|sage:|julia>)"
    r"|Out ?\[\d{0,5}\] ?(?://\w{1,20})?[=:]|\(?%o\d{1,5}\)?)[ \t]*",
    re.MULTILINE,
)
# Python's prompt before the second and later lines of an input.
_CONTINUED: Final = regex(r"^[ \t]*\.\.\.(?:[ \t]|$)", re.MULTILINE)
# An input that shows the value of a name: A1, print(A1), A1 // MatrixForm.
_ASKED: Final = regex(r"\s*(?:\w{1,20}[(\[]\s*)?([A-Za-z_]{1,10}\d{1,4})(?![\w.*@+-])")


def session_outputs(source: SourceText, *, named: bool = False) -> SourceText:
    """Return the outputs of a session, and the matrices in inputs without an output."""
    # With ``named``, the name in an input such as ``A1`` or ``simplify(A1)`` becomes a line above
    # the output.
    marks = list(_MARK.finditer(source.text))
    if not marks:
        return source
    pieces = [source.cut(0, marks[0].start())]
    for i, mark in enumerate(marks):
        following = marks[i + 1] if i + 1 < len(marks) else None
        region = source.cut(mark.end(), following.start() if following else len(source.text))
        line_end = source.cut(mark.start(), mark.start() + 1).spelled("\n")
        if mark["input"]:
            end = _statement_end(region.text)
            output = region.cut(end, len(region.text))
            has_output = output.text.strip() or (following and not following["input"])
            if has_output and named and (asked := _ASKED.match(region.cut(0, end).text)):
                pieces += [line_end, region.cut(*asked.span(1)), line_end]
            if has_output:
                region = output
            elif "[" not in region.text and "{" not in region.text:
                continue
            elif mark["input"] == ">>>":
                region = _without_continuation(region)
        pieces += [line_end, region]
    return joined(pieces, source.whole[0])


def without_prompts(source: SourceText) -> SourceText:
    """Return the inputs and outputs of a session without the prompts."""
    if not _MARK.search(source.text):
        return source
    plain = joined(source.split(_MARK), source.at)
    return _without_continuation(plain) if ">>>" in source.text else plain


def _statement_end(text: str) -> int:
    # Return the end of the first line, or of the line that closes the first line's brackets.
    depth = 0
    for i, letter in enumerate(text):
        if letter in CLOSES:
            depth += 1
        elif letter in ")]}":
            depth -= 1
        elif letter == "\n" and depth <= 0:
            return i
    return len(text)


def _without_continuation(statement: SourceText) -> SourceText:
    return joined(statement.split(_CONTINUED), statement.at)


# --- Names of a script for symbols with other names: ``t1 = symbols('theta1')``
#
# The symbols are those of the exercise, so each name is replaced by its symbol wherever it stands.
# Declarations without another name, such as ``q1, q2 = symbols('q1 q2')``, are left to the readers.


_NAME: Final = r"[A-Za-z_θα]\w{0,30}"
_DECLARES: Final = regex(
    rf"(?:^|(?<=;))[ \t]{{0,40}}(?:>>>?[ \t]?|In ?\[\d{{1,4}}\]: ?)?"
    rf"(?P<statement>\(?(?P<names>{_NAME}"
    rf"(?:[ \t]{{0,4}},[ \t]{{0,4}}{_NAME}){{0,23}})"
    r"[ \t]{0,4},?\)?[ \t]{0,8}=[ \t]{0,8}"
    r"(?:\w{1,20}\.){0,2}(?P<function>(?:dynamic)?symbols|Symbol|var|sym)"
    r"\([ \t]{0,4}[rRuU]?(?P<quote>['\"])(?P<symbols>[^'\"\n]{1,300})(?P=quote)"
    r"(?P<options>[^()\n]{0,100})\)[ \t]{0,40})(?=[;\r\n#%]|\Z)",
    re.MULTILINE,
)
# One of these is in the name of each function.
_FUNCTIONS: Final = ("ym", "var")
# A name in a formula, perhaps with an index. Names of arguments, and names in strings and comments,
# are no symbols.
_USE: Final = regex(
    r"(?<![\w)\]}'])'[^'\n]*'|\"[^\"\n]*\"|[#%][^\n]*"
    rf"|(?<![\w.\\])(?P<name>{_NAME})(?!\w)(?!\s{{0,4}}=(?!=))(?P<index>\[\s?\d{{1,2}}\s?\])?"
)
# A numbered list of symbols in SymPy: q1:4 is q1, q2, q3, and q:3 is q0, q1, q2.
_RANGE: Final = regex(r"(?P<stem>[^\W\d]\w*?)(?P<first>\d{0,2}):(?P<end>\d{1,2})")
_SYMBOL: Final = regex(r"\\{0,2}[^\W\d]\w{0,30}(?:\{\w{1,6}\})?")
_SIZE: Final = regex(r"\s*,\s*[\[\d]")
_MOST: Final = 60


def with_own_symbols(source: SourceText) -> SourceText:
    """Return a script with its symbols instead of other names for them.

    Raises GridError if it is not certain which symbol a name means.
    """
    if not any(word in source.text for word in _FUNCTIONS):
        return source
    declared = [each for each in _DECLARES.finditer(source.text) if _is_other(each)][:_MOST]
    if not declared:
        return source
    meant: dict[str, str] = {}
    for each in declared:
        for name, symbol in _meanings(source, each):
            if meant.setdefault(name, symbol) != symbol:
                raise _uncertain(source, each)
    pieces, start = [], 0
    for each in declared:
        pieces += [source.cut(start, each.start("statement"))]
        start = each.end("statement")
    pieces.append(source.cut(start, len(source.text)))
    return joined([named for piece in pieces for named in _renamed(piece, meant)], source.at)


def _is_other(declaration: re.Match[str]) -> bool:
    # True if a name has another symbol than itself.
    # In MATLAB, sym('q', [1 3]) is the vector of q1, q2, q3.
    is_vector = _SIZE.match(declaration["options"]) is not None
    return not is_vector and _names(declaration) != _symbols(declaration)


def _names(declaration: re.Match[str]) -> list[str]:
    return [name.strip() for name in declaration["names"].split(",")]


def _symbols(declaration: re.Match[str]) -> list[str]:
    written = declaration["symbols"]
    if declaration["function"] in {"Symbol", "sym"}:
        return [written.strip()]
    words = re.split(r"[\s,]+", written.strip(" ,"))
    return [symbol for word in words for symbol in _numbered(word)]


def _numbered(word: str) -> list[str]:
    numbers = _RANGE.fullmatch(word.replace("(", "").replace(")", ""))
    if numbers is None:
        return [word]
    first = int(numbers["first"] or 0)
    return [f"{numbers['stem']}{i}" for i in range(first, int(numbers["end"]))]


def _meanings(source: SourceText, declaration: re.Match[str]) -> Iterator[tuple[str, str]]:
    names, symbols = _names(declaration), _symbols(declaration)
    if not all(map(_SYMBOL.fullmatch, symbols)):
        raise _uncertain(source, declaration)
    symbols = [symbol.replace("\\\\", "\\") for symbol in symbols]
    if len(names) == 1 and len(symbols) > 1:
        # The name of a tuple, whose indices count from 0.
        yield from ((f"{names[0]}[{i}]", symbol) for i, symbol in enumerate(symbols))
    elif len(names) == len(symbols):
        yield from zip(names, symbols, strict=True)
    else:
        raise _uncertain(source, declaration)


def _renamed(piece: SourceText, meant: Mapping[str, str]) -> Sequence[SourceText]:
    found, start = [], 0
    for use in _USE.finditer(piece.text):
        name = use["name"] or ""
        index = "".join((use["index"] or "").split())
        symbol = meant.get(name + index)
        end = use.end()
        if symbol is None and name in meant:
            symbol, end = meant[name], use.end("name")
        if symbol is not None:
            found += [piece.cut(start, use.start()), piece.cut(use.start(), end).spelled(symbol)]
            start = end
    return [*found, piece.cut(start, len(piece.text))]


def _uncertain(source: SourceText, declaration: re.Match[str]) -> GridError:
    line = source.cut(*declaration.span("statement")).strip()
    message = say(
        "`{line}` gives symbols other names in a way that is not followed here. Write the symbols "
        "of the exercise into the table or matrix itself.",
        line=line.text[:60],
    )
    return GridError("given_value", message, line.whole)


# --- Remove the style of names before values: ``- **T** =``, ``\boxed{T = …}``, ``T matrix``


_NAME_OF_VALUE: Final = r"\\?[^\W\d]\w{0,11}(?:\{\w{1,6}\})?"
# A bullet or bold type before a name and its sign; elsewhere "-" and "*" may belong to a value.
_STYLED: Final = regex(
    rf"^[ \t]*(?:[-*•‣◦][ \t]{{1,4}})?(?P<bold>\*\*|__)?(?P<name>{_NAME_OF_VALUE})[ \t]{{0,4}}"
    r"(?P<closed>(?P=bold))?[ \t]{0,4}(?P<sign>[=:])(?!=)(?P<open>(?P=bold))?"
    r"(?P<value>[^\n]*)",
    re.MULTILINE,
)
_BEGINS_VALUE: Final = regex(r"[*_\s]{0,8}(?:[\[(\\$]|\w{1,8}\.\w{1,8}\(|\Z)")
_BULLET: Final = regex(r"[ \t]*[-*•‣◦][ \t]")
_BOXED: Final = regex(
    r"^[ \t]*(?P<dollars>\${0,2})[ \t]*\\boxed[ \t]*\{(?P<inner>[^\n]*)\}[ \t]*(?P=dollars)[ \t]*$",
    re.MULTILINE,
)
# A matrix may begin on the line below its heading.
_MATRIX: Final = regex(
    r"^[ \t]*(?:(?:the|homogeneous|transformation|rotation)[ \t]){0,3}"
    r"(?:(?P<before>[A-Z]_?\w{0,5})[ \t]matrix|matrix[ \t](?P<after>[A-Z]_?\w{0,5}))"
    r"[ \t]*(?:\r?\n)?[ \t]*(?=\[|\\begin\{[bpv]?matrix\}|(?:\w{1,8}\.)?(?:array|[mM]atrix)\()",
    re.MULTILINE | re.IGNORECASE,
)


def without_styles(source: SourceText) -> SourceText:
    """Return the text with plain names: ``- **T** = [`` and ``T matrix [`` become ``T = [``."""
    unboxed = source.replaced(_BOXED, _inside_box)
    return unboxed.replaced(_STYLED, _plain_name).replaced(_MATRIX, _plain_heading)


def _inside_box(source: SourceText, box: re.Match[str]) -> list[SourceText] | None:
    is_whole = "=" in box["inner"] and _is_balanced(box["inner"])
    return [source.cut(*box.span("inner"))] if is_whole else None


def _is_balanced(text: str) -> bool:
    depth = 0
    for letter in text:
        depth += (letter == "{") - (letter == "}")
        if depth < 0:
            return False
    return depth == 0


def _plain_name(source: SourceText, found: re.Match[str]) -> list[SourceText] | None:
    start, end = found.span("value")
    if found["sign"] == ":" and not _BEGINS_VALUE.match(found["value"]):
        # A sentence after its heading.
        return None
    if found["bold"]:
        if found["closed"] is None and found["open"] is None:
            # The whole line is bold.
            stripped = found["value"].rstrip()
            if not stripped.endswith(found["bold"]):
                return None
            end = start + len(stripped) - len(found["bold"])
    elif not _BULLET.match(found[0]):
        return None
    places = found.span("name"), found.span("sign"), (start, end)
    return [source.cut(*place) for place in places]


def _plain_heading(source: SourceText, found: re.Match[str]) -> list[SourceText]:
    name = source.cut(*found.span("before" if found["before"] else "after"))
    return [name, name.spelled(" = ")]
