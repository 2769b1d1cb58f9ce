r"""Roots other than the square root: ∛x, \sqrt[3]{x}."""

from service.expressions.repairs.failure import refusal

repair = refusal(
    "cube_root",
    "cube_root",
    "Write this root as a power: (x)^(1/3).",
)
