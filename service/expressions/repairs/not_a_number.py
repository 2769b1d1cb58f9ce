"""true or false instead of a number."""

from service.expressions.repairs.failure import refusal
from service.translations import say

repair = refusal("boolean", "not_a_number", say("Write a number or a formula, not true or false."))
