"""Tokens, and a writer that adds the missing product sign in texts such as 2q1."""

from typing import Any, Final

from service.expressions.characters.writer import BREAKS, Characters
from service.expressions.errors import Note, Span, UnreadableError
from service.expressions.parsing.lexing.brackets import Brackets
from service.expressions.parsing.lexing.indices import Indexed
from service.expressions.parsing.lexing.notes import WordNotes
from service.expressions.tree import SymbolNode
from service.expressions.vocabulary.symbols import Vocabulary

# A token: its terminal, its value, and its [start, end) in the text as typed. The value is a node
# for NUMBER and NAME, the name and its power for FUNCTION, the unit for UNIT, None for the others.
Token = tuple[str, Any, int, int]
END: Final = "$END"

# An operand ends with one of these; it begins with NUMBER, NAME, FUNCTION, ROOT, LEFT or OPEN.
OPERAND_ENDS: Final = frozenset({"NUMBER", "NAME", "RIGHT", "CLOSE", "UNIT"})
_TIGHT_STARTS: Final = frozenset({"NAME", "LEFT", "OPEN"})


class TokenWriter:
    """Collects the tokens of one text and their positions in ``source``."""

    __slots__ = (
        "brackets", "degrees", "ends", "fraction_end", "from_one", "has_separators", "indices",
        "last", "notes", "partners", "source", "starts", "symbols", "text", "tokens", "vocabulary",
    )  # fmt: skip

    def __init__(
        self,
        source: str,
        characters: Characters,
        vocabulary: Vocabulary,
        *,
        degrees: bool,
        notes: list[Note],
    ) -> None:
        self.source = source
        self.text = characters.text.rstrip().removesuffix(";").rstrip()
        self.starts = characters.starts
        self.ends = characters.ends
        self.vocabulary = vocabulary
        self.degrees = degrees
        self.notes = WordNotes(source, vocabulary, notes)
        self.tokens: list[Token] = []
        # The canonical names of the symbols so far.
        self.symbols: set[str] = set()
        self.last = ""
        self.brackets = Brackets()
        self.has_separators = not source.isprintable()
        # The index of the CLOSE of a fraction of numbers right after a function: sin ½q1.
        self.fraction_end = -1
        self.indices: list[tuple[Indexed, str, Span]] = []
        # Computed on first use.
        self.partners: dict[int, int] | None = None
        self.from_one: bool | None = None

    def _span(self, start: int, end: int) -> Span:
        if self.starts is None or self.ends is None:
            return start, end
        return self.starts[start], self.ends[end - 1]

    def _emit(self, terminal: str, value: Any, start: int, end: int) -> None:
        self.tokens.append((terminal, value, start, end))
        self.last = terminal

    def _operand(self, terminal: str, value: Any, start: int, end: int) -> None:
        if self.last in OPERAND_ENDS:
            tokens = self.tokens
            before = tokens[-1]
            if terminal == "NUMBER" or (
                self.has_separators and not BREAKS.isdisjoint(self.source[before[3] : start])
            ):
                glued = before[0] == "NUMBER" and before[3] == start
                raise UnreadableError("values", (before[2], end), number=glued)
            tight = terminal in _TIGHT_STARTS and (
                (self.last == "NUMBER" and len(tokens) > 1 and tokens[-2][0] == "FUNCTION")
                or self.fraction_end == len(tokens) - 1
            )
            tokens.append(("TIGHT" if tight else "JOIN", None, start, start))
        self.tokens.append((terminal, value, start, end))
        self.last = terminal

    def _is_joint(self) -> bool:
        value = self.tokens[-1][1] if self.last == "NAME" else None
        return type(value) is SymbolNode and value.symbol.joint is not None
