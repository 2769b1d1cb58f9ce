"""Functions that are not read: sec, cot, ln, hypot."""

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted
from service.expressions.vocabulary.functions import ARITY

_RECIPROCALS = {"sec": "cos", "csc": "sin", "cosec": "sin", "cot": "tan", "ctg": "tan"}
_RENAMED = {
    "tan2": "atan2", "arctg2": "atan2", "artan2": "atan2", "atang2": "atan2", "atan22": "atan2",
    "square_root": "sqrt", "squareroot": "sqrt", "root": "sqrt", "sqr": "sqrt", "wurzel": "sqrt",
    "fabs": "abs", "absolute": "abs", "cosine": "cos", "sine": "sin", "tangent": "tan",
    "sen": "sin", "sinus": "sin", "cosinus": "cos", "kosinus": "cos", "tangens": "tan",
    "ArcCosine": "acos", "c": "cos", "s": "sin", "t": "tan", "C": "cos", "S": "sin",
}  # fmt: skip
_OTHERS = {
    *("ln", "log", "log10", "sinh", "cosh", "tanh", "mod", "sign", "floor", "round", "hypot"),
    *("norm", "power", "pow", "diff", "int", "sum", "max", "min", "dot", "cross", "Rational"),
}


@answers("name")
def repair(failure: Failure) -> Repair:
    """Offer 1/cos(x) for sec(x), and the known name for another spelling."""
    if not failure.details["called"]:
        return None
    name = failure.details["run"]
    message = f"The function {quoted(failure.written)} is not known here."
    suggestion = None
    if name in _RECIPROCALS:
        suggestion = _reciprocal(failure, _RECIPROCALS[name])
        message += f" Write 1/{_RECIPROCALS[name]}(x)."
    elif name in _RENAMED:
        suggestion = failure.replaced(_RENAMED[name])
        message += f" Did you mean {_RENAMED[name]}?"
    elif name in _OTHERS:
        message += f" These are: {', '.join(ARITY)}."
    else:
        return None
    return error(failure, "unknown_function", message, suggestion)


def _reciprocal(failure: Failure, name: str) -> str | None:
    """The source with 1/name(...) in brackets, for it may be a factor."""
    start, end = failure.span
    depth = 0
    for at in range(end, len(failure.source)):
        depth += (failure.source[at] == "(") - (failure.source[at] == ")")
        if depth == 0:
            inside = failure.source[end : at + 1]
            return failure.replaced(f"(1/{name}{inside})", (start, at + 1))
    return None
