"""Build an exercise, or one of its variants, from the content of its file."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from service.catalogue.compile import compile_exercise
from service.catalogue.exercise import Exercise
from service.catalogue.files.schema import ExerciseSpec
from service.catalogue.varying.vary import Vary


def exercise_of(exercise_id: str, content: Mapping[str, Any]) -> Exercise:
    """Build an exercise from the content of its file, without choosing a variant.

    Raises ValidationError or FieldError.
    """
    if "vary" not in content:
        return compile_exercise(exercise_id, ExerciseSpec.model_validate(content))
    return _filled(exercise_id, Vary(exercise_id, content), "")


def exercise_of_seed(exercise: Exercise, seed: str) -> Exercise:
    """Build the variant of an exercise for a seed. Raises ValidationError or FieldError."""
    assert exercise.vary is not None, f"{exercise.id} has no variants"
    return _filled(exercise.id, exercise.vary, seed)


def _filled(exercise_id: str, vary: Vary, seed: str) -> Exercise:
    values = vary.values(seed)
    spec = ExerciseSpec.model_validate(vary.content(values))
    built = compile_exercise(exercise_id, spec)
    variant = f"{exercise_id}~{seed}" if seed else exercise_id
    return replace(built, id=variant, version=vary.version(values), vary=vary, seed=seed)
