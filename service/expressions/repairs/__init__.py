"""Repair rules: why a text cannot be read, and how to repair it.

The rules are tried in order, until one of them recognizes the typing mistake and returns an error
with a suggestion.
"""

from typing import Final

from service.expressions.errors import ExpressionError
from service.expressions.limits import LIMITS
from service.expressions.repairs.ambiguous_number import repair_ambiguous_number
from service.expressions.repairs.ambiguous_shorthand import repair_ambiguous_shorthand
from service.expressions.repairs.ambiguous_star import repair_ambiguous_star
from service.expressions.repairs.ambiguous_unit import repair_ambiguous_unit
from service.expressions.repairs.beyond_limits import repair_beyond_limits
from service.expressions.repairs.braced_stem import repair_braced_stem
from service.expressions.repairs.bracketed_unit import repair_bracketed_unit
from service.expressions.repairs.chained_power import repair_chained_power
from service.expressions.repairs.comment import repair_comment
from service.expressions.repairs.cube_root import repair_cube_root
from service.expressions.repairs.dash import repair_dash
from service.expressions.repairs.decimal_comma import repair_decimal_comma
from service.expressions.repairs.degrees_function import repair_degrees_function
from service.expressions.repairs.detached_index import repair_detached_index
from service.expressions.repairs.empty import repair_empty
from service.expressions.repairs.equation import repair_equation
from service.expressions.repairs.euler_and_imaginary import repair_euler_and_imaginary
from service.expressions.repairs.failure import Failure, RepairRule
from service.expressions.repairs.function_of_time import repair_function_of_time
from service.expressions.repairs.function_power import repair_function_power
from service.expressions.repairs.function_without_argument import repair_function_without_argument
from service.expressions.repairs.index import repair_index
from service.expressions.repairs.interval import repair_interval
from service.expressions.repairs.invisible_character import repair_invisible_character
from service.expressions.repairs.length_unit import repair_length_unit
from service.expressions.repairs.letter_x import repair_letter_x
from service.expressions.repairs.look_alike_character import repair_look_alike_character
from service.expressions.repairs.malformed_number import repair_malformed_number
from service.expressions.repairs.mismatched_bracket import repair_mismatched_bracket
from service.expressions.repairs.missing_operand import repair_missing_operand
from service.expressions.repairs.mixed_number import repair_mixed_number
from service.expressions.repairs.not_a_number import repair_not_a_number
from service.expressions.repairs.not_finite import repair_not_finite
from service.expressions.repairs.not_revolute import repair_not_revolute
from service.expressions.repairs.plus_minus import repair_plus_minus
from service.expressions.repairs.prose import repair_prose
from service.expressions.repairs.quotes import repair_quotes
from service.expressions.repairs.raised_zero import repair_raised_zero
from service.expressions.repairs.repeated_joint import repair_repeated_joint
from service.expressions.repairs.subscript import repair_subscript
from service.expressions.repairs.tan_of_two import repair_tan_of_two
from service.expressions.repairs.trailing_operator import repair_trailing_operator
from service.expressions.repairs.trailing_punctuation import repair_trailing_punctuation
from service.expressions.repairs.transpose import repair_transpose
from service.expressions.repairs.two_units import repair_two_units
from service.expressions.repairs.two_values import repair_two_values
from service.expressions.repairs.unbalanced_bracket import repair_unbalanced_bracket
from service.expressions.repairs.unexpected_character import repair_unexpected_character
from service.expressions.repairs.unit_on_variable import repair_unit_on_variable
from service.expressions.repairs.unknown_command import repair_unknown_command
from service.expressions.repairs.unknown_function import repair_unknown_function
from service.expressions.repairs.unknown_joint import repair_unknown_joint
from service.expressions.repairs.unknown_symbol import repair_unknown_symbol
from service.expressions.repairs.wrong_case import repair_wrong_case
from service.expressions.repairs.wrong_number_of_arguments import repair_wrong_number_of_arguments

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
