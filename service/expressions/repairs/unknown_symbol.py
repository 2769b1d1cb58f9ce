"""A name that is not declared."""

import re

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted
from service.expressions.repairs.nearest_name import nearest
from service.expressions.vocabulary.symbols import Vocabulary, normal_form

_INDEXED = re.compile(r"([^0-9]+)[0-9]+")


@answers("name")
def repair(failure: Failure) -> Repair:
    """Offer the nearest declared name, or list those that differ in their index alone."""
    run = failure.details["run"]
    message = f"The name {quoted(failure.written)} is not known in this exercise."
    siblings = _siblings(normal_form(run), failure.vocabulary)
    if siblings:
        message += f" These are: {', '.join(siblings)}."
        return error(failure, "unknown_symbol", message)
    known = nearest(run, failure.vocabulary, failure.details["called"])
    if known is None:
        return error(failure, "unknown_symbol", message)
    message += f" Did you mean {known}?"
    return error(failure, "unknown_symbol", message, failure.replaced(known))


def _siblings(name: str, vocabulary: Vocabulary) -> list[str]:
    match = _INDEXED.fullmatch(name)
    if match is None:
        return []
    sibling = re.compile(rf"{re.escape(match[1])}_?[0-9]+")
    return [symbol.name for symbol in vocabulary.symbols if sibling.fullmatch(symbol.name)]
