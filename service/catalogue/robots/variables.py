"""The letters of an exercise, and values to try an author's formulas at."""

from dataclasses import dataclass

import numpy as np

from service.expressions import Kind
from service.expressions.evaluation.samples import SymbolValues

# The number of values of its symbols that an author's formula is tried at.
TRIALS = 16


@dataclass(frozen=True, slots=True)
class Variable:
    """A letter that may stand in an answer, with the range that its test values are drawn from.

    Angles are in radians, lengths in ``unit``. ``joint`` is the joint's number where the letter is
    a joint variable.
    """

    name: str
    kind: Kind
    unit: str
    description: str
    low: float
    high: float
    joint: int | None = None


def trial_values(variables: tuple[Variable, ...]) -> SymbolValues:
    """Values of every symbol, the same each time, ``(TRIALS,)`` each."""
    rng = np.random.default_rng(0)
    return {v.name: rng.uniform(v.low, v.high, TRIALS) for v in variables}
