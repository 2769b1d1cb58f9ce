"""Plain characters -> tokens: numbers, names, operators, and the products that are not written."""

import math
import re
from typing import Any, Final

from service.expressions.characters.normalise import BREAKS, Characters
from service.expressions.characters.unicode import CLOSE, MARKER, OPEN
from service.expressions.errors import Note, Span, UnreadableError
from service.expressions.parsing.brackets import WRAPPING, Brackets
from service.expressions.parsing.indices import INDEX, Indexed, indexed, is_family
from service.expressions.parsing.joint_markers import read_star
from service.expressions.parsing.notes import WordNotes
from service.expressions.parsing.words import RUN, Piece, split
from service.expressions.tree import Binary, Call, Node, Number, Pi, SymbolNode
from service.expressions.vocabulary.functions import IN_DEGREES, MODULES, UNIT_FUNCTIONS
from service.expressions.vocabulary.symbols import Symbol, Vocabulary

# A token: its terminal, its value, and its [start, end) in the text as typed. The value is a node
# for NUMBER and NAME, the name and its power for FUNCTION, the unit for UNIT, None for the others.
Token = tuple[str, Any, int, int]
END: Final = "$END"

NUMBER: Final = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_TOKEN: Final = re.compile(
    rf"\s*(?:({RUN})|({NUMBER})|(\*\*|\.[*/^]|[-+*/^(),°√\[\]{{}}|{OPEN}{CLOSE}{MARKER}])|(.))",
    re.DOTALL,
)
_TERMINALS: Final = {
    "+": "PLUS", "-": "MINUS", "*": "STAR", "/": "SLASH", "^": "POWER", "**": "POWER",
    ".*": "STAR", "./": "SLASH", ".^": "POWER", ",": "COMMA",
}  # fmt: skip
_FUNCTION_POWER: Final = re.compile(r"\s*(?:\^|\*\*)\s*")
_EXPONENT: Final = re.compile(
    r"([0-9]+)(?![0-9.eE])|\(\s*([0-9]+)\s*\)|\{\s*([0-9]+)\s*\}|\[\s*([0-9]+)\s*\]"
)
_ATTRIBUTE: Final = re.compile(r"\.[^\W\d_]")
_E_NAME: Final = re.compile(r"([eE])([+-]?)([0-9]+)$")
_NUMERIC_FRACTION: Final = re.compile(rf"{OPEN}\{{?\s*[0-9]+\s*\}}?/\{{?\s*[0-9]+\s*\}}?{CLOSE}")
# An operand ends with one of these; it begins with NUMBER, NAME, FUNCTION, ROOT, LEFT or OPEN.
OPERAND_ENDS: Final = frozenset({"NUMBER", "NAME", "RIGHT", "CLOSE", "UNIT"})
_TIGHT_STARTS: Final = frozenset({"NAME", "LEFT", "OPEN"})
_SIGNS: Final = frozenset({"PLUS", "MINUS"})
_TERM_STARTS: Final = frozenset({"LEFT", "OPEN", "COMMA"})
_FACTOR_OPERATORS: Final = frozenset({"STAR", "SLASH", "POWER"})


class Lexer:
    """One pass over the ``characters`` of ``source``."""

    __slots__ = (
        "brackets", "degrees", "ends", "fraction_end", "has_separators", "indices", "last", "notes",
        "source", "starts", "text", "tokens", "vocabulary",
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
        self.last = ""
        self.brackets = Brackets()
        self.has_separators = not source.isprintable()
        # The index of the CLOSE of a fraction of numbers right behind a function: sin ½q1.
        self.fraction_end = -1
        self.indices: list[tuple[Indexed, str, Span]] = []

    def run(self) -> list[Token]:
        """The tokens, with END last. Raises UnreadableError."""
        text, match, position = self.text, _TOKEN.match, 0
        in_place, length = self.starts is None, len(text)
        while position < length:
            found = match(text, position)
            # The last alternative takes any character, so something is always found.
            assert found is not None
            group = found.lastindex or 0
            start, position = found.span(group)
            if group == 1:
                position = self._word(found[1], start, position)
            elif group == 3:
                operator = found[3]
                terminal = _TERMINALS.get(operator)
                if terminal is None or (operator == "*" and self._is_joint()):
                    self._operator(operator, start, position)
                    continue
                # Fast, for most tokens are such: an operator of one meaning in an unchanged text.
                a, b = (start, position) if in_place else self._span(start, position)
                self.tokens.append((terminal, None, a, b))
                self.last = terminal
            elif group == 2:
                self._number(found[2], start, position)
            else:
                raise self._stray(found[4], self._span(start, position))
        end = len(self.source)
        self.tokens.append((END, None, end, end))
        if self.indices:
            self._check_indices()
        return self.tokens

    def _span(self, start: int, end: int) -> Span:
        """The span as typed of the plain characters [start, end)."""
        if self.starts is None or self.ends is None:
            return start, end
        return self.starts[start], self.ends[end - 1]

    def _emit(self, terminal: str, value: Any, start: int, end: int) -> None:
        self.tokens.append((terminal, value, start, end))
        self.last = terminal

    def _operand(self, terminal: str, value: Any, start: int, end: int) -> None:
        """Emit the first token of an operand, and before it the product that is not written."""
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

    # --- numbers

    def _number(self, literal: str, start: int, end: int) -> None:
        span = self._span(start, end)
        value = float(literal)
        if not math.isfinite(value):
            raise UnreadableError("not_finite", span)
        if "e" in literal or "E" in literal:
            self._check_power_of_ten(literal, span)
        self._operand("NUMBER", Number(value, literal, *span), *span)

    def _check_power_of_ten(self, literal: str, span: Span) -> None:
        """Refuse 2e1 where e1 is declared, and 2e-1 where e is."""
        match = _E_NAME.search(literal)
        assert match is not None
        letter, sign, digits = match.groups()
        if (letter if sign else letter + digits) in self.vocabulary.by_name:
            product = f"{literal[: match.start()]}*{match.group()}"
            raise UnreadableError("ambiguous_number", span, product=product)

    # --- operators and brackets

    def _operator(self, text: str, start: int, end: int) -> None:
        span = self._span(start, end)
        if text in "([{":
            self._open(text, start, span)
        elif text in ")]}":
            self._close(text, span)
        elif text == "*" and self._is_joint():
            self._star(start, end, span)
        elif text in _TERMINALS:
            self._emit(_TERMINALS[text], None, *span)
        elif text == "°":
            self._emit("UNIT", "deg", *span)
        elif text == "√":
            self._operand("ROOT", None, *span)
        elif text == "|":
            self._bar(span)
        elif text == MARKER:
            self._marker(span)
        elif text == OPEN:
            self._open_fraction(start, span)
        else:
            self._close_fraction(span)

    def _close(self, bracket: str, span: Span) -> None:
        if self.brackets.close(bracket, span) != WRAPPING:
            self._emit("RIGHT", None, *span)

    def _is_wrapped(self, start: int) -> bool:
        r"""Whether braces hold nothing but round brackets: \sin{(q_1)}, as SymPy prints it."""
        inner = start + 1
        while self.text[inner : inner + 1].isspace():
            inner += 1
        depth = 0
        for at in range(inner, len(self.text)):
            depth += (self.text[at] == "(") - (self.text[at] == ")")
            if depth == 0:
                return at > inner and self.text[at + 1 :].lstrip().startswith("}")
        return False

    def _open(self, bracket: str, start: int, span: Span) -> None:
        is_index = bracket == "[" and self.last in OPERAND_ENDS
        if is_index and (index := INDEX.match(self.text, start)):
            place = self._span(start, index.end())
            raise UnreadableError("index", place, reason="no_stem", digits=index[1])
        if bracket == "{" and self.last == "FUNCTION" and self._is_wrapped(start):
            self.brackets.open(bracket, span, WRAPPING)
        else:
            self.brackets.open(bracket, span, len(self.tokens))
            self._operand("LEFT", None, *span)

    def _bar(self, span: Span) -> None:
        """Read |x|: a bar behind an operand closes, any other opens."""
        if self.last in OPERAND_ENDS and self.brackets.in_bars():
            self.brackets.close("|", span)
            self._emit("RIGHT", None, *span)
        else:
            self._operand("FUNCTION", ("abs", None), *span)
            self.brackets.open("|", span, len(self.tokens))
            self._emit("LEFT", None, *span)

    def _open_fraction(self, start: int, span: Span) -> None:
        if self.last == "NUMBER" and (match := _NUMERIC_FRACTION.match(self.text, start)):
            whole = self._span(start, match.end())
            fraction = re.sub(rf"[{OPEN}{CLOSE}{{}}\s]", "", match.group())
            raise UnreadableError("mixed_number", whole, fraction=fraction)
        self._operand("OPEN", None, *span)
        self.brackets.open(OPEN, span, len(self.tokens) - 1)

    def _close_fraction(self, span: Span) -> None:
        opener = self.brackets.close(CLOSE, span)
        self._emit("CLOSE", None, *span)
        if opener and self.tokens[opener - 1][0] == "FUNCTION":
            inside = {token[0] for token in self.tokens[opener:]}
            if inside <= {"OPEN", "CLOSE", "LEFT", "RIGHT", "NUMBER", "SLASH"}:
                self.fraction_end = len(self.tokens) - 1

    def _is_joint(self) -> bool:
        value = self.tokens[-1][1] if self.last == "NAME" else None
        return type(value) is SymbolNode and value.symbol.joint is not None

    def _star(self, start: int, end: int, span: Span) -> None:
        """Read the * right behind a joint variable: its marker, or a product."""
        typed = self.source[slice(*span)]
        star = read_star(self.text, start, end, typed, first=self._is_first_factor())
        if star == "ambiguous":
            variable = self.tokens[-1][2]
            raise UnreadableError("ambiguous_star", (variable, span[1]), star=span)
        if star in {"product", "noted_product"}:
            self._emit("STAR", None, *span)
        self.notes.star(star, span)

    def _is_first_factor(self) -> bool:
        """Whether the last operand begins a term: nothing, a bracket or a sign is before it."""
        before = [token[0] for token in self.tokens[-3:-1]]
        if before and before[-1] in _SIGNS:
            before.pop()
            return not before or before[-1] not in _FACTOR_OPERATORS
        return not before or before[-1] in _TERM_STARTS

    def _marker(self, span: Span) -> None:
        """Read a raised star, which marks a joint variable and nothing else."""
        if not self._is_joint():
            raise UnreadableError("character", span)
        self.notes.star("marker", span)

    # --- words

    def _word(self, run: str, start: int, end: int) -> int:
        """Read a run of letters and digits; return where to go on."""
        if run in MODULES and _ATTRIBUTE.match(self.text, end):
            return self._after_module(end + 1)
        pieces = split(run, self.vocabulary)
        if pieces is None:
            pieces, end = self._index(run, start, end)
        for piece in pieces:
            kind = piece.kind
            a, b = self._span(start + piece.start, start + piece.end)
            if kind == "symbol":
                self._operand("NAME", SymbolNode(piece.symbols[0], a, b), a, b)
            elif kind == "shorthand":
                self._shorthand(piece, piece is pieces[-1], start + piece.end, a, b)
            elif kind == "function":
                end = self._function(piece.word, start + piece.end, end, a, b)
            elif kind == "pi":
                self.notes.pi(a, b)
                self._operand("NAME", Pi(a, b), a, b)
            elif kind == "number":
                self._operand("NUMBER", Number(float(piece.word), piece.word, a, b), a, b)
            elif kind == "unit":
                self._unit(piece.word, start + piece.start, start + piece.end, a, b)
            else:
                raise UnreadableError("invalid_shorthand", (a, b), joint=piece.joint)
        return end

    def _after_module(self, at: int) -> int:
        """Read what follows ``np.``, where radians(90) is 90 degrees; return where to go on."""
        if self.text.startswith("radians(", at):
            end = at + len("radians")
            a, b = self._span(at, end)
            self._operand("FUNCTION", ("deg", None), a, b)
            return end
        return at

    def _index(self, run: str, start: int, end: int) -> tuple[tuple[Piece, ...], int]:
        """Read q[0], q(1) or q{1}; return the pieces and where to go on."""
        found = indexed(run, self.text, end, self.vocabulary)
        if found is None or (found.pieces is None and not is_family(run, self.vocabulary)):
            raise self._unknown(run, start, end)
        span = self._span(start, found.end)
        last = found.pieces[-1] if found.pieces else None
        if found.pieces is None or last is None or last.kind != "symbol":
            reason = "unknown" if last is None else "shorthand"
            raise UnreadableError(
                "index", span, reason=reason, run=run, style=found.style, digits=found.digits
            )
        symbol = last.symbols[0]
        stem = run[last.start :]
        place = self._span(start + last.start, found.end)
        self.indices.append((found, stem, place))
        self.notes.index(found.style, symbol, place)
        stretched = Piece(last.kind, last.start, found.end - start, symbols=last.symbols)
        return (*found.pieces[:-1], stretched), found.end

    def _check_indices(self) -> None:
        """Refuse q[0] beside q(1), and beside q1: together they have no one reading."""
        for found, stem, span in self.indices:
            if found.style != self.indices[0][0].style:
                raise UnreadableError("index", span, reason="mixed")
            if found.style == "[" and re.search(rf"{re.escape(stem)}_?[0-9]", self.text):
                raise UnreadableError("index", span, reason="mixed")

    def _shorthand(self, piece: Piece, last: bool, end: int, a: int, b: int) -> None:
        total = _sum_of(piece.symbols, a, b)
        if piece.ambiguous:
            goes_on = not last or self.text[end : end + 1] in {"(", "[", "{", ".", "°", "√", "^"}
            if self.degrees or goes_on:
                names = "+".join(symbol.name for symbol in piece.symbols)
                raise UnreadableError(
                    "ambiguous_shorthand", (a, b), function=piece.word, names=names
                )
        self.notes.shorthand(piece, a, b)
        self._operand("NAME", Call(piece.word, (total,), a, b), a, b)

    def _function(self, name: str, at: int, end: int, a: int, b: int) -> int:
        """Emit a function with the power written on it; return where to go on."""
        if name == "rad2deg" or (name in IN_DEGREES and not self.degrees):
            raise UnreadableError("degrees", (a, b), name=name)
        self.notes.function(name, a, b)
        name = IN_DEGREES.get(name, name)
        power: int | None = None
        raised = _FUNCTION_POWER.match(self.text, at) if at == end else None
        if raised is not None:
            exponent = _EXPONENT.match(self.text, raised.end())
            if exponent is None or len(exponent[exponent.lastindex or 0]) > 4:
                end = self._span(at, raised.end())[1]
                raise UnreadableError(
                    "function_power", (a, end), name=name, function=(a, b),
                    exponent=self.text[raised.end() :],
                )  # fmt: skip
            power = int(exponent[exponent.lastindex or 0])
            end = exponent.end()
        self._operand("FUNCTION", (name, power), a, b)
        return end

    def _unit(self, unit: str, start: int, end: int, a: int, b: int) -> None:
        opens = self.text[end : end + 1] == "("
        if self.last in OPERAND_ENDS and not opens:
            self._emit("UNIT", unit, a, b)
        elif self.last not in OPERAND_ENDS and opens and self.text[start:end] in UNIT_FUNCTIONS:
            self._emit("FUNCTION", (unit, None), a, b)
        else:
            raise UnreadableError("ambiguous_unit", (a, b), opens=opens)

    # --- words and characters that cannot be read

    def _unknown(self, run: str, start: int, end: int) -> UnreadableError:
        span = self._span(start, end)
        if run.lower() in {"nan", "inf", "infinity"}:
            return UnreadableError("not_finite", span)
        called = self.text[end : end + 1] == "("
        return UnreadableError("name", span, run=run, called=called, before=self.last)

    def _stray(self, letter: str, span: Span) -> UnreadableError:
        if letter == "'":
            return UnreadableError("transpose", span)
        return UnreadableError("values" if letter == ";" else "character", span, number=False)


def _sum_of(symbols: tuple[Symbol, ...], a: int, b: int) -> Node:
    total: Node = SymbolNode(symbols[0], a, b)
    for symbol in symbols[1:]:
        total = Binary("+", total, SymbolNode(symbol, a, b), a, b)
    return total
