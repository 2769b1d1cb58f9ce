"""An empty text."""

from service.expressions.repairs.failure import refusal

repair = refusal("empty", "empty", "Nothing is written here. If the value is zero, write 0.")
