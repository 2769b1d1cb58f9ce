"""A name that is not declared."""

import re
from typing import Final

from service.expressions.characters import greek
from service.expressions.parsing.lexing.words import Piece, split
from service.expressions.repairs.failure import Failure, Repair, error, for_causes, undeclared
from service.expressions.repairs.nearest_name import nearest
from service.expressions.vocabulary.symbols import Kind, Symbol, Vocabulary, normal_form

_INDEXED = re.compile(r"([^0-9]+)[0-9]+")
_STEM = re.compile(r"[^0-9_]+")
# The letters that textbooks use for lengths.
_OF_LENGTHS: Final = frozenset("abdhlrLADHR")
_OF_JOINTS: Final = frozenset({"q", "theta", "θ"})
_LISTED: Final = 8


@for_causes("name")
def repair(failure: Failure) -> Repair:
    """Suggest the most similar declared name, or list the names that may be meant."""
    run, vocabulary = failure.details["run"], failure.vocabulary
    message = undeclared(failure)
    if (product := _product(run, vocabulary)) is not None:
        message += f" For a product, write {product}."
        return error(failure, "unknown_symbol", message)
    known = nearest(run, vocabulary, failure.details["called"])
    if known is not None:
        message += f" Did you mean {known}?"
        return error(failure, "unknown_symbol", message, failure.replaced(known))
    return error(failure, "unknown_symbol", message + _listed(normal_form(run), vocabulary))


def _product(run: str, vocabulary: Vocabulary) -> str | None:
    """Return the product that a run would be without its underscores (a*b for a_b), or None."""
    plain = run.replace("_", "")
    pieces = split(plain, vocabulary) if plain != run else None
    return None if pieces is None else "*".join(_written(piece, plain) for piece in pieces)


def _written(piece: Piece, run: str) -> str:
    return piece.symbols[0].name if piece.kind == "symbol" else run[piece.start : piece.end]


def _listed(name: str, vocabulary: Vocabulary) -> str:
    """Return a sentence that lists the names with the same letter, of the same kind, or all."""
    siblings = _siblings(name, vocabulary)
    has, its = ("There are", "The") if vocabulary.of_books else ("It has", "Its")
    if name in _OF_JOINTS:
        siblings = [symbol for symbol in vocabulary.symbols if symbol.joint is not None]
    if siblings:
        return f" {has} {_joined(siblings)}."
    kind = _kind(name)
    named = [symbol for symbol in vocabulary.symbols if symbol.kind == kind]
    constants = [symbol for symbol in named if symbol.joint is None]
    if constants:
        return f" {its} {kind}s are {_joined(constants)}."
    if kind is not None and not named:
        return f" {has} no {kind}s."
    return f" {has} {_joined(list(vocabulary.symbols))}." if vocabulary.symbols else ""


def _siblings(name: str, vocabulary: Vocabulary) -> list[Symbol]:
    match = _INDEXED.fullmatch(name)
    if match is None:
        return []
    stem = greek.NAMES.get(match[1], match[1])
    sibling = re.compile(rf"{re.escape(stem)}_?[0-9]+", re.IGNORECASE)
    return [symbol for symbol in vocabulary.symbols if sibling.fullmatch(symbol.name)]


def _kind(name: str) -> Kind | None:
    """Return the kind of quantity that a name's letter suggests, or None."""
    match = _STEM.match(name)
    if match is None:
        return None
    if match[0] in _OF_LENGTHS:
        return "length"
    return "angle" if match[0] in greek.NAMES or match[0].lower() in greek.LETTERS else None


def _joined(symbols: list[Symbol]) -> str:
    names = [symbol.name for symbol in symbols[:_LISTED]]
    return ", ".join(names) + (", …" if len(symbols) > _LISTED else "")
