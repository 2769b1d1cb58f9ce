"""Plain characters -> tokens: numbers, operators, brackets and words, with notes on them.

It also knows the left side of an equation, which is not read. ``words.py`` splits a run of letters;
``parser.py`` builds the tree.
"""

import math
import re
from dataclasses import replace
from typing import Any, Final, Literal, NamedTuple

from dh_grader.expressions.characters import BREAKS, CLASS, CLOSE, MARKER, OPEN, Characters
from dh_grader.expressions.errors import LIMITS, Note, Span, UnreadableError, quoted
from dh_grader.expressions.vocabulary import (
    CAPITALS,
    FUNCTIONS_OF_DEGREES,
    IN_DEGREES,
    MODULES,
    OF_DEGREES,
    PI_CAPITALS,
    UNIT_FUNCTIONS,
    Binary,
    Call,
    Node,
    Number,
    Operand,
    Pi,
    Symbol,
    SymbolNode,
    Vocabulary,
)
from dh_grader.expressions.words import (
    INDEX,
    LONGEST_RUN,
    MEMBER,
    RUN,
    ZERO_IN_BRACKETS,
    Indexed,
    Piece,
    constant,
    counts_from_one,
    degrees_function_end,
    indexed,
    is_family,
    is_more_than_a_turn,
    sole_operand,
    split,
    split_in_other_case,
    subscripted,
)
from dh_grader.regex import regex
from dh_grader.translations import say

# --- Split plain characters into tokens: numbers, operators, brackets and words


# A token: its terminal, its value, and its [start, end) in the text as typed. The value is a node
# for NUMBER and NAME, the name and its power for FUNCTION, the unit for UNIT, None for the others.
Token = tuple[str, Any, int, int]
END: Final = "$END"

# An operand ends with one of these; it begins with NUMBER, NAME, FUNCTION, ROOT, LEFT or OPEN.
OPERAND_ENDS: Final = frozenset({"NUMBER", "NAME", "RIGHT", "CLOSE", "UNIT"})
_TIGHT_STARTS: Final = frozenset({"NAME", "LEFT", "OPEN"})
_FUNCTION_POWER: Final = regex(r"\s*(?:\^|\*\*)\s*")
_EXPONENT: Final = regex(
    r"([0-9]+)(?![0-9.eE])|\(\s*([0-9]+)\s*\)|\{\s*([0-9]+)\s*\}|\[\s*([0-9]+)\s*\]"
)

NUMBER: Final = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_TOKEN: Final = regex(
    rf"\s*(?:({RUN})|({NUMBER})|(\*\*|\.[*/^]|[-+*/^(),°√\[\]{{}}|{OPEN}{CLOSE}{MARKER}])|(.))",
    re.DOTALL,
)
_STRING: Final = regex(rf"{RUN}|{NUMBER}|\*\*|\.[*/^]|\s+|.", re.DOTALL)
_DIGITS: Final = frozenset("0123456789")
_TERMINALS: Final = {
    "+": "PLUS", "-": "MINUS", "*": "STAR", "/": "SLASH", "^": "POWER", "**": "POWER",
    ".*": "STAR", "./": "SLASH", ".^": "POWER", ",": "COMMA",
}  # fmt: skip
_E_NAME: Final = regex(r"([eE])([+-]?)([0-9]+)$")
_NUMERIC_FRACTION: Final = regex(rf"{OPEN}\{{?\s*[0-9]+\s*\}}?/\{{?\s*[0-9]+\s*\}}?{CLOSE}")
_BEGINS_WRAPPED: Final = regex(r"\{\s*\(")
_ENDS_WRAPPED: Final = regex(r"\)\s*\}")
# A bar that LaTeX marks as a left bar, and how many characters before the bar are searched.
_LEFT_REACH: Final = 40
_LEFT_BAR: Final = regex(r"(?:\\(?:m?left|[bB]igg?l)\s*(?:\||\\[a-z]*)|\\lvert)\Z")
_SIGNS: Final = frozenset({"PLUS", "MINUS"})
_TERM_STARTS: Final = frozenset({"LEFT", "OPEN", "COMMA"})
_FACTOR_OPERATORS: Final = frozenset({"STAR", "SLASH", "POWER"})
_ABBREVIATED: Final = regex(r"(?<=deg)\.(?=\s*(?:$|[-+)]))")


class Lexer:
    """Turns the ``characters`` of ``source`` into tokens, in one pass."""

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

    def run(self) -> list[Token]:
        """Return the tokens; the last token is END. May raise UnreadableError."""
        text, length = self.text, len(self.text)
        position = self._plain_run(text) if self.starts is None else 0
        while position < length:
            position = self._run_from(position, text)
        end = len(self.source)
        self.tokens.append((END, None, end, end))
        if self.indices:
            self._check_indices()
        return self.tokens

    def _plain_run(self, text: str) -> int:
        # Read a text in which no character was converted, as far as a fast and simple split works.
        # Return the position up to which the text was read. ``_run_from`` reads the rest.
        tokens, operands, end = self.tokens, self.vocabulary.operands, 0
        for string in _STRING.findall(text):
            start, end = end, end + len(string)
            operand = operands.get(string)
            if operand is not None:
                self._sole_operand(operand, start, end)
            elif string in _TERMINALS:
                if string == "*" and self.last == "NAME" and self._is_joint():
                    return start
                terminal = self.last = _TERMINALS[string]
                tokens.append((terminal, None, start, end))
            elif string == "(" or string == ")":
                self._operator(string, start, end)
            elif string[0] in _DIGITS:
                self._number(string, start, end)
            elif string[0].isalpha():
                after = self._word(string, start, end)
                if after != end:
                    return after
            elif string != " ":
                return start
        return end

    def _run_from(self, position: int, text: str) -> int:
        """Read tokens from ``position`` on. Return the position up to which the text was read."""
        # Stop after a token that is longer than the regular expression's match, such as a function
        # with its power.
        tokens, in_place = self.tokens, self.starts is None
        # The last alternative takes any character, so no character is skipped.
        for found in _TOKEN.finditer(text, position):
            group = found.lastindex or 0
            start, position = found.span(group)
            if group == 1:
                position = self._word(found[1], start, position)
            elif group == 3:
                operator = found[3]
                terminal = _TERMINALS.get(operator)
                if terminal is not None and not (
                    operator == "*" and self.last == "NAME" and self._is_joint()
                ):
                    # A fast path for most tokens: an unambiguous operator in an unchanged text.
                    a, b = (start, position) if in_place else self._span(start, position)
                    tokens.append((terminal, None, a, b))
                    self.last = terminal
                    continue
                position = self._operator(operator, start, position)
            elif group == 2:
                self._number(found[2], start, position)
            elif not self._is_percent_pi(found[4], position):
                raise self._stray(found[4], self._span(start, position))
            if position != found.end():
                break
        return position

    # --- numbers

    def _number(self, literal: str, start: int, end: int) -> None:
        a, b = span = self._span(start, end)
        value = float(literal)
        if value == math.inf:
            raise UnreadableError("not_finite", span)
        if "e" in literal or "E" in literal:
            self._check_power_of_ten(literal, span)
        self._operand("NUMBER", Number(value, literal, a, b), a, b)

    def _check_power_of_ten(self, literal: str, span: Span) -> None:
        """Raise UnreadableError for a power of ten such as 2e1 that may contain a symbol e1."""
        match = _E_NAME.search(literal)
        assert match is not None
        letter, sign, digits = match.groups()
        if (letter if sign else letter + digits) in self.vocabulary.by_name:
            product = f"{literal[: match.start()]}*{match.group()}"
            raise UnreadableError("ambiguous_number", span, product=product)

    # --- operators and brackets

    def _operator(self, text: str, start: int, end: int) -> int:
        span = self._span(start, end)
        if text in "([{":
            self._open(text, start, span)
        elif text in ")]}":
            return self._close(text, span, end)
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
        return end

    def _close(self, bracket: str, span: Span, end: int) -> int:
        opener = self.brackets.close(bracket, span)
        if bracket == "}" and self.last == "FUNCTION" and opener == len(self.tokens) - 2:
            # Braces around the name of a function mean nothing: {cos}^2 θ.
            _, (name, power), a, b = self.tokens.pop()
            self.tokens.pop()
            if power is None:
                power, end = self._function_power(name, end, a, b)
            self._emit("FUNCTION", (name, power), a, b)
        elif opener != WRAPPING:
            self._emit("RIGHT", None, *span)
        return end

    def _is_wrapped(self, start: int) -> bool:
        r"""True if braces enclose only round brackets: \sin{(q_1)}, as SymPy prints it."""
        inner = _BEGINS_WRAPPED.match(self.text, start)
        if inner is None:
            return False
        if self.partners is None:
            self.partners = partners(self.text)
        end = self.partners.get(inner.end() - 1)
        return end is not None and _ENDS_WRAPPED.match(self.text, end) is not None

    def _open(self, bracket: str, start: int, span: Span) -> None:
        is_index = bracket == "[" and self.last in OPERAND_ENDS
        if is_index and (index := INDEX.match(self.text, start)):
            place = self._span(start, index.end())
            raise UnreadableError("index", place, reason="no_stem", digits=index[1])
        if bracket == "{" and self.last == "FUNCTION" and self._is_wrapped(start):
            self.brackets.open(bracket, span, WRAPPING)
        else:
            self._operand("LEFT", None, *span)
            self.brackets.open(bracket, span, len(self.tokens) - 1)

    def _bar(self, span: Span) -> None:
        """Read a bar of |x|."""
        # A bar after an operand closes the pair. Any other bar opens one, and so does \left|.
        closes = self.last in OPERAND_ENDS and self.brackets.in_bars()
        if closes and not _LEFT_BAR.search(self.source, max(0, span[0] - _LEFT_REACH), span[1]):
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

    def _star(self, start: int, end: int, span: Span) -> None:
        """Read the * after a joint variable: a product, or a mark on the variable, as in θ1*."""
        typed = self.source[slice(*span)]
        star = read_star(self.text, start, end, typed, first=self._is_first_factor())
        if star == "ambiguous":
            variable = self.tokens[-1][2]
            raise UnreadableError("ambiguous_star", (variable, span[1]), star=span)
        if star in {"product", "noted_product"}:
            self._emit("STAR", None, *span)
        self.notes.star(star, span)

    def _is_first_factor(self) -> bool:
        """True if the last operand begins a term: nothing, a bracket or a sign precedes it."""
        before = [token[0] for token in self.tokens[-3:-1]]
        if before and before[-1] in _SIGNS:
            before.pop()
            return not before or before[-1] not in _FACTOR_OPERATORS
        return not before or before[-1] in _TERM_STARTS

    def _marker(self, span: Span) -> None:
        """Read a raised star, which marks a joint variable as in θ1*.

        Raises UnreadableError after anything else.
        """
        if not self._is_joint():
            raise UnreadableError("character", span)
        self.notes.star("marker", span)

    # --- characters that cannot be read

    def _is_percent_pi(self, letter: str, at: int) -> bool:
        """True if a % begins Maxima's %pi, and not a comment."""
        return letter == "%" and self.last not in OPERAND_ENDS and self.text.startswith("pi", at)

    def _stray(self, letter: str, span: Span) -> UnreadableError:
        if letter == "'":
            return UnreadableError("transpose", span)
        return UnreadableError("values" if letter == ";" else "character", span, number=False)

    # --- words

    def _word(self, run: str, start: int, end: int) -> int:
        operand = sole_operand(run, self.vocabulary) if self.starts is None else None
        if operand is None:
            return self._split_word(run, start, end)
        self._sole_operand(operand, start, end)
        return end

    def _split_word(self, run: str, start: int, end: int) -> int:
        """Read a run of letters and digits that may contain several names, as in l1c1.

        Return the position after the run.
        """
        if run in MODULES and (member := MEMBER.match(self.text, end)):
            return self._after_module(member.end())
        pieces = split(run, self.vocabulary)
        if pieces is None:
            if self._is_float_suffix(run, start):
                return end
            pieces, end = self._unsplit(run, start, end)
        for piece in pieces:
            kind, stop = piece.kind, start + piece.end
            a, b = self._span(start + piece.start, stop)
            if kind == "symbol":
                symbol = piece.symbols[0]
                self.symbols.add(symbol.name)
                self._operand("NAME", SymbolNode(symbol, a, b), a, b)
                if piece.word:
                    self.notes.other_capitals(piece.word, a, b)
                if symbol.kind == "angle" and piece.start:
                    self._note_product(run, pieces, piece, start)
            elif kind == "function":
                end = self._function(piece.word, stop, end, a, b)
            elif kind == "shorthand":
                self._shorthand(piece, piece is pieces[-1], stop, a, b)
            else:
                end = self._piece(piece, start, end)
        return end

    def _note_product(self, run: str, pieces: tuple[Piece, ...], angle: Piece, start: int) -> None:
        """Add a note on cβ, which is read as a product if c is a symbol."""
        before = pieces[pieces.index(angle) - 1]
        if before.kind == "symbol":
            a, b = self._span(start + before.start, start + angle.end)
            self.notes.product(run[before.start : before.end], angle.symbols[0], a, b)

    def _piece(self, piece: Piece, start: int, end: int) -> int:
        kind, word, stop = piece.kind, piece.word, start + piece.end
        a, b = self._span(start + piece.start, stop)
        if kind == "pi":
            self.notes.pi(a, b)
            self._operand("NAME", Pi(a, b), a, b)
            # In a spreadsheet, pi is a function without arguments: PI().
            return end + 2 * self.text.startswith("()", end)
        if kind == "constant":
            self._operand("NAME", constant(word, a, b), a, b)
        elif kind == "number":
            self._operand("NUMBER", Number(float(word), word, a, b), a, b)
        elif kind == "unit":
            self._unit(word, start + piece.start, stop, a, b)
            # The full stop of an abbreviation: 90 deg.
            return end + (stop == end and _ABBREVIATED.match(self.text, end) is not None)
        else:
            raise UnreadableError("invalid_shorthand", (a, b), joint=piece.joint)
        return end

    def _after_module(self, at: int) -> int:
        """Read the function ``radians`` or ``rad``, which takes degrees; return its end."""
        end = degrees_function_end(self.text, at)
        if end is None:
            if self.text.startswith("degrees(", at):
                # Python's ``degrees`` returns a number of degrees.
                raise UnreadableError("degrees", self._span(at, at + 7), name="degrees")
            return at
        a, b = self._span(at, end)
        self._operand("FUNCTION", ("deg", None), a, b)
        return end

    def _is_float_suffix(self, run: str, start: int) -> bool:
        """True if ``run`` is the last letter of a float in C: 0.5f."""
        return (
            run == "f"
            and self.last == "NUMBER"
            and "." in self.tokens[-1][1].literal
            and self.text[start - 1].isdigit()
        )

    def _unsplit(self, run: str, start: int, end: int) -> tuple[tuple[Piece, ...], int]:
        if len(run) > LONGEST_RUN:
            raise self._unknown(run, start, end)
        if run == "Subscript" and (found := subscripted(self.text, end)):
            name, stop = found
            pieces = split(name, self.vocabulary)
            if pieces and len(pieces) == 1 and pieces[0].kind == "symbol":
                return (Piece("symbol", 0, stop - start, symbols=pieces[0].symbols),), stop
        other = split_in_other_case(run, self.vocabulary)
        return (other, end) if other else self._index(run, start, end)

    def _index(self, run: str, start: int, end: int) -> tuple[tuple[Piece, ...], int]:
        """Read q[0], q(1) or q{1}.

        Return the names in this text, and the position after the text.
        """
        if self.from_one is None:
            self.from_one = counts_from_one(self.text)
        found = indexed(run, self.text, end, self.vocabulary, from_one=self.from_one)
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
        stretched = replace(last, end=found.end - start)
        return (*found.pieces[:-1], stretched), found.end

    def _check_indices(self) -> None:
        """Raise UnreadableError for q[0] together with q(1) or q1, which is ambiguous."""
        stems = set()
        for found, stem, span in self.indices:
            if found.style != self.indices[0][0].style:
                raise UnreadableError("index", span, reason="mixed")
            if found.style == "[" and stem not in stems:
                stems.add(stem)
                if re.search(rf"{re.escape(stem)}_?[0-9]", self.text):
                    raise UnreadableError("index", span, reason="mixed")

    def _shorthand(self, piece: Piece, last: bool, end: int, a: int, b: int) -> None:
        if piece.ambiguous:
            goes_on = not last or self.text[end : end + 1] in {"(", "[", "{", ".", "°", "√", "^"}
            if self.degrees or goes_on:
                names = "+".join(symbol.name for symbol in piece.symbols)
                raise UnreadableError(
                    "ambiguous_shorthand", (a, b), function=piece.word, names=names
                )
        self.notes.shorthand(piece, a, b)
        self._sole_operand((piece.word, piece.symbols), a, b)

    def _sole_operand(self, operand: Operand, a: int, b: int) -> None:
        function, symbols = operand
        first = symbols[0]
        node: Node = SymbolNode(first, a, b)
        self.symbols.add(first.name)
        if len(symbols) > 1:
            for symbol in symbols[1:]:
                self.symbols.add(symbol.name)
                node = Binary("+", node, SymbolNode(symbol, a, b), a, b)
        if function:
            node = Call(function, (node,), a, b)
        if self.last in OPERAND_ENDS:
            self._operand("NAME", node, a, b)
        else:
            self.tokens.append(("NAME", node, a, b))
            self.last = "NAME"

    def _function(self, name: str, at: int, end: int, a: int, b: int) -> int:
        if name == "rad2deg" or (name in IN_DEGREES and not self.degrees):
            raise UnreadableError("degrees", (a, b), name=name)
        self.notes.function(name, a, b)
        name = IN_DEGREES.get(name, name)
        power: int | None = None
        # A fast path: most names are followed by a bracket.
        if at == end and self.text[at : at + 1] != "(":
            power, end = self._function_power(name, at, a, b)
            # Julia writes cos.(q).
            end += self.text.startswith(".(", end)
        self._operand("FUNCTION", (name, power), a, b)
        return end

    def _function_power(self, name: str, at: int, a: int, b: int) -> tuple[int | None, int]:
        """Read the power after a function's name, as in sin^2.

        Return the power or None, and the position after the power.
        """
        raised = _FUNCTION_POWER.match(self.text, at)
        if raised is None:
            return None, at
        exponent = _EXPONENT.match(self.text, raised.end())
        if exponent is None or len(exponent[exponent.lastindex or 0]) > 4:
            end = self._span(at, raised.end())[1]
            raise UnreadableError(
                "function_power", (a, end), name=name, function=(a, b),
                exponent=self.text[raised.end() :],
            )  # fmt: skip
        return int(exponent[exponent.lastindex or 0]), exponent.end()

    def _unit(self, unit: str, start: int, end: int, a: int, b: int) -> None:
        opens = self.text[end : end + 1] == "("
        if self.last in OPERAND_ENDS and not opens:
            self._emit("UNIT", unit, a, b)
        elif (
            self.last not in OPERAND_ENDS
            and opens
            and self.text[start:end] in UNIT_FUNCTIONS
            and not (unit == "rad" and is_more_than_a_turn(self.text, end))
        ):
            self._emit("FUNCTION", (unit, None), a, b)
        elif self.last not in OPERAND_ENDS and opens and self._is_of_degrees(start, end):
            self._emit("FUNCTION", ("deg", None), a, b)
        else:
            raise UnreadableError("ambiguous_unit", (a, b), opens=opens)

    def _is_of_degrees(self, start: int, end: int) -> bool:
        """True for ``radians(90)`` and ``degrees(90)``, which can only mean 90°.

        Python's ``radians`` converts degrees, and nobody writes 90 radians.
        """
        of_zero = ZERO_IN_BRACKETS.match(self.text, end)
        is_large = is_more_than_a_turn(self.text, end)
        return self.text[start:end] in FUNCTIONS_OF_DEGREES and (is_large or of_zero is not None)

    def _unknown(self, run: str, start: int, end: int) -> UnreadableError:
        span = self._span(start, end)
        if run.lower() in {"nan", "inf", "infinity"}:
            return UnreadableError("not_finite", span)
        called = self.text[end : end + 1] == "("
        return UnreadableError("name", span, run=run, called=called, before=self.last)

    # --- tokens, and the product sign that is missing in texts such as 2q1

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


# --- The stack of open brackets, and the partner of each bracket


PARTNERS: Final = {"(": ")", "[": "]", "{": "}", "|": "|", OPEN: CLOSE}
_ROUND: Final = regex("[()]")
# The token index of redundant braces around round brackets, which have no token.
WRAPPING: Final = -1


class Brackets:
    """A stack of opening brackets, each with its position in the text as typed."""

    __slots__ = ("opened",)

    def __init__(self) -> None:
        self.opened: list[tuple[str, Span, int]] = []

    def open(self, bracket: str, span: Span, token: int) -> None:
        """Add an opening bracket, which is the token at index ``token``.

        Raises UnreadableError if the bracket is nested too deep.
        """
        if len(self.opened) >= LIMITS.depth:
            raise UnreadableError("beyond", span, limit="depth")
        self.opened.append((bracket, span, token))

    def close(self, bracket: str, span: Span) -> int | None:
        """Close the innermost bracket; return its token's index, or None if no bracket is open.

        Raises UnreadableError if ``bracket`` does not fit the innermost bracket.
        """
        if not self.opened:
            return None
        opener, place, token = self.opened.pop()
        if PARTNERS[opener] != bracket:
            raise UnreadableError("mismatch", span, opener=place, wanted=PARTNERS[opener])
        return token

    def in_bars(self) -> bool:
        """True if the innermost bracket is a bar, as in |x|."""
        return bool(self.opened) and self.opened[-1][0] == "|"


def partners(text: str) -> dict[int, int]:
    """Map the position of each opening round bracket to that of its closing bracket, if any."""
    found: dict[int, int] = {}
    opened: list[int] = []
    for match in _ROUND.finditer(text):
        if match.group() == "(":
            opened.append(match.start())
        elif opened:
            found[opened.pop()] = match.start()
    return found


# --- The star after a joint variable: the marker that tables print, or a product
#
# Followed by nothing    θ1*, (d3*), atan2(q1*, k)    the marker
# Followed by +          θ1* + 90°, d3*+l1            the marker: nobody writes a product like this
# Followed by -          θ1* - 90°, θ1*-π/2           the marker, with a note
#                        d3*-l1                       a product, with a note
# Followed by other text q1*k                         a product
#
# A raised star is always the marker.
#
# A marked variable is the first factor of its term. If another factor precedes it (k*q1*+s1), a
# star before + or before a subtracted angle is ambiguous. If a blank precedes the star (q1 * + k),
# a star before + is ambiguous.


# How a star was read; "noted" if the sign after it allows another reading.
Star = Literal["marker", "noted_marker", "product", "noted_product", "ambiguous"]

# An angle is subtracted from a marked joint variable as often as added: θ1*-π/2, θ1*-90°,
# θ1*-\frac{\pi}{2}.
_ANGLE_SUBTRACTED: Final = (
    rf"\s*-[\s({{{OPEN}]*(?:pi\b|π|[0-9.]+\s*+\*?+\s*+(?:pi\b|π)|[0-9.]+\s*(?:°|deg)|"
    rf"[0-9{{}}/ ]+{CLOSE}\s*+\*?+\s*+(?:pi\b|π))|\s*-\s*[0-9]{{2,}}\s*$"
)
_NOTHING: Final = regex(r"\s*(?:[)\]},]|$)")
_PLUS: Final = regex(r"\s*\+")
_MINUS: Final = regex(r"\s*-")
_SUBTRACTED: Final = regex(rf"\s+-\s|{_ANGLE_SUBTRACTED}")
# These are read as stars, but are never the marker.
_DOTS: Final = frozenset({"·", "⋅", "×", r"\cdot", r"\times"})


def read_star(text: str, start: int, end: int, typed: str, *, first: bool) -> Star:
    """Return how to read the * at text[start:end], which follows a joint variable.

    ``typed`` is the sign as typed. ``first`` is True if the variable is the first factor of its
    term.
    """
    # A dot always multiplies.
    if typed in _DOTS:
        return "product"
    spaced = text[start - 1].isspace()
    if _NOTHING.match(text, end):
        return "marker" if first else "product"
    if _PLUS.match(text, end):
        return "marker" if first and not spaced else "ambiguous"
    if spaced or not _MINUS.match(text, end):
        return "product"
    if _SUBTRACTED.match(text, end):
        return "noted_marker" if first else "ambiguous"
    return "noted_product"


# --- Add notes on single words that could also mean something else


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


# --- Equations whose left side is a name or empty: x = l1 c1, T(1,4) := l1 c1, = cos(q1)
#
# Only the right side is read. The left side is replaced by blanks, so that the positions of the
# other characters do not change.


_STYLE: Final = r"\\(?:mathrm|mathbf|mathit|mathsf|text|boldsymbol|bm|vec)\s*"
_LETTERS: Final = rf"(?:\\?[A-Za-z]{{1,12}}[0-9]{{0,3}}|[{CLASS}][0-9]{{0,3}})"
_SCRIPT: Final = r"[_^]\s*(?:\{[^{}=]{0,24}\}|\\?[A-Za-z0-9*]{1,12})"
_LEFT: Final = regex(
    rf"""
    (?: \$ | \s | \\[(\[,;:!] | \\q?quad(?![A-Za-z]) | \\begin\{{[a-z]+\*?\}} ){{0,8}}
    (?P<side>
      (?P<left>
        (?: (?:let|const|var|double|float|auto) \s++ )?
        (?: \{{\s*+\}}\s*+ )?
        (?: {_SCRIPT}\s*+ ){{0,2}}
        (?P<name> {_STYLE}\{{\s*{_LETTERS}\s*\}} | {_STYLE}[A-Za-z] | {_LETTERS} )?
        (?: \s*+{_SCRIPT} | [₀-₉]+ | ['’′*] | \.[A-Za-z]{{1,8}} ){{0,3}}
        (?P<brackets> (?: \s*+[(\[{{]\s*+[\w\s,:\\]{{1,32}}[)\]}}] ){{0,2}} )
      )
      \s*+ &? \s*+ (?: :?==? | ≔ | \\coloneqq(?![A-Za-z]) )
    )
    """,
    re.VERBOSE,
)
_EQUALS: Final = regex(r"=|≔|\\coloneqq(?![A-Za-z])|≈|≡|\\(?:approx|equiv)(?![A-Za-z])|[<>≤≥]")
_WORD: Final = regex(r"[A-Za-z]+[0-9]*")
# A name in brackets, which may be a factor of a product. The time, as in q1(t), is not a factor.
_OF_NAMES: Final = regex(r"[(\[{]\s*+(?!t\s*+\))[^0-9\s]")


class LeftSide(NamedTuple):
    """The name before an equals sign. ``span`` is the position of the name and the sign."""

    name: str
    span: Span


def left_side(source: str, vocabulary: Vocabulary) -> LeftSide | None:
    """Return the name before the equals sign of an equation; None for any other text."""
    if "=" not in source and "≔" not in source and r"\coloneqq" not in source:
        return None
    found = _LEFT.match(source)
    if found is None or _EQUALS.search(source, found.end()):
        return None
    if not source[found.end() :].strip(" $") or not _is_a_name(found, vocabulary):
        return None
    return LeftSide(" ".join(found["left"].split()), found.span("side"))


def right_side(source: str, vocabulary: Vocabulary) -> tuple[str, Note | None]:
    """Replace a name and its equals sign by blanks.

    Return the new text and a note on the change.
    """
    left = left_side(source, vocabulary)
    if left is None:
        return source, None
    start, end = left.span
    message = say("Only the right side of the equation was read.")
    return f"{source[:start]}{' ' * (end - start)}{source[end:]}", Note(
        "equation", message, left.span
    )


def _is_a_name(found: re.Match[str], vocabulary: Vocabulary) -> bool:
    """True if the left side is a name, not a function (cos) or a product (l1 (c1 + c2))."""
    words = _WORD.findall(found["name"] or "")
    pieces = split(words[-1], vocabulary) if words else None
    if pieces is None:
        return True
    return pieces[0].kind != "function" and not _OF_NAMES.search(found["brackets"])
