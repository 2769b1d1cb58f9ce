"""LaTeX commands that are not read, or that lack what they work on."""

from service.expressions.characters.latex_commands import known_prefix
from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, shown


def repair(failure: Failure) -> ExpressionError | None:
    r"""Name the command; offer \cos q for \cosq."""
    if failure.stop.cause == "argument":
        name = failure.details["name"].strip()
        example = r"\frac{a}{b}" if "frac" in name else rf"{name}{{a}}"
        return ExpressionError(
            "missing_operand",
            f"The command {shown(name)} lacks what it works on; write it as `{example}`.",
            failure.span,
        )
    if failure.stop.cause != "command":
        return None
    name = failure.details["name"]
    prefix = known_prefix(name)
    suggestion = None
    if prefix is not None:
        suggestion = failure.replaced(f"\\{prefix} {name[len(prefix) :]}")
    return ExpressionError(
        "unknown_command",
        f"The command {shown(failure.written)} is not understood here. "
        "Write the formula with the usual commands, or in plain text: (a)/(b), sqrt(x), cos(q1).",
        failure.span,
        suggestion,
    )
