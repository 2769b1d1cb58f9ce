"""NaN, infinity, or a number too large for a float."""

from service.expressions.repairs.failure import refusal
from service.translations import say

repair_not_finite = refusal(
    "not_finite",
    "not_finite",
    say("This number is infinite, undefined or too large. Write a finite number."),
)
