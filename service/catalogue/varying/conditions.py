"""The conditions in ``[vary]``: comparisons of formulas with the varied numbers."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from service.catalogue.robots.formulas import FieldError
from service.catalogue.varying.choices import VaryValue
from service.expressions import Expression, ExpressionError, Symbol, Vocabulary, read
from service.regex import regex
from service.translations import say

# Signs of two characters come first.
_SIGN: Final = regex("<=|>=|!=|==|[<>=≤≥≠]")
# Numbers in a file have a few decimals: a difference below this is rounding.
_EQUAL: Final = 1e-9


def numeric_values(values: Sequence[VaryValue]) -> Sequence[float] | None:
    """Return the choices as numbers, or None if one of them is not a number."""
    found = []
    for each in values:
        if isinstance(each, Mapping):
            return None
        if isinstance(each, Decimal):
            found.append(float(each))
            continue
        try:
            found.append(float(read(each, Vocabulary([])).evaluate({})))
        except ExpressionError:
            return None
    return found


def vocabulary_of(names: Sequence[str]) -> Vocabulary:
    """Return the symbols for formulas: the names whose choices are numbers. Raises FieldError."""
    for name in names:
        try:
            Vocabulary([Symbol(name, "number")])
        except ValueError as error:
            raise FieldError(f"vary.{name}", error.args[0]) from error
    try:
        return Vocabulary([Symbol(name, "number") for name in names])
    except ValueError as error:
        raise FieldError("vary", error.args[0]) from error


def read_formula(field: str, text: str, vocabulary: Vocabulary) -> Expression:
    """Read a formula in which every symbol is the name of a varied number. Raises FieldError."""
    try:
        return read(text, vocabulary)
    except ExpressionError as error:
        raise FieldError(field, error.message) from error


_Comparison: TypeAlias = Callable[[NDArray[np.float64]], NDArray[np.bool_]]
# Whether a difference of two sides fits a sign.
_COMPARED: Final[Mapping[str, _Comparison]] = {
    "<": lambda difference: difference < -_EQUAL,
    ">": lambda difference: difference > _EQUAL,
    **dict.fromkeys(("<=", "≤"), lambda difference: difference <= _EQUAL),
    **dict.fromkeys((">=", "≥"), lambda difference: difference >= -_EQUAL),
    **dict.fromkeys(("=", "=="), lambda difference: np.abs(difference) <= _EQUAL),
    **dict.fromkeys(("!=", "≠"), lambda difference: np.abs(difference) > _EQUAL),
}


@dataclass(frozen=True, slots=True)
class Condition:
    """A comparison of two formulas."""

    left: Expression
    sign: str
    right: Expression

    def holds(self, values: Mapping[str, NDArray[np.float64]], count: int) -> NDArray[np.bool_]:
        """Return a mask that is True where the values meet the condition."""
        difference = np.broadcast_to(
            np.asarray(self.left.evaluate(values)) - np.asarray(self.right.evaluate(values)), count
        )
        met: NDArray[np.bool_] = np.isfinite(difference) & _COMPARED[self.sign](difference)
        return met


def read_condition(field: str, text: str, vocabulary: Vocabulary) -> Condition:
    """Return the condition in ``text``. Raises FieldError."""
    signs = _SIGN.findall(text)
    if len(signs) != 1:
        reason = say(
            'must compare two formulas by <, >, <=, >=, = or !=; write, for example, "a1 > a2"'
        )
        raise FieldError(field, reason)
    left, right = (read_formula(field, side, vocabulary) for side in text.split(signs[0]))
    return Condition(left, signs[0], right)
