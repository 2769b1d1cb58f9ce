"""LaTeX commands that are unknown or lack their argument."""

from service.expressions.characters.latex_commands import known_prefix
from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.translations import say


@for_causes("command", "argument")
def repair_unknown_command(failure: Failure) -> Repair:
    r"""Name the command; suggest \cos q for \cosq."""
    name = failure.details["name"]
    if failure.cause == "argument":
        example = r"\frac{a}{b}" if "frac" in name else rf"{name.strip()}{{a}}"
        message = say(
            "The command {command} has no argument. Write it as `{example}`.",
            command=quoted(name.strip()),
            example=example,
        )
        return error(failure, "missing_operand", message)
    prefix = known_prefix(name)
    suggestion = prefix and failure.replaced(f"\\{prefix} {name[len(prefix) :]}")
    message = say(
        "The command {command} is not known. Write it in plain text: (a)/(b), sqrt(x), cos(q1).",
        command=quoted(failure.written),
    )
    return error(failure, "unknown_command", message, suggestion)
