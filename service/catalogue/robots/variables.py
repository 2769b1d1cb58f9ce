"""The variables of an exercise, and trial values to check an author's formulas."""

from dataclasses import dataclass

import numpy as np

from service.expressions import Kind
from service.expressions.evaluation.samples import SymbolValues

# The number of trial values at which an author's formula is evaluated.
TRIALS = 16


@dataclass(frozen=True, slots=True)
class Variable:
    """A symbol that answers may contain, with the range of its test values.

    Angles are in radians, lengths in ``unit``. ``joint`` is set for a joint variable.
    """

    name: str
    kind: Kind
    unit: str
    description: str
    low: float
    high: float
    joint: int | None = None


def trial_values(variables: tuple[Variable, ...]) -> SymbolValues:
    """Return ``TRIALS`` values of each variable; every call returns the same values."""
    rng = np.random.default_rng(0)
    return {v.name: rng.uniform(v.low, v.high, TRIALS) for v in variables}
