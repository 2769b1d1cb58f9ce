r"""Parse tokens into a syntax tree, by recursive descent.

In the grammar, a word in capitals is a token, and { } may be repeated or left out:

    sum       = product { (PLUS | MINUS) product }
    product   = signed { (STAR | SLASH) signed | JOIN power }
    signed    = { PLUS | MINUS } power
    power     = postfix [ POWER exponent ] | bare_call
    exponent  = { PLUS | MINUS } ( postfix | bare_call )
    postfix   = atom { UNIT }
    atom      = simple | LEFT sum RIGHT
    simple    = NUMBER | NAME | ROOT atom | OPEN sum CLOSE
              | FUNCTION LEFT sum { COMMA sum } RIGHT
    bare_call = FUNCTION argument
    argument  = simple { UNIT } [ POWER exponent ] | simple TIGHT power | bare_call

``JOIN`` is a product without a sign: ``2q1``, ``l1 c1``, ``a(b)``. ``TIGHT`` is such a product in
the argument of a function without brackets: ``sin 2q1`` is ``sin(2q1)``. A function without
brackets takes one operand, so ``sin q1 * l1`` is ``sin(q1)*l1``. ``OPEN`` and ``CLOSE`` enclose a
fraction that is one operand, ``½`` or ``\frac{a}{b}``. A power of a power is ambiguous, so
``2^3^2`` is not in the grammar.

Only brackets are parsed by recursion, and the lexer allows at most ``LIMITS.depth`` open brackets.
Everything else that can be repeated (signs, roots, powers, functions without brackets) is kept in a
list until its operand is parsed, so no text comes near Python's recursion limit.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Final

from service.expressions.errors import UnreadableError
from service.expressions.parsing.lexing.tokens import END, Token
from service.expressions.parsing.tree_builder import Builder
from service.expressions.tree import Node, Operator

# Signs, powers and functions that wait for their operand.
_Pending = list[Callable[[Node], Node]]
_SIMPLE: Final = frozenset({"NAME", "NUMBER"})
_POSTFIXES: Final = frozenset({"UNIT", "POWER"})
_SUMS: Final[dict[str, Operator]] = {"PLUS": "+", "MINUS": "-"}


def parse(tokens: Sequence[Token], builder: Builder) -> Node:
    """Return the tree that ``builder`` makes of ``tokens``, whose last token is ``END``.

    Raises UnreadableError with the index of the first token that the grammar does not allow.
    """
    parser = _Parser(tokens, builder)
    tree = parser.sum()
    parser.take(END)
    return tree


class _Parser:
    # One method for each rule of the grammar; ``at`` is the index of the next token.
    # The method ``power`` implements the rules ``power``, ``exponent``, ``postfix``, ``bare_call``
    # and ``argument`` without recursion.
    __slots__ = ("at", "builder", "tokens")

    def __init__(self, tokens: Sequence[Token], builder: Builder) -> None:
        self.tokens = tokens
        self.builder = builder
        self.at = 0

    def take(self, terminal: str) -> Token:
        """Consume and return the next token, which must be a ``terminal``."""
        token = self.tokens[self.at]
        if token[0] != terminal:
            raise self.unexpected()
        self.at += 1
        return token

    def unexpected(self) -> UnreadableError:
        """Return the error that the grammar does not allow the next token."""
        place = self.tokens[self.at][2:]
        return UnreadableError("grammar", place, tokens=self.tokens, index=self.at)

    def sum(self) -> Node:
        left = self.product()
        while operator := _SUMS.get(self.tokens[self.at][0]):
            self.at += 1
            left = self.builder.add(operator, left, self.product())
        return left

    def product(self) -> Node:
        tokens, builder = self.tokens, self.builder
        left = self.signed()
        while True:
            at = self.at
            terminal = tokens[at][0]
            if terminal == "STAR":
                # A fast path, as in ``signed``.
                factor = tokens[at + 1]
                if factor[0] in _SIMPLE and tokens[at + 2][0] not in _POSTFIXES:
                    self.at = at + 2
                    left = builder.multiply(left, factor[1])
                    continue
                self.at = at + 1
                left = builder.multiply(left, self.signed())
            elif terminal == "JOIN":
                self.at += 1
                left = builder.join(left, self.power([]))
            elif terminal == "SLASH":
                self.at += 1
                left = builder.divide(left, self.signed())
            else:
                return left

    def signed(self) -> Node:
        # A fast path for most factors: a name or a number without a sign, a unit or a power.
        tokens, at = self.tokens, self.at
        terminal = tokens[at][0]
        if terminal in _SIMPLE and tokens[at + 1][0] not in _POSTFIXES:
            self.at += 1
            node: Node = tokens[at][1]
            return node
        pending: _Pending = []
        if terminal in _SUMS:
            self.signs(pending)
        return self.power(pending)

    def signs(self, pending: _Pending) -> None:
        """Parse signs. Raises UnreadableError for +-90°, which may be ±."""
        end = -1
        while True:
            terminal, _, start, stop = self.tokens[self.at]
            if start == end and {terminal, self.tokens[self.at - 1][0]} == {"PLUS", "MINUS"}:
                raise UnreadableError("plus_minus", (start - 1, stop))
            end = stop
            if terminal == "MINUS":
                pending.append(partial(self.builder.negate, start))
            elif terminal == "PLUS":
                pending.append(partial(self.builder.keep, start))
            else:
                return
            self.at += 1

    def power(self, pending: _Pending) -> Node:
        """Parse the next power, and apply the ``pending`` signs to it."""
        tokens, builder = self.tokens, self.builder
        is_argument = is_exponent = False
        while True:
            token = tokens[self.at]
            if token[0] == "FUNCTION" and tokens[self.at + 1][0] != "LEFT":
                self.at += 1
                pending.append(partial(builder.bare_call, token))
                is_argument, is_exponent = True, False
                continue
            operand = self.atom()
            token = tokens[self.at]
            if is_argument and token[0] == "TIGHT":
                self.at += 1
                pending.append(partial(builder.tight, operand))
                is_argument = False
                continue
            while token[0] == "UNIT":
                self.at += 1
                operand = builder.unit(operand, token[1], token[3])
                token = tokens[self.at]
            if token[0] != "POWER":
                break
            if is_exponent:
                raise self.unexpected()
            self.at += 1
            pending.append(partial(builder.raise_to, operand, token[2]))
            self.signs(pending)
            is_argument, is_exponent = False, True
        while pending:
            operand = pending.pop()(operand)
        return operand

    def atom(self) -> Node:
        token = self.tokens[self.at]
        terminal, value, start, _ = token
        if terminal == "NAME" or terminal == "NUMBER":
            self.at += 1
            node: Node = value
            return node
        if terminal == "FUNCTION":
            self.at += 1
            return self.call(token)
        if terminal == "LEFT":
            self.at += 1
            inner = self.sum()
            return self.builder.group(start, inner, self.take("RIGHT")[3])
        if terminal == "OPEN":
            self.at += 1
            inner = self.sum()
            return self.builder.fraction(start, inner, self.take("CLOSE")[3])
        if terminal == "ROOT":
            return self.root()
        raise self.unexpected()

    def root(self) -> Node:
        starts = []
        while self.tokens[self.at][0] == "ROOT":
            starts.append(self.take("ROOT")[2])
        operand = self.atom()
        for start in reversed(starts):
            operand = self.builder.root(start, operand)
        return operand

    def call(self, function: Token) -> Node:
        self.take("LEFT")
        arguments = [self.sum()]
        while self.tokens[self.at][0] == "COMMA":
            self.at += 1
            arguments.append(self.sum())
        return self.builder.call(function, arguments, self.take("RIGHT")[3])
