"""Notes on single words that have another possible reading."""

from typing import Final

from service.expressions.errors import Note, Span, quoted
from service.expressions.limits import LIMITS
from service.expressions.parsing.lexing.joint_markers import Star
from service.expressions.parsing.lexing.words import Piece
from service.expressions.vocabulary.functions import CAPITALS, IN_DEGREES, OF_DEGREES, PI_CAPITALS
from service.expressions.vocabulary.symbols import Symbol, Vocabulary

_INDEXING: Final = {
    "[": "This was read as {name}, counting from 0 as Python does. If you count from 1, write the "
    "index without brackets.",
    "(": "This was read as {name}, counting from 1.",
}
_MARKER: Final = "The * after the joint variable was read as its mark, not as a product."
_PRODUCT: Final = (
    "The * after the joint variable was read as a product. If it marks the variable, delete it."
)
_SHORT: Final = {
    "c": ("cosine", "cos"), "s": ("sine", "sin"), "C": ("cosine", "cos"), "S": ("sine", "sin"),
}  # fmt: skip


class WordNotes:
    """Writes the notes of one text."""

    __slots__ = ("notes", "source", "vocabulary")

    def __init__(self, source: str, vocabulary: Vocabulary, notes: list[Note]) -> None:
        self.source = source
        self.vocabulary = vocabulary
        self.notes = notes

    def _add(self, code: str, message: str, span: Span) -> None:
        if len(self.notes) < LIMITS.notes:
            self.notes.append(Note(code, message, span))

    def star(self, star: Star, span: Span) -> None:
        """Note a star that marks a joint variable, or that might mark it."""
        if star == "product":
            return
        code = "joint_marker" if star == "marker" else "marker_or_product"
        self._add(code, _PRODUCT if star == "noted_product" else _MARKER, span)

    def index(self, style: str, symbol: Symbol, span: Span) -> None:
        """Note whether the index of q[0] or q(1) was counted from 0 or 1."""
        code = "zero_based_index" if style == "[" else "one_based_index"
        self._add(code, _INDEXING[style].format(name=symbol.name), span)

    def shorthand(self, piece: Piece, a: int, b: int) -> None:
        """Note a shorthand that has another reading: sin12, C1."""
        if piece.ambiguous or self.source[a] in "CS":
            names = "+".join(symbol.name for symbol in piece.symbols)
            self._add("shorthand", f"This was read as {piece.word}({names}).", (a, b))

    def product(self, letter: str, angle: Symbol, a: int, b: int) -> None:
        """Note a product that looks like the cosine or sine of an angle."""
        function = _SHORT.get(letter)
        if function is not None:
            message = (
                f"This was read as {letter}*{angle.name}. For the {function[0]}, write "
                f"{function[1]}({angle.name})."
            )
            self._add("shorthand", message, (a, b))

    def other_capitals(self, name: str, a: int, b: int) -> None:
        """Note a name in another letter case: l1 if only L1 is declared."""
        self._add("letter_case", f"{quoted(self.source[a:b])} was read as {name}.", (a, b))

    def pi(self, a: int, b: int) -> None:
        """Note that Pi or PI was read as the number."""
        of_program = self.source[a - 1 : a] in {".", ":"} or self.source[b : b + 2] == "()"
        if self.source[a:b] in PI_CAPITALS and not of_program:
            self._add("letter_case", "This was read as the number pi.", (a, b))

    def function(self, name: str, a: int, b: int) -> None:
        """Note a function in capitals, a function of degrees, or acos if a is a symbol."""
        written = self.source[a:b]
        # Mathematica writes Cos[q1], and C# Math.Cos(q1).
        of_program = self.source[a - 1 : a] in {".", ":"} or self.source[b : b + 1] == "["
        if written in CAPITALS and not of_program:
            self._add("letter_case", f"This was read as the function {name}.", (a, b))
        if name in OF_DEGREES:
            message = (
                f"A number without a unit inside {name} was read in degrees; the symbol of an "
                "angle keeps its own unit."
            )
            self._add("degrees_function", message, (a, b))
        if name in IN_DEGREES:
            message = f"{name} gives degrees: its value was read as an angle in degrees."
            self._add("degrees_function", message, (a, b))
        inverted, a_is_known = name[1:], "a" in self.vocabulary.by_name
        if written[0] == "a" and inverted in {"sin", "cos", "tan"} and a_is_known:
            message = (
                f"This was read as the inverse function {name}, not as a times {inverted}; "
                f"for the product write a*{inverted}."
            )
            self._add("function_name", message, (a, b))
