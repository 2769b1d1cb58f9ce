"""Parts that ask for the same thing twice."""

from collections.abc import Iterator
from itertools import combinations
from typing import Final

import numpy as np

from service.authoring.grading import graded
from service.authoring.remarks import Remark, warning
from service.catalogue import Exercise, PartSpec, PosePartSpec, grid_values
from service.catalogue.variables import TRIALS, trial_values
from service.grading import Verdict
from service.solutions import solve

_SAME: Final = 1e-9


def duplicate_parts(exercise: Exercise) -> Iterator[Remark]:
    """Parts whose right answers are the same for all values of the symbols."""
    candidates = [
        (one, other) for one, other in combinations(exercise.parts, 2) if _task(one) == _task(other)
    ]
    if not candidates:
        return
    answers = solve(exercise).answers
    for one, other in candidates:
        if _equal(one, other, answers, exercise):
            place = exercise.parts.index(other)
            yield warning(
                f"parts[{place}]",
                f"{other.id} has the same answer as {one.id}: whoever has one copies the other; "
                f"ask for something else, or take one of them out",
            )


def _task(part: PartSpec) -> dict[str, object]:
    """The task without its formulas and frames, which are compared by value, and its terms."""
    return part.model_dump(exclude={*PosePartSpec.model_fields, *part.answer_fields})


def _equal(one: PartSpec, other: PartSpec, answers: dict[str, object], exercise: Exercise) -> bool:
    if one.compared_by_formulas:
        return _same_formulas(one.id, other.id, exercise)
    report = graded(exercise, {other.id: answers[one.id]})[other.id]
    return report.verdict is Verdict.CORRECT


def _same_formulas(one: str, other: str, exercise: Exercise) -> bool:
    values = trial_values(exercise.variables)
    first, second = (grid_values(exercise.formulas[part], values, TRIALS) for part in (one, other))
    return first.shape == second.shape and bool(np.abs(first - second).max() < _SAME)
