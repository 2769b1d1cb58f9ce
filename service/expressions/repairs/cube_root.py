r"""Roots other than the square root: ∛x, \sqrt[3]{x}."""

from service.expressions.repairs.failure import refusal
from service.translations import say

repair_cube_root = refusal(
    "cube_root",
    "cube_root",
    say("Write this root as a power: (x)^(1/3)."),
)
