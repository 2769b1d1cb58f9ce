"""Numbers to draw with, for symbols that have none."""

from collections.abc import Iterable

from service.catalogue import Variable

# Where in its range the displacement of a sliding joint lies: short of the middle, so that there is
# room to slide to either side.
_EXTENDED = 0.4


def drawing_numbers(variables: Iterable[Variable]) -> dict[str, float]:
    """A number for every symbol: the home configuration, with the sliding joints drawn out.

    A link parameter gets the middle of its range, a joint angle 0. A sliding joint is not at 0,
    where nothing would be seen of it.
    """
    return {variable.name: _number(variable) for variable in variables}


def _number(variable: Variable) -> float:
    if variable.joint is not None and variable.kind == "angle":
        return 0.0
    share = 0.5 if variable.joint is None else _EXTENDED
    return float(f"{variable.low + share * (variable.high - variable.low):.3g}")
