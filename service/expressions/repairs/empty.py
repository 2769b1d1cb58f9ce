"""An empty text."""

from service.expressions.repairs.failure import refusal
from service.translations import say

repair_empty = refusal(
    "empty", "empty", say("Nothing is written here. If the value is zero, write 0.")
)
