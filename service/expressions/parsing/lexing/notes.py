"""Add notes on single words that could also mean something else."""

from typing import Final

from service.expressions.errors import Note, Span, quoted
from service.expressions.limits import LIMITS
from service.expressions.parsing.lexing.joint_markers import Star
from service.expressions.parsing.lexing.words import Piece
from service.expressions.vocabulary.functions import CAPITALS, IN_DEGREES, OF_DEGREES, PI_CAPITALS
from service.expressions.vocabulary.symbols import Symbol, Vocabulary
from service.translations import say

_MARKER: Final = say("The * after the joint variable was read as its mark, not as a product.")
_PRODUCT: Final = say(
    "The * after the joint variable was read as a product. If it marks the variable, delete it."
)


class WordNotes:
    """Collects the notes on the words of one text."""

    __slots__ = ("notes", "source", "vocabulary")

    def __init__(self, source: str, vocabulary: Vocabulary, notes: list[Note]) -> None:
        self.source = source
        self.vocabulary = vocabulary
        self.notes = notes

    def _add(self, code: str, message: str, span: Span) -> None:
        if len(self.notes) < LIMITS.notes:
            self.notes.append(Note(code, message, span))

    def star(self, star: Star, span: Span) -> None:
        """Add a note on a star that may mark a joint variable, as in θ1*."""
        if star == "product":
            return
        code = "joint_marker" if star == "marker" else "marker_or_product"
        self._add(code, _PRODUCT if star == "noted_product" else _MARKER, span)

    def index(self, style: str, symbol: Symbol, span: Span) -> None:
        """Add a note that the index of q[0] or q(1) was counted from 0 or from 1."""
        if style == "[":
            message = say(
                "This was read as {name}, counting from 0 as Python does. If you count from 1, "
                "write the index without brackets.",
                name=symbol.name,
            )
            self._add("zero_based_index", message, span)
            return
        message = say("This was read as {name}, counting from 1.", name=symbol.name)
        self._add("one_based_index", message, span)

    def shorthand(self, piece: Piece, a: int, b: int) -> None:
        """Add a note on a shorthand that could also mean something else: sin12, C1."""
        if piece.ambiguous or self.source[a] in "CS":
            names = "+".join(symbol.name for symbol in piece.symbols)
            message = say(
                "This was read as {function}({angles}).", function=piece.word, angles=names
            )
            self._add("shorthand", message, (a, b))

    def product(self, letter: str, angle: Symbol, a: int, b: int) -> None:
        """Add a note on a product that looks like the cosine or sine of an angle."""
        if letter in {"c", "C"}:
            message = say(
                "This was read as {letter}*{angle}. For the cosine, write cos({angle}).",
                letter=letter,
                angle=angle.name,
            )
            self._add("shorthand", message, (a, b))
        elif letter in {"s", "S"}:
            message = say(
                "This was read as {letter}*{angle}. For the sine, write sin({angle}).",
                letter=letter,
                angle=angle.name,
            )
            self._add("shorthand", message, (a, b))

    def other_capitals(self, name: str, a: int, b: int) -> None:
        """Add a note on a name in another letter case: l1 if only L1 is declared."""
        message = say("{written} was read as {name}.", written=quoted(self.source[a:b]), name=name)
        self._add("letter_case", message, (a, b))

    def pi(self, a: int, b: int) -> None:
        """Add a note that Pi or PI was read as the number π."""
        of_program = self.source[a - 1 : a] in {".", ":"} or self.source[b : b + 2] == "()"
        if self.source[a:b] in PI_CAPITALS and not of_program:
            self._add("letter_case", say("This was read as the number pi."), (a, b))

    def function(self, name: str, a: int, b: int) -> None:
        """Add a note on a function in capitals, or on a function of degrees such as sind."""
        # If ``a`` is a symbol, also add one on acos, which could mean a·cos.
        written = self.source[a:b]
        # Mathematica writes Cos[q1], and C# Math.Cos(q1).
        of_program = self.source[a - 1 : a] in {".", ":"} or self.source[b : b + 1] == "["
        if written in CAPITALS and not of_program:
            message = say("This was read as the function {name}.", name=name)
            self._add("letter_case", message, (a, b))
        if name in OF_DEGREES:
            message = say(
                "A number without a unit inside {name} was read in degrees; the symbol of an "
                "angle keeps its own unit.",
                name=name,
            )
            self._add("degrees_function", message, (a, b))
        if name in IN_DEGREES:
            message = say(
                "{name} gives degrees: its value was read as an angle in degrees.", name=name
            )
            self._add("degrees_function", message, (a, b))
        inverted, a_is_known = name[1:], "a" in self.vocabulary.by_name
        if written[0] == "a" and inverted in {"sin", "cos", "tan"} and a_is_known:
            message = say(
                "This was read as the inverse function {name}, not as a times {function}; "
                "for the product write a*{function}.",
                name=name,
                function=inverted,
            )
            self._add("function_name", message, (a, b))
