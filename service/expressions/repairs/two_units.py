"""A value with two units: 90 deg deg, deg(90°)."""

from service.expressions.repairs.failure import refusal

repair = refusal("two_units", "two_units", "This has two units. Write one.")
