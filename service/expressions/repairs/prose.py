"""Words in place of a value: variable, depends on theta, n/a."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.parsing.words import split
from service.expressions.repairs.failure import Failure

_WORD = re.compile(r"[A-Za-zÀ-ÿ]+")
_PHRASES = {
    *("n/a", "n.a.", "na", "none", "null", "nil", "variable", "var", "unknown", "tbd", "idk"),
    *("any", "free", "same", "constant", "const", "undefined", "joint variable", "varies"),
    *("nothing", "not applicable", "empty", "yes", "no", "see above", "todo"),
    *("?", "??", "???", "...", "…"),
}
_NUMBERS = {"zero": "0", "one": "1", "two": "2", "ninety": "90", "half": "1/2", "nil": "0"}


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for the value itself."""
    if failure.cause == "beyond":
        return None
    text = failure.source.strip().lower()
    number = _NUMBERS.get(text)
    if text not in _PHRASES and number is None and not _is_prose(failure):
        return None
    return ExpressionError(
        "prose",
        "These are words; write the value as a number or a formula, for example 0, l1 or theta1.",
        (0, len(failure.source)),
        number,
    )


def _is_prose(failure: Failure) -> bool:
    """Whether the text holds two words or more that mean nothing here, and no formula."""
    if failure.cause != "name" or "\\" in failure.source:
        return False
    words = [word for word in _WORD.findall(failure.source) if len(word) > 1]
    strange = [word for word in words if split(word, failure.vocabulary) is None]
    formula = re.search(r"[-+*/^=(){}\[\]_0-9]", failure.source)
    return len(strange) > 1 and formula is None
