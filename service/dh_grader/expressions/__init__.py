"""Parse typed formulas, and convert them to numbers, text, LaTeX or MathML.

This package knows nothing about robots.
"""

from dh_grader.expressions.errors import LIMITS, ExpressionError, Limits, Note
from dh_grader.expressions.lexer import LeftSide, left_side
from dh_grader.expressions.reader import (
    AngleUnit,
    Decimals,
    Expression,
    decimals_of,
    evaluate_all,
    read,
    reading_cost,
    symbols_in,
)
from dh_grader.expressions.vocabulary import Kind, Symbol, Vocabulary, joint_variable

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
