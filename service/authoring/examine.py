"""All checks of an exercise for its author."""

from collections.abc import Callable, Iterator

from service.authoring.answers import duplicate_parts, failed_checks, missing_checks, model_answer
from service.authoring.freedom import lost_freedom
from service.authoring.lazy import lazy_answers
from service.authoring.remarks import Level, Remark
from service.authoring.slips import unfit_slips
from service.authoring.symbols import ambiguous_symbols, badly_scaled, bare_degrees, unused_symbols
from service.catalogue import Exercise
from service.translations import joined

EXAMINATIONS: tuple[Callable[[Exercise], Iterator[Remark]], ...] = (
    # First, because it is the cause of what the other checks find.
    bare_degrees,
    model_answer,
    unfit_slips,
    failed_checks,
    missing_checks,
    ambiguous_symbols,
    unused_symbols,
    badly_scaled,
    duplicate_parts,
    lost_freedom,
    lazy_answers,
)


def examine(exercise: Exercise) -> list[Remark]:
    """Return all remarks on an exercise: failures and warnings."""
    return [remark for examination in EXAMINATIONS for remark in examination(exercise)]


def failures(exercise: Exercise) -> list[str]:
    """Return the failures of an exercise, without warnings, as sentences."""
    return [
        joined(": ", [remark.field, remark.text]) if remark.field else remark.text
        for remark in examine(exercise)
        if remark.level is Level.FAILED
    ]
