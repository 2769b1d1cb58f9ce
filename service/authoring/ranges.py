"""Ranges of symbols at which a wrong answer may look right, or a right one wrong."""

from collections.abc import Iterator
from typing import Final

from service.authoring.remarks import Remark, warning
from service.catalogue import Exercise, Variable

# Small lengths drown beyond this: a slip in one changes the last digits of a pose.
MOST_RATIO: Final = 1000.0
# A constant that is right to a thousandth counts as rounded.
LEAST_WIDTH: Final = 0.01


def badly_scaled(exercise: Exercise) -> Iterator[Remark]:
    """Ranges that hardly vary, lengths that cross 0, and lengths of very different size."""
    for variable in exercise.variables:
        yield from _range(variable)
    sizes = {v.name: max(abs(v.low), abs(v.high)) for v in exercise.variables if v.kind == "length"}
    if not sizes:
        return
    least, most = min(sizes, key=sizes.__getitem__), max(sizes, key=sizes.__getitem__)
    if sizes[most] > MOST_RATIO * sizes[least]:
        yield warning(
            f"symbols.{least}.range",
            f"reaches {sizes[least]:g} where {most} reaches {sizes[most]:g}: beside that a slip in "
            f"{least} is too small to be seen; write lengths of one unit and similar size",
        )


def _range(variable: Variable) -> Iterator[Remark]:
    field = f"symbols.{variable.name}.range"
    size = max(abs(variable.low), abs(variable.high))
    if variable.high - variable.low < LEAST_WIDTH * size:
        yield warning(
            field,
            f"is so narrow that the number {variable.low:g} may pass for {variable.name}; widen "
            f"it, or write the number in the formulas",
        )
    is_constant_length = variable.kind == "length" and variable.joint is None
    if is_constant_length and variable.low <= 0 <= variable.high:
        yield warning(
            field,
            f"holds 0, where axes that are apart come to meet; begin above 0, as in "
            f"[{size / 3:.1g}, {size:.1g}]",
        )
    ends = sorted((abs(variable.low), abs(variable.high)))
    if 0 < ends[0] * MOST_RATIO < ends[1]:
        yield warning(
            field,
            f"goes from {variable.low:g} to {variable.high:g}; narrow it, for a mistake that "
            f"counts at one end is not seen at the other",
        )
