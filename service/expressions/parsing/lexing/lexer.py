"""Split plain characters into tokens: numbers, operators, brackets and words."""

import math
import re
from typing import Final

from service.expressions.characters.unicode import CLOSE, MARKER, OPEN
from service.expressions.errors import Span, UnreadableError
from service.expressions.parsing.lexing.brackets import WRAPPING, partners
from service.expressions.parsing.lexing.indices import INDEX
from service.expressions.parsing.lexing.joint_markers import read_star
from service.expressions.parsing.lexing.tokens import END, OPERAND_ENDS, Token
from service.expressions.parsing.lexing.word_lexer import WordLexer
from service.expressions.parsing.lexing.words import RUN
from service.expressions.tree import Number
from service.regex import regex

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
