"""LaTeX commands that are not read, or that lack their argument."""

from service.expressions.characters.latex_commands import known_prefix
from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, quoted


def repair(failure: Failure) -> ExpressionError | None:
    r"""Name the command; offer \cos q for \cosq."""
    if failure.cause == "argument":
        name = failure.details["name"].strip()
        example = r"\frac{a}{b}" if "frac" in name else rf"{name}{{a}}"
        return ExpressionError(
            "missing_operand",
            f"The command {quoted(name)} lacks what it works on; write it as `{example}`.",
            failure.span,
        )
    if failure.cause != "command":
        return None
    name = failure.details["name"]
    prefix = known_prefix(name)
    suggestion = None
    if prefix is not None:
        suggestion = failure.replaced(f"\\{prefix} {name[len(prefix) :]}")
    return ExpressionError(
        "unknown_command",
        f"The command {quoted(failure.written)} is not understood here. "
        "Write the formula with the usual commands, or in plain text: (a)/(b), sqrt(x), cos(q1).",
        failure.span,
        suggestion,
    )
