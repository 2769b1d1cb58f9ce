"""NaN, infinity, or a number too large for the machine."""

from service.expressions.repairs.failure import refusal

repair = refusal("not_finite", "not_finite", "This is no finite number. Write a finite one.")
