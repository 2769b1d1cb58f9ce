"""Repair rules, one file each: why a text cannot be read, and how to repair it.

They are tried in order, and the first that knows the slip answers: it names the slip, its place
and what would be right, and offers the repaired text where one is near.
"""

from typing import Final

from service.expressions.errors import ExpressionError
from service.expressions.repairs import (
    ambiguous_number,
    ambiguous_shorthand,
    ambiguous_unit,
    beyond_limits,
    braced_stem,
    chained_power,
    comment,
    cube_root,
    dash,
    decimal_comma,
    degrees_function,
    detached_index,
    empty,
    equation,
    euler_and_imaginary,
    function_of_time,
    function_power,
    function_without_argument,
    index,
    interval,
    invisible_character,
    length_unit,
    letter_x,
    look_alike_character,
    malformed_number,
    mismatched_bracket,
    missing_operand,
    mixed_number,
    not_a_number,
    not_finite,
    not_revolute,
    plus_minus,
    prose,
    quotes,
    raised_zero,
    repeated_joint,
    subscript,
    tan_of_two,
    trailing_operator,
    trailing_punctuation,
    transpose,
    two_units,
    two_values,
    unbalanced_bracket,
    unexpected_character,
    unit_on_variable,
    unknown_command,
    unknown_function,
    unknown_joint,
    unknown_symbol,
    wrong_case,
    wrong_number_of_arguments,
)
from service.expressions.repairs.failure import Failure, RepairRule

# First the rules for the whole text, then those for characters and words, then for the grammar.
# The last rule answers everything.
RULES: Final[tuple[RepairRule, ...]] = (
    beyond_limits.repair,
    not_a_number.repair,
    dash.repair,
    empty.repair,
    comment.repair,
    quotes.repair,
    equation.repair,
    plus_minus.repair,
    prose.repair,
    interval.repair,
    not_finite.repair,
    invisible_character.repair,
    look_alike_character.repair,
    mixed_number.repair,
    transpose.repair,
    cube_root.repair,
    unknown_command.repair,
    subscript.repair,
    braced_stem.repair,
    raised_zero.repair,
    function_of_time.repair,
    length_unit.repair,
    letter_x.repair,
    detached_index.repair,
    unknown_joint.repair,
    index.repair,
    wrong_case.repair,
    euler_and_imaginary.repair,
    tan_of_two.repair,
    unknown_function.repair,
    unknown_symbol.repair,
    not_revolute.repair,
    repeated_joint.repair,
    ambiguous_shorthand.repair,
    ambiguous_number.repair,
    ambiguous_unit.repair,
    degrees_function.repair,
    unit_on_variable.repair,
    two_units.repair,
    function_power.repair,
    wrong_number_of_arguments.repair,
    mismatched_bracket.repair,
    function_without_argument.repair,
    decimal_comma.repair,
    trailing_punctuation.repair,
    trailing_operator.repair,
    unbalanced_bracket.repair,
    chained_power.repair,
    missing_operand.repair,
    malformed_number.repair,
    two_values.repair,
    unexpected_character.repair,
)


def explain(failure: Failure) -> ExpressionError:
    """The error for ``failure``; its suggestion is None or can be read."""
    error = next(found for rule in RULES if (found := rule(failure)) is not None)
    if error.suggestion is not None:
        same = error.suggestion.strip() == failure.source.strip()
        error.suggestion = None if same else failure.repaired(error.suggestion)
    return error


__all__ = ["RULES", "Failure", "RepairRule", "explain"]
