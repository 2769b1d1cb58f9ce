r"""Characters as typed -> plain characters, each with its place in the text as typed.

A character with one meaning is read: × · − ² ₁ ½ ° π, the shapes of a Greek letter, and LaTeX.
A character that looks like another one, or cannot be seen, is named in an error and never guessed.
\frac{a}{b} becomes ⟨{a}/{b}⟩, where ⟨ and ⟩ are brackets that no student can type.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from service.expressions.characters import greek, latex_commands, unicode
from service.expressions.errors import Cause, Span, UnreadableError
from service.expressions.limits import LIMITS

_PLAIN: Final = re.compile(r"[ -#%-\[\]^_a-z|]*")
_CHUNK: Final = re.compile(rf"[A-Za-z0-9{greek.CLASS} +\-*/().,|\[\]{{}}]+")
_INDEX: Final = re.compile(rf"[A-Za-z0-9{greek.CLASS} _*]*")
_PLAIN_INDEX: Final = re.compile(r"_[A-Za-z0-9]+")
_POWER: Final = re.compile(r"[+-]?[0-9]+|[A-Za-z]")
# These separate cells or lines, and not the factors of a product.
BREAKS: Final = frozenset("\t\n\r\v\f\x1c\x1d\x1e\x85\u2028\u2029")


@dataclass(frozen=True, slots=True)
class Characters:
    """Plain text, and for each of its characters the [start, end) in the text as typed.

    ``starts`` and ``ends`` are None where nothing was changed.
    """

    text: str
    starts: list[int] | None = None
    ends: list[int] | None = None


def normalise(source: str) -> Characters:
    """``source`` in plain characters. Raises UnreadableError for a character that is not read."""
    if _PLAIN.fullmatch(source) and "^*" not in source:
        return Characters(source)
    return _Normaliser(source).run()


class _Normaliser:
    """One pass over the source, a run of plain characters or a LaTeX command at a time."""

    def __init__(self, source: str) -> None:
        self.source = source
        self.letters: list[str] = []
        self.starts: list[int] = []
        self.ends: list[int] = []
        self.dollars = source.count("$") % 2 == 0

    def run(self) -> Characters:
        self._range(0, len(self.source), 0)
        return Characters("".join(self.letters), self.starts, self.ends)

    def _range(self, position: int, end: int, depth: int) -> None:
        """Read ``source[position:end]``, nested in ``depth`` arguments of LaTeX commands."""
        if depth > LIMITS.depth:
            raise UnreadableError("beyond", (position, end), limit="depth")
        while position < end:
            chunk = _CHUNK.match(self.source, position, end)
            if chunk is None:
                position = self._step(position, end, depth)
            else:
                self._copy(position, chunk.end())
                position = chunk.end()

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

    def _step(self, at: int, end: int, depth: int) -> int:
        letter = self.source[at]
        if letter == "\\":
            return self._command(at, end, depth)
        if letter in "^⋆":
            return self._caret(at, end, depth)
        if letter == "_":
            return self._underscore(at, end, depth)
        if letter in unicode.SUBSCRIPTS or letter in "₊₋":
            return self._subscript_run(at)
        if letter in unicode.SUPERSCRIPTS:
            return self._superscript_run(at)
        if letter == "~" or (letter == "$" and self.dollars):
            return self._emit(" ", at, at + 1)
        text = unicode.plain(letter)
        if text is None:
            raise UnreadableError(unicode.cause(letter), (at, at + 1))
        return self._emit(text, at, at + 1)

    # --- indices and powers

    def _caret(self, at: int, stop: int, depth: int) -> int:
        """Read ^, unless it raises a circle (degrees) or a star (the joint variable's marker)."""
        if circle := latex_commands.RAISED_CIRCLE.match(self.source, at):
            return self._emit("°", at, circle.end())
        star = latex_commands.RAISED_STAR.match(self.source, at)
        if star is None:
            return self._emit("^", at, at + 1)
        end = star.end()
        # The index may stand behind the star: θ^*_1.
        index = _PLAIN_INDEX.match(self.source, end)
        if index is not None:
            self._copy(*index.span())
            end = index.end()
        elif self.source[end : end + 2] == "_{":
            end = self._underscore(end, stop, depth)
        self._emit(unicode.MARKER, at, star.end())
        return end

    def _underscore(self, at: int, end: int, depth: int) -> int:
        r"""Read _1, _{12}, _\alpha and _{\theta_1}: an index of letters and digits."""
        start = self._skip_blanks(at + 1, end)
        if start < end and self.source[start] == "{":
            stop = self._partner(start, end)
            inside, after = (start + 1, stop), stop + 1
        elif command := latex_commands.COMMAND.match(self.source, start, end):
            after = command.end()
            if command[1] in latex_commands.STYLES:
                after = self._argument(start, after, end)[2]
            inside = start, after
        else:
            return self._emit("_", at, at + 1)
        content = _Normaliser(self.source)
        content._range(*inside, depth + 1)
        text = "".join(content.letters)
        if not text.strip() or not _INDEX.fullmatch(text):
            raise UnreadableError("subscript", (at, after), index=self.source[slice(*inside)])
        self._emit("_", at, inside[0])
        stars: list[Span] = []
        for letter, place in zip(text, zip(content.starts, content.ends, strict=True), strict=True):
            if letter == "*":
                stars.append(place)
            elif letter not in " _":
                self._emit(letter, *place)
        self.ends[-1] = after
        # The blank keeps q_{1}2 from becoming q12.
        self._emit(" " if self.source[after : after + 1].isdigit() else "", at, at)
        for star in stars:
            self._emit(unicode.MARKER, *star)
        return after

    def _subscript_run(self, at: int) -> int:
        """Read ₁₂: one index."""
        end = self._end_of_run(at, unicode.SUBSCRIPTS)
        if self.source[end : end + 1] in {"₊", "₋"}:
            raise UnreadableError("subscript", (at, end + 1), index=self.source[at:end])
        self._emit("_", at, at)
        self._spell(unicode.SUBSCRIPTS, at, end)
        if self.source[end : end + 1].isdigit():
            self._emit(" ", end, end)
        return end

    def _superscript_run(self, at: int) -> int:
        """Read ⁻¹: one power."""
        end = self._end_of_run(at, unicode.SUPERSCRIPTS)
        if self.source[at:end] == "⁰" and self.source[at - 1 : at].isdigit():
            raise UnreadableError("raised_zero", (at, end))
        power = "".join(unicode.SUPERSCRIPTS[letter] for letter in self.source[at:end])
        is_simple = _POWER.fullmatch(power) is not None
        self._emit("^" if is_simple else "^(", at, at)
        self._spell(unicode.SUPERSCRIPTS, at, end)
        # The blank keeps x²3 from becoming x^23.
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

    # --- LaTeX

    def _command(self, at: int, end: int, depth: int) -> int:
        match = latex_commands.COMMAND.match(self.source, at, end)
        if match is None:
            raise UnreadableError("command", (at, at + 1), name="")
        name, symbol = match.groups()
        after = match.end()
        if symbol is not None:
            return self._symbol(symbol, at, after)
        if self.source[after - 1] == "*" and name not in latex_commands.STYLES:
            after -= 1
        if name in latex_commands.PLAIN:
            return self._emit(latex_commands.PLAIN[name], at, after)
        if name in latex_commands.FUNCTIONS:
            return self._function(latex_commands.FUNCTIONS[name], at, after)
        if name in latex_commands.SPACES:
            return self._emit(" ", at, after)
        if name in latex_commands.STYLES:
            return self._style(name, at, after, end, depth)
        if name in latex_commands.FRACTIONS:
            return self._fraction(at, after, end, depth)
        if name == "sqrt":
            return self._root(at, after, end, depth)
        causes: dict[str, Cause] = {"pm": "plus_minus", "mp": "plus_minus", "infty": "not_finite"}
        raise UnreadableError(causes.get(name, "command"), (at, after), name=name)

    def _symbol(self, symbol: str, at: int, after: int) -> int:
        if symbol in "{}_":
            return self._emit(symbol, at, after)
        if symbol in latex_commands.BLANK_SYMBOLS:
            return self._emit(" ", at, after)
        raise UnreadableError("command", (at, after), name=symbol)

    def _function(self, name: str, at: int, after: int) -> int:
        r"""Emit a function's name, so that a\sin x is not asin x, and \sin d_3 not sind_3."""
        if self.letters and self.letters[-1].isalpha():
            self._emit(" ", at, at)
        self._emit(name, at, after)
        following = self.source[after : after + 1]
        if following not in {"_", "^"} and not following.isdigit():
            self._emit(" ", after, after)
        return after

    def _style(self, name: str, at: int, after: int, end: int, depth: int) -> int:
        """Read the argument of a command that only styles it."""
        start, stop, after = self._argument(at, after, end)
        is_word = name == "operatorname" or sum(map(str.isalpha, self.source[start:stop])) > 1
        if is_word and self.letters and self.letters[-1].isalpha():
            self._emit(" ", at, at)
        self._range(start, stop, depth + 1)
        if is_word and self.source[after : after + 1].isalpha():
            self._emit(" ", after, after)
        return after

    def _fraction(self, at: int, after: int, end: int, depth: int) -> int:
        self._emit(unicode.OPEN, at, after)
        after = self._braced(at, after, end, depth)
        self._emit("/", at, at)
        after = self._braced(at, after, end, depth)
        self._emit(unicode.CLOSE, after - 1, after)
        return after

    def _root(self, at: int, after: int, end: int, depth: int) -> int:
        start = self._skip_blanks(after, end)
        if self.source[start : start + 1] == "[":
            raise UnreadableError("cube_root", (at, start + 1))
        self._emit("√", at, after)
        return self._braced(at, after, end, depth)

    def _braced(self, at: int, after: int, end: int, depth: int) -> int:
        start, stop, after = self._argument(at, after, end)
        braced = stop < after
        self._emit("{", start - braced, start)
        self._range(start, stop, depth + 1)
        self._emit("}", stop, after)
        return after

    def _argument(self, at: int, after: int, end: int) -> tuple[int, int, int]:
        """The [start, stop) of a command's argument, and the place behind it."""
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
        """The place of the brace that closes the one at ``at``."""
        depth = 0
        for place in range(at, end):
            letter = self.source[place]
            if self.source[place - 1 : place] == "\\":
                continue
            depth += (letter == "{") - (letter == "}")
            if depth == 0:
                return place
        raise UnreadableError("unclosed", (at, at + 1))
