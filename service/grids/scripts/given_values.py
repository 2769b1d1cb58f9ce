"""A MATLAB script that gives letters values before it writes out its matrix.

The letters of a matrix stand for the exercise's symbols, and so a number that a script gives one is
left aside, with a note. Any other value may be needed to read the matrix: it is refused.
"""

import re
from collections.abc import Sequence, Set
from dataclasses import dataclass
from typing import Final

from service.expressions.errors import Note
from service.grids.cutting.grid import GridError
from service.grids.cutting.source_text import SourceText
from service.grids.scripts.program_text import begins_as_matrix, without_remarks

# A value other than a matrix or a list: the characters of a calculation, or a call of a function.
ASSIGNMENT: Final = re.compile(
    r"[ \t\r]*(?P<line>(?P<name>[A-Za-z]\w{0,60})[ \t]*=(?!=)[ \t]*"
    r"(?P<value>(?=[^\s])(?:[^;,\n\[\](){}=]|\([^()\n]{0,40}\)){1,80}))(?:[;,\n]|\Z)"
)
_NUMBER: Final = re.compile(r"[-+]?(?:\d{1,30}\.?\d{0,30}|\.\d{1,30})(?:[eE][-+]?\d{1,3})?")
_HARMLESS: Final = re.compile(
    r"[ \t\r]*(?:(?:syms|clc|clear|close|format|pkg|load)\b[^;\n]*)?(?:[;,\n]|\Z)"
)
# A name that is read, and not given a value.
_READ: Final = re.compile(r"[A-Za-z]\w*(?!\w|[ \t]*=(?!=))")
_SHOWS: Final = re.compile(r"(?:disp|display|pretty)\(\w{1,60}\)\Z")
_TAIL: Final = " \t\r\n;,"
_TOLD: Final = 8


@dataclass(frozen=True, slots=True)
class GivenValue:
    """``line`` is the statement that gives the letter ``name`` its ``value``."""

    name: str
    value: str
    line: SourceText

    @property
    def is_number(self) -> bool:
        """Whether the value is a plain number."""
        return _NUMBER.fullmatch(self.value) is not None

    @property
    def is_itself(self) -> bool:
        """Whether the letter is only declared as a symbol: ``q1 = sym('q1')``."""
        return self.value[:3] == "sym" and self.value[5:-2] == self.name


def without_given_values(source: SourceText) -> tuple[SourceText, tuple[Note, ...]]:
    """The matrix of a script without the statements around it, and a note on their numbers.

    Any other text stays as it is. Raises GridError where a letter of the matrix is given a value
    that is no plain number.
    """
    plain = without_remarks(source)
    shown = _without_display(plain)
    given, at = _given_values(shown)
    rest = shown.cut(at, len(shown.text))
    if (shown is plain and not given) or not begins_as_matrix(rest.text):
        return source, ()
    return rest, told_numbers(given, set(_READ.findall(rest.text)))


def told_numbers(given: Sequence[GivenValue], read: Set[str]) -> tuple[Note, ...]:
    """The note on numbers that a script gives its letters, of which ``read`` stand in the cells.

    Raises GridError where one of these is given a value that is no plain number.
    """
    for each in given:
        if each.name in read and not each.is_number:
            raise GridError(
                "given_value",
                f"`{each.line.text[:40]}` gives {each.name} a value, which is not put in here. "
                "Write it where the letter stands, or delete this line.",
                each.line.whole,
            )
    numbers = [each for each in given if each.is_number]
    if not numbers:
        return ()
    names = ", ".join(dict.fromkeys(each.name for each in numbers[:_TOLD]))
    more = ", …" if len(numbers) > _TOLD else ""
    message = (
        f"The script gives numbers to {names}{more}; they were not used. The letters were read as "
        "the exercise's symbols."
    )
    span = numbers[0].line.whole[0], numbers[-1].line.whole[1]
    return (Note("given_numbers", message, span),)


def _given_values(source: SourceText) -> tuple[list[GivenValue], int]:
    """The values that the statements at the top give, and the place behind these statements."""
    found: list[GivenValue] = []
    text, at = source.text, 0
    while at < len(text):
        if assignment := ASSIGNMENT.match(text, at):
            line = source.cut(*assignment.span("line")).strip()
            value = GivenValue(assignment["name"], assignment["value"].strip(), line)
            if not value.is_itself:
                found.append(value)
            at = assignment.end()
        elif harmless := _HARMLESS.match(text, at):
            at = harmless.end()
        else:
            break
    return found, at


def _without_display(source: SourceText) -> SourceText:
    """The text without the statement at its end that only shows the matrix: ``disp(DH)``."""
    stripped = source.strip(_TAIL)
    shown = _SHOWS.search(stripped.text, max(0, len(stripped.text) - 72))
    return stripped.cut(0, shown.start()) if shown else source
