"""Evaluate constants without a closed form, such as cos 0.3, to one number.

The numbers have more digits than are printed, so that terms cancel to exactly 0.
"""

# A robot given in numbers has such a constant in each twist. Products of six of them would fill a
# page.

from decimal import ROUND_HALF_EVEN, Context, Decimal

import sympy

# The number of digits that are printed, and that are computed.
_DIGITS = 15
_WORKING_DIGITS = 40
# Smaller numbers are rounding errors of a difference that is 0.
_NOTHING = sympy.Float("1e-25", _WORKING_DIGITS)
# More decimals are not printed.
DECIMALS = 20
_LAST_DECIMAL = Decimal(1).scaleb(-DECIMALS)
_EXACT = Context(prec=400)
_ROUNDED = Context(prec=_DIGITS, rounding=ROUND_HALF_EVEN)


def folded(expression: sympy.Expr) -> sympy.Expr:
    """Evaluate a constant with a sine or cosine; return any other expression unchanged."""
    has_none = expression.is_number and expression.has(sympy.sin, sympy.cos)
    return expression.evalf(_WORKING_DIGITS) if has_none else expression


def is_unwieldy(expression: sympy.Expr) -> bool:
    """True if a number has no closed form, or more decimals than are printed."""
    return expression.has(sympy.Float) or any(
        number.q > 10**DECIMALS for number in expression.atoms(sympy.Rational)
    )


def rounded(expression: sympy.Expr) -> sympy.Expr:
    """Return the expression with its constants rounded to 15 digits, except in angles."""
    values = _evaluated(expression)
    return values.xreplace({each: _rational(each) for each in values.atoms(sympy.Float)})


def _evaluated(expression: sympy.Expr) -> sympy.Expr:
    if expression.is_number:
        return expression.evalf(_WORKING_DIGITS)
    if isinstance(expression, sympy.Add | sympy.Mul):
        return expression.func(*map(_evaluated, expression.args))
    if isinstance(expression, sympy.Pow):
        return _evaluated(expression.base) ** expression.exp
    return expression


def _rational(number: sympy.Float) -> sympy.Rational:
    if abs(number) < _NOTHING:
        return sympy.S.Zero
    digits = _ROUNDED.create_decimal(str(number))
    return sympy.Rational(str(digits.quantize(_LAST_DECIMAL, context=_EXACT)))
