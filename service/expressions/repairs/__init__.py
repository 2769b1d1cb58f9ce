"""Repair rules, one file each: why a text cannot be read, and how to repair it.

The rules are tried in order, until one of them recognizes the typing mistake and returns an error
with a suggestion.
"""

from typing import Final

from service.expressions.errors import ExpressionError
from service.expressions.limits import LIMITS

from service.expressions.repairs import (  # isort: skip
    ambiguous_number, ambiguous_shorthand, ambiguous_star, ambiguous_unit, beyond_limits,
    braced_stem, bracketed_unit, chained_power, comment, cube_root, dash, decimal_comma,
    degrees_function, detached_index, empty, equation, euler_and_imaginary, function_of_time,
    function_power,
    function_without_argument, index, interval, invisible_character, length_unit, letter_x,
    look_alike_character, malformed_number, mismatched_bracket, missing_operand, mixed_number,
    not_a_number, not_finite, not_revolute, plus_minus, prose, quotes, raised_zero, repeated_joint,
    subscript, tan_of_two, trailing_operator, trailing_punctuation, transpose, two_units,
    two_values, unbalanced_bracket, unexpected_character, unit_on_variable, unknown_command,
    unknown_function, unknown_joint, unknown_symbol, wrong_case, wrong_number_of_arguments,
)  # fmt: skip
from service.expressions.repairs.failure import Failure, RepairRule

# The first rule refuses texts beyond the limits, so that no other rule meets them. Then come rules
# for whole texts, for characters and words, and for the grammar. The last rule always applies.
RULES: Final[tuple[RepairRule, ...]] = (
    beyond_limits, not_a_number, dash, empty, comment, quotes, equation, plus_minus, prose,
    interval, not_finite, invisible_character, look_alike_character, mixed_number, decimal_comma,
    transpose, cube_root, unknown_command, subscript, braced_stem, raised_zero, function_of_time,
    length_unit, letter_x, detached_index, unknown_joint, index, wrong_case, euler_and_imaginary,
    tan_of_two, unknown_function, unknown_symbol, not_revolute, repeated_joint, ambiguous_shorthand,
    ambiguous_number, ambiguous_star, bracketed_unit, ambiguous_unit, degrees_function,
    unit_on_variable, two_units, function_power, wrong_number_of_arguments, mismatched_bracket,
    function_without_argument,
    trailing_punctuation, trailing_operator, unbalanced_bracket, chained_power, missing_operand,
    malformed_number, two_values, unexpected_character,
)  # fmt: skip


# Rules that search the whole text for slips of short texts.
_SHORT_TEXT_RULES: Final = frozenset({
    dash, comment, quotes, equation, plus_minus, prose, interval, transpose, braced_stem,
    bracketed_unit, function_of_time, raised_zero, letter_x, tan_of_two, decimal_comma,
    trailing_punctuation,
})  # fmt: skip
_LONG_TEXT_RULES: Final = tuple(rule for rule in RULES if rule not in _SHORT_TEXT_RULES)


def explain(failure: Failure) -> ExpressionError:
    """Return the error for ``failure``. Any suggestion in the error is readable."""
    is_long = len(failure.source) > LIMITS.repaired
    rules = _LONG_TEXT_RULES if is_long else RULES
    error = next(found for rule in rules if (found := rule.repair(failure)) is not None)
    if is_long:
        error.suggestion = None
    if error.suggestion is not None:
        same = error.suggestion.strip() == failure.source.strip()
        error.suggestion = None if same else failure.repaired(error.suggestion)
    return error


__all__ = ["RULES", "Failure", "RepairRule", "explain"]
