"""Collect plain characters with their positions in the typed text."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from service.expressions.characters import latex_commands, unicode
from service.expressions.errors import UnreadableError
from service.regex import regex

_DECIMAL_COMMA: Final = regex(r"(?<=[0-9])\{,\}(?=[0-9])")
# Words in braces that are longer cannot be the stem of a name.
_LONGEST_STEM: Final = 24
_POWER: Final = regex(r"[+-]?[0-9]+|[A-Za-z]")
# These separate cells or lines, so they do not stand for a product.
BREAKS: Final = frozenset("\t\n\r\v\f\x1c\x1d\x1e\x85\u2028\u2029")


@dataclass(frozen=True, slots=True)
class Characters:
    """Plain text, and the position [start, end) of each of its characters in the typed text.

    ``starts`` and ``ends`` are None if the text was not changed.
    """

    text: str
    starts: list[int] | None = None
    ends: list[int] | None = None


class CharacterWriter:
    """Collects plain characters, and reads arguments and indices in LaTeX."""

    def __init__(self, source: str, partners: dict[int, int] | None = None) -> None:
        self.source = source
        self.letters: list[str] = []
        self.starts: list[int] = []
        self.ends: list[int] = []
        self.dollars = source.count("$") % 2 == 0
        self.commas = [] if "{,}" not in source else list(_DECIMAL_COMMA.finditer(source))[::-1]
        self.partners = partners

    def _copy(self, start: int, end: int) -> None:
        self.letters.extend(self.source[start:end])
        self.starts.extend(range(start, end))
        self.ends.extend(range(start + 1, end + 1))

    def _emit(self, text: str, start: int, end: int) -> int:
        for letter in text:
            self.letters.append(letter)
            self.starts.append(start)
            self.ends.append(end)
        return end

    def _attach_index(self) -> None:
        r"""Remove blanks and braces before an index: \theta _1, {\theta}_1, {\rm c}_1."""
        letters = self.letters
        while letters and letters[-1] == " " and self.source[self.starts[-1]] in " \\":
            self._drop(len(letters) - 1)
        if not letters or letters[-1] != "}":
            return
        for at in range(len(letters) - 2, max(-1, len(letters) - _LONGEST_STEM - 2), -1):
            if letters[at] == "{":
                # After these, a brace encloses an index, a power or the operand of a root.
                if at + 2 < len(letters) and (at == 0 or letters[at - 1] not in "_^√"):
                    letters[at] = " "
                    self._drop(len(letters) - 1)
                return
            if not letters[at].isalpha() and letters[at] != " ":
                return

    def _drop(self, at: int) -> None:
        del self.letters[at:], self.starts[at:], self.ends[at:]

    def _subscript_run(self, at: int) -> int:
        """Read subscript characters such as ₁₂ as one index; return the position after them."""
        self._attach_index()
        end = self._end_of_run(at, unicode.SUBSCRIPTS)
        if self.source[end : end + 1] in {"₊", "₋"}:
            raise UnreadableError("subscript", (at, end + 1), index=self.source[at:end])
        for place in range(at, end):
            digit = unicode.SUBSCRIPTS[self.source[place]]
            # As in ``_underscore``: l₁ₕ is not l₁ times h.
            self._emit(digit if digit.isdigit() and place > at else f"_{digit}", place, place + 1)
        if self.source[end : end + 1].isdigit():
            self._emit(" ", end, end)
        return end

    def _superscript_run(self, at: int) -> int:
        """Read superscript characters such as ⁻¹ as one power; return the position after them."""
        end = self._end_of_run(at, unicode.SUPERSCRIPTS)
        if self.source[at:end] == "⁰" and self.source[at - 1 : at].isdigit():
            raise UnreadableError("raised_zero", (at, end))
        power = "".join(unicode.SUPERSCRIPTS[letter] for letter in self.source[at:end])
        is_simple = _POWER.fullmatch(power) is not None
        self._emit("^" if is_simple else "^(", at, at)
        self._spell(unicode.SUPERSCRIPTS, at, end)
        # Add a blank so that x²3 does not become x^23.
        self._emit(" " if is_simple else ")", end, end)
        return end

    def _end_of_run(self, at: int, table: Mapping[str, str]) -> int:
        end = at
        while end < len(self.source) and self.source[end] in table:
            end += 1
        return end

    def _spell(self, table: Mapping[str, str], at: int, end: int) -> None:
        for place in range(at, end):
            self._emit(table[self.source[place]], place, place + 1)

    def _argument(self, at: int, after: int, end: int) -> tuple[int, int, int]:
        start = self._skip_blanks(after, end)
        if start >= end or self.source[start] in "}+-*/)]":
            raise UnreadableError("argument", (at, after), name=self.source[at:after])
        if self.source[start] == "{":
            stop = self._partner(start, end)
            return start + 1, stop, stop + 1
        command = latex_commands.COMMAND.match(self.source, start, end)
        stop = command.end() if command else start + 1
        return start, stop, stop

    def _skip_blanks(self, at: int, end: int) -> int:
        while at < end and self.source[at].isspace():
            at += 1
        return at

    def _partner(self, at: int, end: int) -> int:
        if self.partners is None:
            self.partners = latex_commands.brace_partners(self.source)
        place = self.partners.get(at, end)
        if place >= end:
            raise UnreadableError("unclosed", (at, at + 1))
        return place
