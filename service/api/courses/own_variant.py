"""Find a learner's own variant of an exercise, for requests that name an assignment.

The query ``?course=…&assignment=…`` names the assignment; the token names the learner.
"""

# The response has the id of the exercise, not of the variant.

from typing import TYPE_CHECKING, Any, Final

from fastapi import Request
from pydantic import TypeAdapter

from service.api.courses.asking import read
from service.api.http.parameters import QueryParameter, with_parameters
from service.api.http.problems import invalid
from service.api.permissions.access import Access
from service.api.permissions.access_problems import access_problem
from service.catalogue import Exercise
from service.contract.courses import CourseName
from service.translations import say

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore

_NAME: Final = TypeAdapter(CourseName)
_PARAMETERS: Final = (
    QueryParameter("course", "The id of a course of the learner with this token.", _NAME),
    QueryParameter(
        "assignment",
        "The id of an assignment: the exercise is the learner's own variant in it.",
        _NAME,
    ),
)


def of_assignment(options: dict[str, Any]) -> dict[str, Any]:
    """Return FastAPI's arguments for a route with the parameters ``course`` and ``assignment``."""
    return with_parameters(options, *_PARAMETERS)


class OwnVariants:
    """Finds a learner's own variant of an exercise."""

    def __init__(self, store: "AttemptStore | None", access: Access) -> None:
        self._store = store
        self._access = access

    async def of(self, request: Request, exercise: Exercise) -> Exercise:
        """Return the learner's variant if the request names an assignment, else the exercise.

        Raises ProblemError.
        """
        if exercise.vary is None or b"assignment=" not in request.scope["query_string"]:
            return exercise
        from service.courses.dealing import assigned

        course, assignment = (_named(request, each.name) for each in _PARAMETERS)
        caller = self._access.caller(request)
        learner = caller.learner
        if learner is None:
            raise access_problem("learner-needed")
        if caller.course not in (None, course):
            raise access_problem("other-course")
        _, own = await read(
            self._store, lambda it: assigned(it, course, assignment, learner, exercise)
        )
        return own


def _named(request: Request, name: str) -> str:
    # The route has checked the values that are there.
    value = request.query_params.get(name)
    if value is None:
        message = say("Name a course and an assignment.")
        raise invalid([{"type": "value", "loc": (name,), "msg": message}])
    return value
