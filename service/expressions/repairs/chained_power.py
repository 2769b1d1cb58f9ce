"""A power of a power, such as 2^3^2, which is ambiguous."""

from service.expressions.parsing.lexing.tokens import OPERAND_ENDS
from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.translations import say


@for_causes("grammar")
def repair_chained_power(failure: Failure) -> Repair:
    """Ask the student to add brackets."""
    if failure.terminal() != "POWER" or failure.terminal(1) not in OPERAND_ENDS:
        return None
    message = say("A power of a power has two readings. Add brackets: (a^b)^c or a^(b^c).")
    return error(failure, "chained_power", message)
