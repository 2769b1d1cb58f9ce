"""true and false in place of a number."""

from service.expressions.repairs.failure import refusal

repair = refusal(
    "boolean", "not_a_number", "true and false are no numbers. For a number, write 1 or 0."
)
