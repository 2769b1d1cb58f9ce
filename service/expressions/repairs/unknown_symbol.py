"""A name that is not declared."""

import re
from typing import Final

from service.expressions.characters import greek
from service.expressions.parsing.lexing.words import Piece, split
from service.expressions.repairs.failure import Failure, Repair, error, for_causes, undeclared
from service.expressions.repairs.nearest_name import nearest
from service.expressions.vocabulary.symbols import Kind, Symbol, Vocabulary, normal_form
from service.regex import regex
from service.translations import paragraph, say

_INDEXED = regex(r"([^0-9]+)[0-9]+")
_STEM = regex(r"[^0-9_]+")
# The letters that textbooks use for lengths.
_OF_LENGTHS: Final = frozenset("abdhlrLADHR")
# A short name of a joint angle. It is not read as one: t may also be a time or a translation.
_SHORT_ANGLE: Final = regex(r"t([0-9]{1,2})")
_OF_JOINTS: Final = frozenset({"q", "theta", "θ"})
_LISTED: Final = 8


@for_causes("name")
def repair_unknown_symbol(failure: Failure) -> Repair:
    """Suggest the most similar declared name, or list the names that may be meant."""
    run, vocabulary = failure.details["run"], failure.vocabulary
    message = undeclared(failure)
    if (product := _product(run, vocabulary)) is not None:
        message = paragraph(message, say("For a product, write {product}.", product=product))
        return error(failure, "unknown_symbol", message)
    known = nearest(run, vocabulary, failure.details["called"]) or _angle(run, vocabulary)
    if known is not None:
        message = paragraph(message, say("Did you mean {name}?", name=known))
        return error(failure, "unknown_symbol", message, failure.replaced(known))
    message = paragraph(message, _names(normal_form(run), vocabulary))
    return error(failure, "unknown_symbol", message)


def _angle(run: str, vocabulary: Vocabulary) -> str | None:
    match = _SHORT_ANGLE.fullmatch(normal_form(run))
    angle = vocabulary.turning.get(int(match[1])) if match else None
    return angle.name if angle else None


def _product(run: str, vocabulary: Vocabulary) -> str | None:
    plain = run.replace("_", "")
    pieces = split(plain, vocabulary) if plain != run else None
    return None if pieces is None else "*".join(_written(piece, plain) for piece in pieces)


def _written(piece: Piece, run: str) -> str:
    return piece.symbols[0].name if piece.kind == "symbol" else run[piece.start : piece.end]


def _names(name: str, vocabulary: Vocabulary) -> str:
    siblings = _siblings(name, vocabulary)
    if name in _OF_JOINTS:
        siblings = [symbol for symbol in vocabulary.symbols if symbol.joint is not None]
    if siblings:
        return _all_names(siblings, vocabulary)
    kind = _kind(name)
    named = [symbol for symbol in vocabulary.symbols if symbol.kind == kind]
    constants = [symbol for symbol in named if symbol.joint is None]
    if kind is not None and (constants or not (named or vocabulary.of_books)):
        return _names_of_kind(kind, named, vocabulary)
    return _all_names(list(vocabulary.symbols), vocabulary) if vocabulary.symbols else ""


def _all_names(symbols: list[Symbol], vocabulary: Vocabulary) -> str:
    names = _joined(symbols)
    if vocabulary.of_books:
        # Translators: names of variables, after "There is no `x` here."
        return say("There are {names}.", names=names)
    # Translators: names of variables, after "This exercise has no `x`."
    return say("It has {names}.", names=names)


def _names_of_kind(kind: Kind, named: list[Symbol], vocabulary: Vocabulary) -> str:
    # Name the constants first, then the joint variables.
    names = _joined(sorted(named, key=lambda symbol: symbol.joint is not None))
    if vocabulary.of_books:
        if kind == "length":
            return say("The lengths are {names}.", names=names)
        return say("The angles are {names}.", names=names)
    # Translators: "its" and "it" are the exercise, as in "This exercise has no `x`."
    if kind == "length":
        return say("Its lengths are {names}.", names=names) if names else say("It has no lengths.")
    return say("Its angles are {names}.", names=names) if names else say("It has no angles.")


def _siblings(name: str, vocabulary: Vocabulary) -> list[Symbol]:
    match = _INDEXED.fullmatch(name)
    if match is None:
        return []
    stem = greek.NAMES.get(match[1], match[1])
    sibling = re.compile(rf"{re.escape(stem)}_?[0-9]+", re.IGNORECASE)
    return [symbol for symbol in vocabulary.symbols if sibling.fullmatch(symbol.name)]


def _kind(name: str) -> Kind | None:
    match = _STEM.match(name)
    if match is None:
        return None
    if match[0] in _OF_LENGTHS:
        return "length"
    return "angle" if match[0] in greek.NAMES or match[0].lower() in greek.LETTERS else None


def _joined(symbols: list[Symbol]) -> str:
    names = [symbol.name for symbol in symbols[:_LISTED]]
    return ", ".join(names) + (", …" if len(symbols) > _LISTED else "")
