"""Assignments above the matrix of a MATLAB script, such as ``a1 = 0.4``.

The matrix is graded with letters, so a number assigned to a letter is ignored, with a note. Any
other assigned value is an error.
"""

import re
import unicodedata
from collections.abc import Sequence, Set
from dataclasses import dataclass
from typing import Final

from dh_grader.expressions.errors import Note
from dh_grader.pasting.program import begins_as_matrix, text_around, without_remarks
from dh_grader.pasting.source import GridError, SourceText
from dh_grader.regex import regex
from dh_grader.translations import say

# The value may be a calculation or a call of a function, but not a matrix or a list.
ASSIGNMENT: Final = regex(
    r"[ \t\r]*(?P<line>(?P<name>[A-Za-z]\w{0,60})[ \t]*=(?!=)[ \t]*"
    r"(?P<value>(?=[^\s])(?:[^;,\n\[\](){}=]|\((?:[^()\n\[]|\[(?!\s?\[)){0,40}\)){1,80}))(?:[;,\n]|\Z)"
)
# An assignment to several letters: d1, d4 = 0.1625, 0.1333.
_LETTER: Final = r"[A-Za-z]\w{0,20}"
_VALUE: Final = r"(?:[^,;=\n()\[\]{}#%]|\([^,;=\n()\[\]{}#%]{0,40}\)){1,40}"
_TUPLE: Final = regex(
    rf"[ \t\r]*(?P<line>\(?(?P<names>{_LETTER}(?:[ \t]*,[ \t]*{_LETTER}){{1,11}})\)?[ \t]*=(?!=)"
    rf"[ \t]*\(?(?P<values>(?! ){_VALUE}(?:,{_VALUE}){{1,11}})\)?)[ \t\r]*"
    r"(?:[#%][^\n]*)?(?:[;\n]|\Z)"
)
_TUPLES: Final = regex(rf"(?:(?<=[;\n])|\A){_TUPLE.pattern}")
_NUMBER: Final = regex(r"[-+]?(?:\d{1,30}\.?\d{0,30}|\.\d{1,30})(?:[eE][-+]?\d{1,3})?")
_HARMLESS: Final = regex(
    r"[ \t\r]*(?:(?:syms|clc|clear|close|format|pkg|load|import|from)\b[^;\n]*)?(?:[;,\n]|\Z)"
)
# A name that is not the left side of an assignment.
# A line above or below a table: "where d1 = 0.135 m, a2 = 0.4 m".
_DEFINITION: Final = (
    r"(?:[^\W\d_]{1,5}_?\d{1,2}|[^\W\d_]_\{\d\}|[^\W\d_][₀-₉])\s{0,4}[=:]\s{0,4}"
    r"[-+−]?(?:\d{1,9}(?:[.,]\d{1,9})?)(?:\s{0,4}(?:°|[^\W\d_]{1,8}))?"
)
_DEFINITIONS: Final = regex(
    r"\s{0,9}(?:(?:where|with|wobei|mit|donde|con|où|avec|其中)\s{0,4}:?\s{0,4})?"
    rf"{_DEFINITION}(?:\s{{0,4}}(?:[,;、]|and|und|y|et|和)\s{{0,4}}{_DEFINITION}){{0,20}}[\s.,;]{{0,9}}",
    re.IGNORECASE,
)
_DEFINED: Final = regex(r"[^\W\d]\w*(?=\s{0,4}[=:])")
_READ: Final = regex(r"(?<!\w)[^\WA-Za-z]*([A-Za-z]\w*)(?!\w|[ \t]*=(?!=))")
# A last statement that shows a matrix or counts its rows: disp(T), print(T), T, n = size(T, 1).
_SHOWS: Final = regex(
    r"(?:[;,\n][ \t]*(?:(?:\w{1,12}\.)?(?:disp|display|pretty|print|pprint)"
    r"\((?:latex\(|simplify\()?[ \t]*\w{1,60}[ \t]*\){1,2}"
    r"|\w{1,60}[ \t]*=[ \t]*(?:size|length|len|height|rows)\([\w, \t]{1,60}\)"
    r"|(?:TableForm|MatrixForm|Print)\[\w{1,60}\]|\w{1,60} ?// ?(?:TableForm|MatrixForm))"
    r"|[;\n][ \t]*[A-Za-z]\w{0,60})\Z"
)
_MOST_SHOWN: Final = 4
# The shorthand of a cosine or sine: c12 = cos(q1 + q2), s_1 = \\sin\\theta_1, c_i = cos θ_i.
_ANGLE: Final = r"\\?(?:theta|th|θ|q|t)_?\{?([\d₀-₉ijk])\}?"
_SHORTHAND: Final = regex(
    r"\$?([cs])_?\{?(\d{1,6}|[ijk]{1,3})\}?\s{0,4}=\s{0,4}\\?(?:\w{1,6}\.)?(cos|sin)\s{0,2}"
    rf"(?:\(\s?({_ANGLE}(?:\s?\+\s?{_ANGLE}){{0,5}})\s?\)|({_ANGLE})(?!\s?[\w+*/-]))\$?"
)
_AROUND_SHORTHANDS: Final = regex(
    r"[\s,;:.]*(?:(?:where|with|using|wobei|mit|donde|con|où|avec|其中|and|und|y|et|etc)[\s,;:.]*){0,9}"
)
_TAIL: Final = " \t\r\n;,"
# The beginning of a matrix on a later line of a script.
_MATRIX: Final = regex(r"\n[ \t]*[A-Za-z]\w{0,40}[ \t]{0,4}=[ \t]{0,4}(?:[\w.]{1,40}\()?[\[]")
_MOST_NAMES: Final = 8


@dataclass(frozen=True, slots=True)
class GivenValue:
    """A value that a script assigns to a letter; ``line`` is the whole statement."""

    name: str
    value: str
    line: SourceText

    @property
    def is_number(self) -> bool:
        """True if the value is a plain number."""
        return _NUMBER.fullmatch(self.value) is not None

    @property
    def is_itself(self) -> bool:
        """True if the statement only declares the letter as a symbol: ``q1 = sym('q1')``."""
        return self.value.startswith((f"sym('{self.name}'", f'sym("{self.name}"'))


def without_given_values(source: SourceText) -> tuple[SourceText, tuple[Note, ...]]:
    """Return the matrix in a script, and a note on numbers that the script assigns to letters.

    Raises GridError if a letter of the matrix has a value that is not a plain number.
    """
    # Any text but a script is returned unchanged.
    plain = without_remarks(source)
    shown = _without_display(plain)
    given, at = _given_values(shown)
    rest = shown.cut(at, len(shown.text))
    if (shown is plain and not at) or not begins_as_matrix(rest.text):
        return source, ()
    return rest, given_numbers_note(given, set(_READ.findall(rest.text)))


def check_script(source: SourceText) -> None:
    """Raise GridError if a text is a script with a statement before its matrix."""
    # Its statements would be read as rows of values.
    plain = without_remarks(source)
    if _MATRIX.search(plain.text):
        _, at = _given_values(plain)
        raise text_around(plain.cut(at, len(plain.text)))


def without_definitions(source: SourceText) -> tuple[SourceText, tuple[Note, ...]]:
    """Return the table without definitions such as ``d1 = 0.135 m``, and a note on definitions."""
    # Any other text is returned unchanged.
    lines = [line for line in source.lines() if line.text.strip()]
    numbers = [_DEFINITIONS.fullmatch(line.text) is not None for line in lines]
    is_definition = [
        given or _defines_shorthands(line.text) for given, line in zip(numbers, lines, strict=True)
    ]
    rows = [line for line, defines in zip(lines, is_definition, strict=True) if not defines]
    if len(rows) < 2 or len(rows) == len(lines):
        return source, ()
    first = is_definition.index(False)
    if any(is_definition[first : first + len(rows)]):
        return source, ()
    start, end = source.starts.index(rows[0].starts[0]), source.starts.index(rows[-1].starts[-1])
    if not any(numbers):
        return source.cut(start, end + 1), ()
    if any("=" in row.text for row in rows):
        return source, ()
    around = [line for line, given in zip(lines, numbers, strict=True) if given]
    names = [name for line in around for name in _DEFINED.findall(line.text)]
    message = say(
        "The numbers of {letters} were not used. The letters were read as the exercise's symbols.",
        letters=", ".join(names[:_MOST_NAMES]) + (", …" if len(names) > _MOST_NAMES else ""),
    )
    note = Note("given_numbers", message, around[0].whole)
    return source.cut(start, end + 1), (note,)


def given_numbers_note(given: Sequence[GivenValue], read: Set[str]) -> tuple[Note, ...]:
    """Return the note on numbers that a script assigns to letters.

    ``read`` are the letters in the cells. Raises GridError if the value of such a letter is not a
    number.
    """
    # That is, a value that is not a plain number.
    for each in given:
        is_known = each.is_number or not _without_shorthands(f"{each.name} = {each.value}")
        if each.name in read and not is_known:
            raise GridError(
                "given_value",
                say(
                    "`{line}` gives {letter} a value, which is not put in here. Write it where the "
                    "letter stands, or delete this line.",
                    line=each.line.text[:40],
                    letter=each.name,
                ),
                each.line.whole,
            )
    numbers = [each for each in given if each.is_number]
    if not numbers:
        return ()
    names = ", ".join(dict.fromkeys(each.name for each in numbers[:_MOST_NAMES]))
    more = ", …" if len(numbers) > _MOST_NAMES else ""
    message = say(
        "The script gives numbers to {letters}; they were not used. The letters were read as the "
        "exercise's symbols.",
        letters=f"{names}{more}",
    )
    span = numbers[0].line.whole[0], numbers[-1].line.whole[1]
    return (Note("given_numbers", message, span),)


def _given_values(source: SourceText) -> tuple[list[GivenValue], int]:
    found: list[GivenValue] = []
    text, at = source.text, 0
    while at < len(text):
        if assignment := ASSIGNMENT.match(text, at):
            line = source.cut(*assignment.span("line")).strip()
            value = GivenValue(assignment["name"], assignment["value"].strip(), line)
            if not value.is_itself:
                found.append(value)
            at = assignment.end()
        elif (several := _TUPLE.match(text, at)) and (pairs := _pairs_of(several)):
            line = source.cut(*several.span("line"))
            found += [GivenValue(*pair, line) for pair in pairs]
            at = several.end()
        elif harmless := _HARMLESS.match(text, at):
            at = harmless.end()
        else:
            break
    return found, at


def _pairs_of(assignment: re.Match[str]) -> list[tuple[str, str]]:
    # Return the letters with their values; [] if their numbers differ.
    names = [name.strip() for name in assignment["names"].split(",")]
    values = [value.strip() for value in assignment["values"].split(",")]
    return [*zip(names, values, strict=True)] if len(names) == len(values) else []


def without_tuples(text: str) -> str:
    """Return the text with one assignment for each letter: ``d1, d4 = 1, 2`` is two lines."""

    def lines(found: re.Match[str]) -> str:
        return "".join(f"{name} = {value}\n" for name, value in _pairs_of(found)) or found[0]

    return _TUPLES.sub(lines, text)


def _without_display(source: SourceText) -> SourceText:
    """Return the text without a last statement such as ``disp(DH)``, which shows the matrix."""
    for _ in range(_MOST_SHOWN):
        stripped = source.strip(_TAIL)
        shown = _SHOWS.search(stripped.text, max(0, len(stripped.text) - 160))
        if shown is None:
            break
        source = stripped.cut(0, shown.start())
    return source


def _without_shorthands(line: str) -> str:
    """Return the text without definitions of shorthands such as ``c12 = cos(q1 + q2)``."""

    def rest(found: re.Match[str]) -> str:
        angles = unicodedata.normalize("NFKC", found[4] or found[7])
        is_right = found[3].startswith(found[1]) and "".join(re.findall(_ANGLE, angles)) == found[2]
        return "" if is_right else found[0]

    return _SHORTHAND.sub(rest, line)


def _defines_shorthands(line: str) -> bool:
    """True if a line only defines shorthands: where c1 = cos(q1) and s1 = sin(q1)."""
    rest = _without_shorthands(line)
    return rest != line and _AROUND_SHORTHANDS.fullmatch(rest) is not None
