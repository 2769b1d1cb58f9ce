"""A value with two units: 90 deg deg, deg(90°)."""

from service.expressions.repairs.failure import refusal
from service.translations import say

repair_two_units = refusal("two_units", "two_units", say("This has two units. Write one."))
