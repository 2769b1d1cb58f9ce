"""Repair rules: why a text cannot be read, and how to repair it.

The rules are tried in order, until one of them recognizes the typing mistake and returns an error
with a suggestion.
"""

from typing import Final

from dh_grader.expressions.errors import LIMITS, ExpressionError
from dh_grader.expressions.repairs.failure import Failure, RepairRule
from dh_grader.expressions.repairs.names import (
    repair_ambiguous_shorthand,
    repair_braced_stem,
    repair_detached_index,
    repair_euler_and_imaginary,
    repair_function_of_time,
    repair_index,
    repair_letter_x,
    repair_not_revolute,
    repair_raised_zero,
    repair_repeated_joint,
    repair_subscript,
    repair_unknown_command,
    repair_unknown_function,
    repair_unknown_joint,
    repair_unknown_symbol,
    repair_wrong_case,
)
from dh_grader.expressions.repairs.numbers import (
    repair_ambiguous_number,
    repair_ambiguous_star,
    repair_ambiguous_unit,
    repair_bracketed_unit,
    repair_chained_power,
    repair_cube_root,
    repair_decimal_comma,
    repair_degrees_function,
    repair_function_power,
    repair_interval,
    repair_length_unit,
    repair_malformed_number,
    repair_mixed_number,
    repair_not_a_number,
    repair_not_finite,
    repair_plus_minus,
    repair_tan_of_two,
    repair_two_units,
    repair_two_values,
    repair_unit_on_variable,
)
from dh_grader.expressions.repairs.texts import (
    repair_beyond_limits,
    repair_comment,
    repair_dash,
    repair_empty,
    repair_equation,
    repair_function_without_argument,
    repair_invisible_character,
    repair_look_alike_character,
    repair_mismatched_bracket,
    repair_missing_operand,
    repair_prose,
    repair_quotes,
    repair_trailing_operator,
    repair_trailing_punctuation,
    repair_transpose,
    repair_unbalanced_bracket,
    repair_unexpected_character,
    repair_wrong_number_of_arguments,
)

# The first rule refuses texts beyond the limits, so that no other rule meets them. Then come rules
# for whole texts, for characters and words, and for the grammar. The last rule always applies.
RULES: Final[tuple[RepairRule, ...]] = (
    repair_beyond_limits,
    repair_not_a_number,
    repair_dash,
    repair_empty,
    repair_comment,
    repair_quotes,
    repair_equation,
    repair_plus_minus,
    repair_prose,
    repair_interval,
    repair_not_finite,
    repair_invisible_character,
    repair_look_alike_character,
    repair_mixed_number,
    repair_decimal_comma,
    repair_transpose,
    repair_cube_root,
    repair_unknown_command,
    repair_subscript,
    repair_braced_stem,
    repair_raised_zero,
    repair_function_of_time,
    repair_length_unit,
    repair_letter_x,
    repair_detached_index,
    repair_unknown_joint,
    repair_index,
    repair_wrong_case,
    repair_euler_and_imaginary,
    repair_tan_of_two,
    repair_unknown_function,
    repair_unknown_symbol,
    repair_not_revolute,
    repair_repeated_joint,
    repair_ambiguous_shorthand,
    repair_ambiguous_number,
    repair_ambiguous_star,
    repair_bracketed_unit,
    repair_ambiguous_unit,
    repair_degrees_function,
    repair_unit_on_variable,
    repair_two_units,
    repair_function_power,
    repair_wrong_number_of_arguments,
    repair_mismatched_bracket,
    repair_function_without_argument,
    repair_trailing_punctuation,
    repair_trailing_operator,
    repair_unbalanced_bracket,
    repair_chained_power,
    repair_missing_operand,
    repair_malformed_number,
    repair_two_values,
    repair_unexpected_character,
)


# Rules that search the whole text for slips of short texts.
_SHORT_TEXT_RULES: Final = frozenset(
    {
        repair_dash,
        repair_comment,
        repair_quotes,
        repair_equation,
        repair_plus_minus,
        repair_prose,
        repair_interval,
        repair_transpose,
        repair_braced_stem,
        repair_bracketed_unit,
        repair_function_of_time,
        repair_raised_zero,
        repair_letter_x,
        repair_tan_of_two,
        repair_decimal_comma,
        repair_trailing_punctuation,
    }
)
_LONG_TEXT_RULES: Final = tuple(rule for rule in RULES if rule not in _SHORT_TEXT_RULES)


def explain(failure: Failure) -> ExpressionError:
    """Return the error for ``failure``. Any suggestion in the error is readable."""
    is_long = len(failure.source) > LIMITS.repaired
    rules = _LONG_TEXT_RULES if is_long else RULES
    error = next(found for rule in rules if (found := rule(failure)) is not None)
    if is_long:
        error.suggestion = None
    if error.suggestion is not None:
        same = error.suggestion.strip() == failure.source.strip()
        error.suggestion = None if same else failure.repaired(error.suggestion)
    return error


__all__ = ["RULES", "Failure", "RepairRule", "explain"]
