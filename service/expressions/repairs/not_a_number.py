"""true or false instead of a number."""

from service.expressions.repairs.failure import refusal
from service.translations import say

repair_not_a_number = refusal(
    "boolean", "not_a_number", say("Write a number or a formula, not true or false.")
)
