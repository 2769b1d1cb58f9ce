"""Words instead of a value: variable, depends on theta, n/a."""

from service.expressions.parsing.lexing.words import split
from service.expressions.repairs.failure import Failure, Repair, error
from service.regex import regex
from service.translations import say

_WORD = regex(r"[A-Za-zÀ-ÿ]+")
_FORMULA = regex(r"[-+*/^=(){}\[\]_0-9\\]")
_PHRASES = {
    *("n/a", "n.a.", "na", "none", "null", "nil", "variable", "var", "unknown", "tbd", "idk"),
    *("any", "free", "same", "constant", "const", "undefined", "joint variable", "varies"),
    *("nothing", "not applicable", "empty", "yes", "no", "see above", "todo"),
    *("?", "??", "???", "...", "…"),
}
_NUMBERS = {"zero": "0", "one": "1", "two": "2", "ninety": "90", "half": "1/2", "nil": "0"}


def repair_prose(failure: Failure) -> Repair:
    """Ask the student for a number or a formula."""
    text = failure.source.strip().lower()
    number = _NUMBERS.get(text)
    if text not in _PHRASES and number is None and not _is_prose(failure):
        return None
    message = say("These are words. Write a number or a formula, such as 0 or theta1.")
    return error(failure, "prose", message, number, (0, len(failure.source)))


def _is_prose(failure: Failure) -> bool:
    if failure.cause != "name" or _FORMULA.search(failure.source):
        return False
    words = [word for word in _WORD.findall(failure.source) if len(word) > 1]
    return sum(split(word, failure.vocabulary) is None for word in words) > 1
