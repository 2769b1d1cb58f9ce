"""Turn words into tokens: names, functions with their powers, units, and indices in brackets."""

import re
from dataclasses import replace
from typing import Final

from service.expressions.errors import UnreadableError
from service.expressions.parsing.lexing.indices import indexed, is_family
from service.expressions.parsing.lexing.letter_case import split_in_other_case
from service.expressions.parsing.lexing.programs import (
    MEMBER,
    constant,
    counts_from_one,
    degrees_function_end,
    is_more_than_a_turn,
    subscripted,
)
from service.expressions.parsing.lexing.tokens import OPERAND_ENDS, TokenWriter
from service.expressions.parsing.lexing.words import LONGEST_RUN, Piece, sole_operand, split
from service.expressions.tree import Binary, Call, Node, Number, Pi, SymbolNode
from service.expressions.vocabulary.functions import IN_DEGREES, MODULES, UNIT_FUNCTIONS
from service.expressions.vocabulary.symbols import Operand
from service.regex import regex

_FUNCTION_POWER: Final = regex(r"\s*(?:\^|\*\*)\s*")
_EXPONENT: Final = regex(
    r"([0-9]+)(?![0-9.eE])|\(\s*([0-9]+)\s*\)|\{\s*([0-9]+)\s*\}|\[\s*([0-9]+)\s*\]"
)


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
        else:
            raise UnreadableError("invalid_shorthand", (a, b), joint=piece.joint)
        return end

    def _after_module(self, at: int) -> int:
        """Read the function ``radians`` or ``rad``, which takes degrees; return its end."""
        end = degrees_function_end(self.text, at)
        if end is None:
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
        else:
            raise UnreadableError("ambiguous_unit", (a, b), opens=opens)

    def _unknown(self, run: str, start: int, end: int) -> UnreadableError:
        span = self._span(start, end)
        if run.lower() in {"nan", "inf", "infinity"}:
            return UnreadableError("not_finite", span)
        called = self.text[end : end + 1] == "("
        return UnreadableError("name", span, run=run, called=called, before=self.last)
