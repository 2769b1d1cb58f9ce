"""The text sin45, which may be the sine of 45 or of the sum of the joint angles 4 and 5."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.regex import regex
from service.translations import say

_GOES_ON = regex(r"\.?\w+")


@for_causes("ambiguous_shorthand")
def repair_ambiguous_shorthand(failure: Failure) -> Repair:
    """Suggest brackets for sin2q1; explain that sin45 is ambiguous."""
    function, names = failure.details["function"], failure.details["names"]
    digits = "".join(letter for letter in failure.written if letter.isdigit())
    start, end = failure.span
    if match := _GOES_ON.match(failure.source, end):
        whole = start, match.end()
        message = say(
            "Write the argument of {function} in brackets, as in {function}(2*x).",
            function=function,
        )
        in_brackets = f"{function}({digits}{match.group()})"
        suggestion = failure.replaced(in_brackets, whole)
        return error(failure, "ambiguous_shorthand", message, suggestion)
    message = say(
        "{written} has two readings. Write {function}({angles}) for the joint angles or "
        "{function}({number}) for the number.",
        written=quoted(failure.written),
        function=function,
        angles=names,
        number=digits,
    )
    # In cos12(q1), the bracket may be a factor or an argument.
    is_followed = failure.source[end : end + 1] in {"(", "[", "{"}
    plain = None if is_followed else failure.replaced(f"{function}({names})")
    return error(failure, "ambiguous_shorthand", message, plain)
