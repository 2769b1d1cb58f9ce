"""Find the exercises and the parts of exercises that a request names."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from http import HTTPStatus
from itertools import islice
from typing import Annotated

from fastapi import Path

from service.access.caller import Caller
from service.api.http.problems import MAX_ERRORS, ProblemError, invalid, message_of
from service.catalogue import Exercise
from service.submissions.lookup import UnknownExerciseError, find_exercise, nearest
from service.translations import paragraph, say

Catalogue = Mapping[str, Exercise]
ExerciseId = Annotated[
    str, Path(max_length=200, description="The id of an exercise.", examples=["stanford-arm"])
]
AttemptId = Annotated[str, Path(max_length=100, description="The id of an attempt.")]
# A place in a body: the keys and indices that lead to it.
Location = tuple[str | int, ...]


def reachable_exercises(catalogue: Catalogue, caller: Caller) -> Catalogue:
    """Return the exercises that the caller may use."""
    return {name: each for name, each in catalogue.items() if caller.reaches(name)}


def exercise_or_404(catalogue: Catalogue, exercise_id: str) -> Exercise:
    """Return the exercise with an id from the URL. Raises ProblemError."""
    try:
        return find_exercise(catalogue, exercise_id)
    except UnknownExerciseError as error:
        raise ProblemError(
            HTTPStatus.NOT_FOUND,
            message_of(error),
            "unknown-exercise",
            say("There is no such exercise"),
        ) from error


def require_exercise(catalogue: Catalogue, exercise_id: str) -> Exercise:
    """Return the exercise with an id from the request body. Raises ProblemError."""
    try:
        return find_exercise(catalogue, exercise_id)
    except UnknownExerciseError as error:
        detail = {"type": "unknown", "loc": ("exercise",), "msg": message_of(error)}
        raise invalid([detail]) from error


def require_exercises(catalogue: Catalogue, exercise_ids: Iterable[str], field: str) -> None:
    """Check that all exercises listed in a request body exist. Raises ProblemError."""
    details = []
    for i, exercise_id in enumerate(exercise_ids):
        try:
            find_exercise(catalogue, exercise_id)
        except UnknownExerciseError as error:
            details.append({"type": "unknown", "loc": (field, i), "msg": message_of(error)})
    if details:
        raise invalid(details)


def require_parts(exercise: Exercise, located: Iterable[tuple[str, Location]]) -> None:
    """Check that the exercise has the parts that a request names. Raises ProblemError.

    ``located`` has pairs: the id of a part, and the path of the id in the request body.
    """
    absent = (each for each in located if exercise.part(each[0]) is None)
    known = [part.id for part in exercise.parts]
    details = []
    for part, place in islice(absent, MAX_ERRORS):
        meant = nearest(part, known)
        message = paragraph(
            say("{exercise} has no such part.", exercise=exercise.id),
            say("Did you mean {suggestion!r}?", suggestion=meant) if meant else "",
            say("Its parts are: {parts}.", parts=", ".join(known)),
        )
        details.append({"type": "unknown", "loc": place, "msg": message})
    if details:
        problem = invalid(details)
        raise replace(problem, name="unknown-part", title=say("The exercise has no such part"))
