"""Functions that no answer needs (log, sinh, max), and other names of known functions (cosine)."""

from service.expressions.parsing.lexing.words import split
from service.expressions.repairs.failure import (
    Failure,
    Repair,
    error,
    for_causes,
    quoted,
    undeclared,
)
from service.expressions.vocabulary.functions import ARITY, REFUSED
from service.regex import regex
from service.translations import listed, paragraph, say

_RENAMED = {
    "tan2": "atan2", "arctg2": "atan2", "artan2": "atan2", "atang2": "atan2", "atan22": "atan2",
    "square_root": "sqrt", "squareroot": "sqrt", "root": "sqrt", "wurzel": "sqrt",
    "absolute": "abs", "betrag": "abs", "cosine": "cos", "sine": "sin", "tangent": "tan",
    "sinus": "sin", "cosinus": "cos", "kosinus": "cos", "coseno": "cos", "seno": "sin",
    "tangens": "tan", "tangente": "tan", "tang": "tan", "ArcCosine": "acos", "ArcSine": "asin",
    "c": "cos", "s": "sin", "t": "tan", "C": "cos", "S": "sin",
}  # fmt: skip
_SHORT = frozenset("csCS")
# Numbers in brackets: MATLAB's c(1, 2) is an element of an array, and SymPy's S(1) is a number.
_OF_NUMBERS = regex(r"\(\s*[0-9]+(?:\s*[,;]\s*[0-9]+)*\s*\)")


def _after_factor(failure: Failure) -> str | None:
    factor, letter = failure.details["run"][:-1], failure.details["run"][-1:]
    if letter not in _SHORT or not factor or _OF_NUMBERS.match(failure.source, failure.span[1]):
        return None
    return None if split(factor, failure.vocabulary) is None else f"{factor} {_RENAMED[letter]}"


@for_causes("name")
def repair_unknown_function(failure: Failure) -> Repair:
    """List the functions that can be used; for cosine, suggest the known name cos."""
    name = failure.details["run"].replace("_", "")
    if name in REFUSED:
        written = quoted(failure.written)
        message = say(
            "{written} is not needed here. The functions are {functions}.",
            written=written,
            functions=listed(list(ARITY)),
        )
        return error(failure, "unknown_function", message)
    run = failure.details["run"]
    if len(run) == 1 and _OF_NUMBERS.match(failure.source, failure.span[1]):
        if not failure.vocabulary.joints:
            return None
        advice = say("Write the shorthand without brackets, as in c12.")
        return error(failure, "unknown_function", paragraph(undeclared(failure), advice))
    renamed = _RENAMED.get(run) or _after_factor(failure)
    if renamed is None or not failure.details["called"]:
        return None
    message = say(
        "{written} is no function here. Did you mean {function}?",
        written=quoted(failure.written),
        function=renamed,
    )
    return error(failure, "unknown_function", message, failure.replaced(renamed))
