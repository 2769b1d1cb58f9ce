"""The numbers that a figure uses for symbols."""

from collections.abc import Iterable

from service.catalogue import Variable

# The displacement of a prismatic joint as a share of its range: less than half, so that there is
# room to slide both ways.
_EXTENDED = 0.4


def drawing_numbers(variables: Iterable[Variable]) -> dict[str, float]:
    """Return a number for every symbol, to draw the robot with extended prismatic joints.

    A link parameter gets the middle of its range, a joint angle 0.
    """
    # A prismatic joint at 0 would be invisible.
    return {variable.name: _number(variable) for variable in variables}


def _number(variable: Variable) -> float:
    if variable.joint is not None and variable.kind == "angle":
        return 0.0
    share = 0.5 if variable.joint is None else _EXTENDED
    return float(f"{variable.low + share * (variable.high - variable.low):.3g}")
