"""Powers of functions: sin^-1(x), which may mean asin(x) or 1/sin(x), and sin^k(x)."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.regex import regex
from service.translations import say

_INVERSE = regex(r"(-\s*1|[({]\s*-\s*1\s*[)}])(?![0-9.])")
# An exponent -1 in the source text, in any notation.
_END = regex(r"[\s^*]*(?:⁻\s*¹|[({]*\s*[-−–]\s*1(?:\s*[)}])*)")


@for_causes("function_power")
def repair_function_power(failure: Failure) -> Repair:
    """Suggest the inverse function for ^-1. Show how to write other powers: (sin(x))^p."""
    name, exponent = failure.details["name"], failure.details["exponent"]
    place = failure.details["function"]
    if not exponent.strip():
        message = say("The function {name} has no argument. Write {name}(x).", name=name)
        return error(failure, "function_without_argument", message, span=place)
    if _INVERSE.match(exponent) is None:
        message = say(
            "The power of a function is a whole number. Write another power as (sin(x))^p."
        )
        return error(failure, "function_power", message, span=(place[1], failure.span[1]))
    end = _END.match(failure.source, place[1])
    whole = (place[0], end.end() if end else failure.span[1])
    inverse = f"a{name}" if name in {"sin", "cos", "tan"} else None
    message = say("A negative power of a function has two readings. Write 1/{name}(x).", name=name)
    if inverse:
        message = say(
            "This has two readings. Write {inverse}(x) for the inverse function, or 1/{name}(x).",
            inverse=inverse,
            name=name,
        )
    suggestion = inverse and failure.replaced(inverse, whole)
    return error(failure, "function_power", message, suggestion, whole)
