"""Parse typed formulas, and convert them to numbers, text, LaTeX or MathML.

This package knows nothing about robots.
"""

from service.expressions.errors import ExpressionError, Note
from service.expressions.evaluation.decimals import Decimals, decimals_of
from service.expressions.limits import LIMITS, Limits
from service.expressions.parsing.equation import LeftSide, left_side
from service.expressions.reader import AngleUnit, Expression, evaluate_all, read
from service.expressions.reading_work import reading_cost, symbols_in
from service.expressions.vocabulary.symbols import Kind, Symbol, Vocabulary, joint_variable

__all__ = [
    "LIMITS",
    "AngleUnit",
    "Decimals",
    "Expression",
    "ExpressionError",
    "Kind",
    "LeftSide",
    "Limits",
    "Note",
    "Symbol",
    "Vocabulary",
    "decimals_of",
    "evaluate_all",
    "joint_variable",
    "left_side",
    "read",
    "reading_cost",
    "symbols_in",
]
