"""true or false instead of a number."""

from service.expressions.repairs.failure import refusal

repair = refusal("boolean", "not_a_number", "Write a number or a formula, not true or false.")
