"""Names in another letter case than declared: l1 if only L1 is declared.

Such a name is accepted if it has no other meaning and fits only one symbol.
"""

from dataclasses import replace
from functools import lru_cache
from string import ascii_letters, digits
from typing import Final

from service.expressions.characters import greek
from service.expressions.parsing.lexing.words import Piece, split
from service.expressions.vocabulary.functions import RESERVED
from service.expressions.vocabulary.symbols import Symbol, Vocabulary

_PLAIN: Final = frozenset(ascii_letters + digits)


def split_in_other_case(run: str, vocabulary: Vocabulary) -> tuple[Piece, ...] | None:
    """Split a run of letters and digits into known names, ignoring letter case.

    Return None if this is impossible.
    """
    # A single letter of another case is a name only if it is the whole run.
    pieces = split(run, _with_other_capitals(vocabulary))
    if pieces is None:
        return None
    declared = {symbol.name: symbol for symbol in vocabulary.symbols}
    found = []
    for piece in pieces:
        written = run[piece.start : piece.end].replace("_", "")
        if piece.kind == "symbol" and written not in vocabulary.by_name:
            if len(written) == 1 and len(pieces) > 1:
                return None
            piece = replace(piece, word=declared[piece.symbols[0].name].name)
        symbols = tuple(declared[symbol.name] for symbol in piece.symbols)
        found.append(replace(piece, symbols=symbols))
    return tuple(found)


@lru_cache(maxsize=256)
def _with_other_capitals(vocabulary: Vocabulary) -> Vocabulary:
    """Return the vocabulary, extended by the names of its symbols in other letter cases."""
    owners: dict[str, dict[str, Symbol]] = {}
    for name, symbol in vocabulary.by_name.items():
        for other in {name.lower(), name.upper(), name[0].swapcase() + name[1:]}:
            # A capital alpha is not accepted, because it looks like an A.
            if not set(other) - set(greek.CLASS) <= _PLAIN:
                continue
            owners.setdefault(other, {})[symbol.name] = symbol
    names: dict[str, tuple[str, ...]] = {}
    for other, symbols in owners.items():
        if len(symbols) == 1 and other not in RESERVED and split(other, vocabulary) is None:
            [owner] = symbols
            names[owner] = (*names.get(owner, ()), other)
    return Vocabulary(
        [
            replace(symbol, aliases=(*symbol.aliases, *names.get(symbol.name, ())))
            for symbol in vocabulary.symbols
        ]
    )
