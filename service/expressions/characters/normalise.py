r"""Convert typed text to plain characters, each with its position in the typed text.

Unambiguous characters (× · − ² ₁ ½ ° π, variants of Greek letters) and LaTeX are converted.
Look-alike or invisible characters are errors. \frac{a}{b} becomes ⟨{a}/{b}⟩, where ⟨ and ⟩ are
private brackets that no student can type.
"""

from typing import Final

from service.expressions.characters import greek, latex_commands, unicode
from service.expressions.characters.writer import Characters, CharacterWriter
from service.expressions.errors import Cause, Span, UnreadableError
from service.expressions.limits import LIMITS
from service.regex import regex

_PLAIN: Final = regex(r"[ -#%-\[\]^_a-z|]*")
_CHUNK: Final = regex(rf"[A-Za-z0-9{greek.CLASS} +\-*/().,|\[\]{{}}]+")
_INDEX: Final = regex(rf"[A-Za-z0-9{greek.CLASS} _*]*")
# An index as Word writes it in one line: θ_(1).
_BRACKETED_INDEX: Final = regex(r"\(\s*([A-Za-z0-9]+)\s*\)")
_PLAIN_INDEX: Final = regex(r"_[A-Za-z0-9]+")
# An index with a blank before the underscore, or in round brackets.
_SPACED_INDEX: Final = regex(r" _|_\(")


def normalise(source: str) -> Characters:
    """Return ``source`` in plain characters. Raises UnreadableError for an unreadable character."""
    if (
        _PLAIN.fullmatch(source)
        and "^*" not in source
        and ("_" not in source or not _SPACED_INDEX.search(source))
    ):
        return Characters(source)
    return _Normaliser(source).run()


class _Normaliser(CharacterWriter):
    def run(self) -> Characters:
        self._range(0, len(self.source), 0)
        return Characters("".join(self.letters), self.starts, self.ends)

    def _range(self, position: int, end: int, depth: int) -> None:
        if depth > LIMITS.depth:
            raise UnreadableError("beyond", (position, end), limit="depth")
        while position < end:
            chunk = _CHUNK.match(self.source, position, end)
            if chunk is None:
                position = self._step(position, end, depth)
            elif self.commas and (comma := self.commas[-1]).start() < chunk.end():
                self.commas.pop()
                if comma.start() < position:
                    continue
                self._copy(position, comma.start())
                position = self._emit(".", *comma.span())
            else:
                self._copy(position, chunk.end())
                position = chunk.end()

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
        """Read the sign ^ as a power, a degree sign or the star of a joint variable."""
        if circle := latex_commands.RAISED_CIRCLE.match(self.source, at):
            return self._emit("°", at, circle.end())
        star = latex_commands.RAISED_STAR.match(self.source, at)
        if star is None:
            return self._emit("^", at, at + 1)
        end = star.end()
        # The index may follow the star: θ^*_1.
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
        self._attach_index()
        start = self._skip_blanks(at + 1, end)
        if start < end and self.source[start] == "{":
            stop = self._partner(start, end)
            inside, after = (start + 1, stop), stop + 1
        elif bracketed := _BRACKETED_INDEX.match(self.source, start, end):
            inside, after = bracketed.span(1), bracketed.end()
        elif command := latex_commands.COMMAND.match(self.source, start, end):
            after = command.end()
            if command[1] in latex_commands.STYLES:
                after = self._argument(start, after, end)[2]
            inside = start, after
        else:
            return self._emit("_", at, at + 1)
        content = _Normaliser(self.source, self.partners)
        content._range(*inside, depth + 1)
        text = "".join(content.letters)
        if not text.strip() or not _INDEX.fullmatch(text):
            raise UnreadableError("subscript", (at, after), index=self.source[slice(*inside)])
        self._emit("_", at, inside[0])
        stars: list[Span] = []
        # An underscore before each letter keeps the index whole: l_{1h} is not l_1 times h.
        mark = "_" if not text.isdigit() else ""
        written = ""
        for letter, place in zip(text, zip(content.starts, content.ends, strict=True), strict=True):
            if letter == "*":
                stars.append(place)
            elif letter not in " _":
                self._emit(f"{written}{letter}", *place)
                written = mark
        self.ends[-1] = after
        # Add a blank so that q_{1}2 does not become q12.
        self._emit(" " if self.source[after : after + 1].isdigit() else "", at, at)
        for star in stars:
            self._emit(unicode.MARKER, *star)
        return after

    # --- LaTeX

    def _command(self, at: int, end: int, depth: int) -> int:
        match = latex_commands.COMMAND.match(self.source, at, end)
        if match is None:
            raise UnreadableError("command", (at, at + 1), name="")
        name, symbol = match.groups()
        after = match.end()
        if symbol is not None:
            return self._symbol(symbol, at, after, end)
        if self.source[after - 1] == "*" and name not in latex_commands.STYLES:
            after -= 1
        if name in latex_commands.PLAIN:
            # Empty braces only end the name of a command.
            after += 2 * self.source.startswith("{}", after)
            return self._emit(latex_commands.PLAIN[name], at, after)
        if name in latex_commands.FUNCTIONS:
            return self._function(latex_commands.FUNCTIONS[name], at, after)
        if name in latex_commands.SPACES:
            return self._emit(" ", at, after)
        return self._structure(name, at, after, end, depth)

    def _structure(self, name: str, at: int, after: int, end: int, depth: int) -> int:
        if name in latex_commands.STYLES:
            is_word = name == "operatorname"
            return self._styled(self._argument(at, after, end), at, depth, is_word=is_word)
        if name in latex_commands.SWITCHES:
            return self._switch(at, after, end, depth)
        if name in latex_commands.FRACTIONS:
            return self._fraction(at, after, end, depth)
        if name == "sqrt":
            return self._root(at, after, end, depth)
        if name == "over":
            return self._over(at, after, depth)
        if name == "ang":
            return self._emit("°", after, self._braced(at, after, end, depth))
        if name in latex_commands.QUANTITIES:
            return self._quantity(name, at, after, end, depth)
        if (stop := self._without_meaning(name, at, after, end)) is not None:
            return self._emit(" ", at, stop)
        causes: dict[str, Cause] = {"pm": "plus_minus", "mp": "plus_minus", "infty": "not_finite"}
        raise UnreadableError(causes.get(name, "command"), (at, after), name=name)

    def _without_meaning(self, name: str, at: int, after: int, end: int) -> int | None:
        if name in latex_commands.IGNORED:
            return self._argument(at, after, end)[2]
        environment = latex_commands.ENVIRONMENT.match(self.source, after, end)
        return environment.end() if environment and name in {"begin", "end"} else None

    def _symbol(self, symbol: str, at: int, after: int, end: int) -> int:
        if symbol == "," and (dot := latex_commands.DOT_BETWEEN_SPACES.match(self.source, at, end)):
            return self._emit("*", at, dot.end())
        named = latex_commands.NAMED_LETTER.match(self.source, at, end) if symbol == "[" else None
        if named is not None:
            name = named[2] if named[1] == "Capital" else named[2].lower()
            plain = latex_commands.PLAIN.get(name)
            if plain is None:
                raise UnreadableError("command", named.span(), name="")
            return self._emit(plain, at, named.end())
        if symbol in "{}_*":
            return self._emit(symbol, at, after)
        if symbol in latex_commands.BLANK_SYMBOLS:
            return self._emit(" ", at, after)
        raise UnreadableError("command", (at, after), name=symbol)

    def _function(self, name: str, at: int, after: int) -> int:
        r"""Emit a function's name between blanks, so that a\sin x is not read as asin x."""
        if self.letters and self.letters[-1].isalpha():
            self._emit(" ", at, at)
        self._emit(name, at, after)
        following = self.source[after : after + 1]
        if following not in {"_", "^"} and not following.isdigit():
            self._emit(" ", after, after)
        return after

    def _styled(
        self, argument: tuple[int, int, int], at: int, depth: int, *, is_word: bool = False
    ) -> int:
        start, stop, after = argument
        inside = self.source[start:stop]
        is_word = is_word or sum(map(str.isalpha, inside)) > 1
        if is_word and self.letters and self.letters[-1].isalpha():
            self._emit(" ", at, at)
        first = len(self.letters)
        self._range(start, stop, depth + 1)
        if "$" in inside:
            self._without_blanks(first)
        following = self.source[after : after + 1]
        if is_word and (following.isalpha() or following == "\\"):
            self._emit(" ", after, after)
        return after

    def _without_blanks(self, first: int) -> None:
        r"""Remove the blanks that Mathematica prints in names: \text{$\theta $1}."""
        kept = [i for i in range(first, len(self.letters)) if self.letters[i] != " "]
        letters, starts, ends = self.letters, self.starts, self.ends
        places = [(letters[i], starts[i], ends[i]) for i in kept]
        self._drop(first)
        for place in places:
            self._emit(*place)

    def _switch(self, at: int, after: int, end: int, depth: int) -> int:
        r"""Read {\rm cos} as \mathrm{cos}."""
        if not self.letters or self.letters[-1] != "{" or self.source[self.starts[-1]] != "{":
            return self._emit(" ", at, after)
        opener = self.starts[-1]
        stop = self._partner(opener, len(self.source))
        if stop >= end:
            return self._emit(" ", at, after)
        self._drop(len(self.letters) - 1)
        start = self._skip_blanks(after, stop)
        inner = stop
        if self.source[start] == "{" and self._partner(start, end) == stop - 1:
            start, inner = start + 1, stop - 1
        return self._styled((start, inner, stop + 1), opener, depth)

    def _over(self, at: int, after: int, depth: int) -> int:
        r"""Read {a \over b} as \frac{a}{b}."""
        level = 0
        for place in range(len(self.letters) - 1, -1, -1):
            letter = self.letters[place]
            level += (letter == "}") - (letter == "{")
            if level < 0:
                break
        if level >= 0 or self.source[self.starts[place]] != "{":
            raise UnreadableError("argument", (at, after), name=self.source[at:after])
        opener = self.starts[place]
        stop = self._partner(opener, len(self.source))
        self.letters.insert(place, unicode.OPEN)
        self.starts.insert(place, opener)
        self.ends.insert(place, opener)
        self._emit("}/{", at, after)
        self._range(after, stop, depth + 1)
        self._emit("}", stop, stop + 1)
        return self._emit(unicode.CLOSE, stop, stop + 1)

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

    def _quantity(self, name: str, at: int, after: int, end: int, depth: int) -> int:
        r"""Read \SI{90}{\degree} as 90°, \si{\degree} as °, and \num{0.3} as 0.3.

        Raises UnreadableError if the unit is not a unit of angles.
        """
        if name == "num":
            return self._braced(at, after, end, depth)
        has_number = name not in latex_commands.UNITS
        unit_at = self._argument(at, after, end)[2] if has_number else after
        unit, unit_end = self._angle_unit(at, unit_at, end)
        if has_number:
            self._braced(at, after, end, depth)
        return self._emit(unit, unit_at if has_number else at, unit_end)

    def _angle_unit(self, at: int, after: int, end: int) -> tuple[str, int]:
        start, stop, unit_end = self._argument(at, after, end)
        unit = latex_commands.ANGLE_UNITS.get(self.source[start:stop].strip().lstrip("\\"))
        if unit is None:
            raise UnreadableError("quantity", (at, unit_end))
        return unit, unit_end

    def _braced(self, at: int, after: int, end: int, depth: int) -> int:
        start, stop, after = self._argument(at, after, end)
        braced = stop < after
        self._emit("{", start - braced, start)
        self._range(start, stop, depth + 1)
        self._emit("}", stop, after)
        return after
