"""Reading single values of an exercise file, and saying what is wrong with one."""

from dataclasses import dataclass

import numpy as np

from service.catalogue.exercise import Variable
from service.catalogue.robot import Values
from service.catalogue.schema import Formula
from service.expressions import Expression, ExpressionError, Kind, Vocabulary, read

# How many values of its symbols an author's formula is tried at.
TRIALS = 16


@dataclass
class FieldError(Exception):
    """A value of an exercise file that cannot stand; ``field`` is its path in the file."""

    field: str
    reason: str

    def __str__(self) -> str:
        """Field and reason on one line."""
        return f"{self.field}: {self.reason}"


def read_formula(field: str, source: Formula, vocabulary: Vocabulary, quantity: Kind) -> Expression:
    """The formula at ``field``. Raises FieldError where it cannot be read."""
    try:
        return read(source, vocabulary, quantity=quantity)
    except ExpressionError as error:
        hint = f"; did you mean {error.suggestion!r}?" if error.suggestion else ""
        raise FieldError(field, f"{error.message}{hint}") from error


def no_value(expression: Expression) -> str:
    """Why a formula cannot stand that is undefined somewhere in its symbols' ranges."""
    return (
        f"{expression.text()} has no value for some values of its symbols; mend it, or narrow "
        f"their ranges"
    )


def trial_values(variables: tuple[Variable, ...]) -> Values:
    """Values of every symbol, the same each time, to try an author's formulas at."""
    rng = np.random.default_rng(0)
    return {v.name: rng.uniform(v.low, v.high, TRIALS) for v in variables}
