"""A name and its index with a space between them: theta 1, c 12."""

from service.expressions.characters import greek
from service.expressions.parsing.lexing.words import split
from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.regex import regex
from service.translations import say

_DETACHED = regex(rf"([A-Za-z{greek.CLASS}]+)[ _]+([0-9]+)(?![0-9.])")


@for_causes("name")
def repair_detached_index(failure: Failure) -> Repair:
    """Suggest name and index without the space, if the result is a known name."""
    match = _DETACHED.match(failure.source, failure.span[0])
    if match is None or match.end(1) != failure.span[1]:
        return None
    joined = f"{match[1]}{match[2]}"
    pieces = split(joined, failure.vocabulary)
    if pieces is None or pieces[-1].kind not in {"symbol", "shorthand"}:
        return None
    message = say("Write the name and its index without a space: {name}.", name=joined)
    suggestion = failure.replaced(joined, match.span())
    return error(failure, "detached_index", message, suggestion, match.span())
