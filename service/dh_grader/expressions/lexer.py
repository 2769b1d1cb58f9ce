"""Plain characters -> tokens: numbers, operators, brackets and words, with notes on them.

``words.py`` splits a run of letters; ``parser.py`` builds the tree.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Final

from dh_grader.expressions.characters import CLOSE, MARKER, OPEN
from dh_grader.expressions.errors import Note, Span, UnreadableError
from dh_grader.expressions.vocabulary import (
    FUNCTIONS_OF_DEGREES,
    IN_DEGREES,
    MODULES,
    TRIGONOMETRIC,
    UNIT_FUNCTIONS,
    Binary,
    Call,
    Negation,
    Node,
    Number,
    Operand,
    Pi,
    Symbol,
    SymbolNode,
)
from dh_grader.expressions.words import (
    END,
    INDEX,
    LONGEST_RUN,
    MEMBER,
    OPERAND_ENDS,
    RUN,
    WRAPPING,
    ZERO_IN_BRACKETS,
    Piece,
    Token,
    TokenWriter,
    constant,
    counts_from_one,
    degrees_function_end,
    indexed,
    is_family,
    is_more_than_a_turn,
    partners,
    read_star,
    sole_operand,
    split,
    split_in_other_case,
    subscripted,
)
from dh_grader.regex import regex
from dh_grader.translations import say

# --- Notes on formulas that are read literally although the student may mean something else
#
# ``θ1 + 90`` adds 90 radians, ``cos(1)`` is the cosine of 1 radian, ``s1+2`` is a sine plus 2, and
# ``0·5`` is 0.


# Students hardly mean larger angles (90, 180 or 22.5) in radians.
_WHOLE_TURN: Final = 2 * math.pi
_SHORTHAND: Final = regex(r"(?:[cCsS]|cos|sin)_?[0-9₀-₉]+")
_DIGIT: Final = regex(r"[1-9]")
_DOTS: Final = ("·", "⋅", "∙", "•")


def on_sum(left: Node, right: Node, *, degrees: bool) -> Note | None:
    """Return a note on a sum such as θ1 + 90, which may mean degrees; else None."""
    for one, other in ((left, right), (right, left)):
        number = _number(other)
        if number is not None and not degrees and _is_large(number) and _is_angle(one):
            return _radians(number)
    return None


def on_shorthand(
    source: str, left: Node, right: Node, turning: Mapping[int, Symbol]
) -> Note | None:
    """Return a note on a sum such as s1+2, which may mean s12; else None."""
    if type(right) is not Number or not _DIGIT.fullmatch(right.literal):
        return None
    last, digit = left, right.literal
    while type(last) is Binary and last.right.end == last.end:
        last = last.right
    written = source[last.start : last.end]
    if type(last) is not Call or source[last.end : right.start] != "+":
        return None
    joint = _last_joint(last.arguments[0])
    if joint is None or not joint < int(digit) or int(digit) not in turning:
        return None
    if not _SHORTHAND.fullmatch(written):
        return None
    if last.function == "sin":
        message = say(
            "This was read as {sine} + {digit}. For the sine of a sum of joint angles, write "
            "{sine}{digit}.",
            sine=written,
            digit=digit,
        )
    else:
        message = say(
            "This was read as {cosine} + {digit}. For the cosine of a sum of joint angles, write "
            "{cosine}{digit}.",
            cosine=written,
            digit=digit,
        )
    return Note("shorthand", message, (last.start, right.end))


def on_product(source: str, left: Number, right: Number) -> Note | None:
    """Return a note on a product such as 0·5, whose dot may be a decimal point; else None."""
    if source[left.end : right.start] not in _DOTS or "." in left.literal + right.literal:
        return None
    message = say(
        "{written} was read as a product. In a decimal number, write a full stop: {number}.",
        written=source[left.start : right.end],
        number=f"{left.literal}.{right.literal}",
    )
    return Note("raised_dot", message, (left.start, right.end))


def on_call(
    function: str, argument: Node, turning: Mapping[int, Symbol], *, degrees: bool
) -> Note | None:
    """Return a note on cos(1), which may mean joint angle 1, or cos(90), which may mean 90°."""
    number = _number(argument)
    if number is None or function not in TRIGONOMETRIC:
        return None
    joint = turning.get(int(number.literal)) if _DIGIT.fullmatch(number.literal) else None
    if joint is not None:
        text, formula = number.literal, f"{function}({joint.name})"
        if degrees:
            message = say(
                "{number} was read as a number of degrees. For the joint angle, write {formula}.",
                number=text,
                formula=formula,
            )
        else:
            message = say(
                "{number} was read as a number of radians. For the joint angle, write {formula}.",
                number=text,
                formula=formula,
            )
        return Note("bare_radians", message, (number.start, number.end))
    return _radians(number) if not degrees and _is_large(number) else None


def _radians(number: Number) -> Note:
    message = say(
        "{number} was read as {number} radians. For degrees, write {number}°.",
        number=number.literal,
    )
    return Note("bare_radians", message, (number.start, number.end))


def _number(node: Node) -> Number | None:
    node = node.operand if type(node) is Negation else node
    return node if type(node) is Number else None


def _is_large(number: Number) -> bool:
    return number.value > _WHOLE_TURN and (2 * number.value).is_integer()


def _is_angle(node: Node) -> bool:
    parts: list[Node] = [node]
    if type(node) is Binary:
        parts += [node.left, node.right]
    plain = (part.operand if type(part) is Negation else part for part in parts)
    return any(type(part) is SymbolNode and part.symbol.kind == "angle" for part in plain)


def _last_joint(argument: Node) -> int | None:
    last = argument.right if type(argument) is Binary else argument
    return last.symbol.joint if type(last) is SymbolNode else None


# --- Turn words into tokens: names, functions with their powers, units, and indices in brackets


_FUNCTION_POWER: Final = regex(r"\s*(?:\^|\*\*)\s*")
_EXPONENT: Final = regex(
    r"([0-9]+)(?![0-9.eE])|\(\s*([0-9]+)\s*\)|\{\s*([0-9]+)\s*\}|\[\s*([0-9]+)\s*\]"
)


_ABBREVIATED: Final = regex(r"(?<=deg)\.(?=\s*(?:$|[-+)]))")


class WordLexer(TokenWriter):
    """Turns runs of letters and digits into tokens."""

    __slots__ = ()

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


# --- Split plain characters into tokens: numbers, operators, brackets and words


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


class Lexer(WordLexer):
    """Turns the ``characters`` of ``source`` into tokens, in one pass."""

    __slots__ = ()

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
