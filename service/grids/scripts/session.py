"""Read the outputs of an interpreter session.

Prompts and labels of outputs are ``>> A1``, ``Out[3]//MatrixForm=``, ``(%o4)`` and the like.
"""

# Inputs that have no output are kept, too.

import re
from typing import Final

from service.grids.cutting.pairs import CLOSES
from service.grids.cutting.source_text import SourceText, joined
from service.regex import regex

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
