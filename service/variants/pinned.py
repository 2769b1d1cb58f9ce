"""Keep the variants of an assignment when an exercise file is corrected.

The table ``[vary]`` of a file says which numbers its variants may have. An assignment stores a copy
of this table and uses it instead of the file's table.
"""

import json
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any, Final

from service.catalogue import Exercise
from service.catalogue.robots.formulas import FieldError
from service.catalogue.varying.vary import Vary

# As many exercises in assignments are used at the same time.
_MOST: Final = 256


def choices_of(exercises: Mapping[str, Exercise]) -> Mapping[str, Any]:
    """Return the table ``[vary]`` of each exercise that has this table."""
    return {name: each.vary.table for name, each in exercises.items() if each.vary is not None}


def pinned(exercise: Exercise, choices: str | None) -> Exercise:
    """Return the exercise with the table ``[vary]`` that an assignment has stored.

    ``choices`` is a JSON object with the stored table of each exercise.
    """
    # The table of the file stays if none is stored, or if the stored table no longer fits the texts
    # of the file.
    if exercise.vary is None or choices is None:
        return exercise
    vary = _pinned(exercise.vary, exercise.plain_id, choices)
    return exercise if vary is exercise.vary else replace(exercise, vary=vary)


@lru_cache(maxsize=_MOST)
def _pinned(vary: Vary, exercise: str, choices: str) -> Vary:
    table = json.loads(choices).get(exercise)
    if table is None or table == vary.table:
        return vary
    try:
        return vary.with_choices(table)
    except FieldError:
        return vary
