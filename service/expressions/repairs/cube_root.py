r"""∛x and \sqrt[3]{x}: roots other than the square root."""

from service.expressions.repairs.failure import refusal

repair = refusal(
    "cube_root",
    "cube_root",
    "Only square roots have a sign here; write other roots as a power, as in (x)^(1/3).",
)
