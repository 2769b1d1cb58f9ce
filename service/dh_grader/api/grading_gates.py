"""What an assignment allows a learner: practice, a free hint, a solution, an own variant.

The routes that grade without recording ask here, and know nothing else of courses. Without a
database everything is allowed.
"""

from datetime import UTC, datetime
from http import HTTPStatus
from typing import TYPE_CHECKING, Any, Final

from fastapi import Request
from pydantic import TypeAdapter

from dh_grader.access import Caller
from dh_grader.api.http import (
    Catalogue,
    ProblemError,
    QueryParameter,
    invalid,
    store_down,
    with_parameters,
)
from dh_grader.api.permissions import Access, access_problem
from dh_grader.api.recording import read
from dh_grader.catalogue import Exercise
from dh_grader.contract.courses import CourseName
from dh_grader.store import StoreDownError
from dh_grader.translations import say

if TYPE_CHECKING:
    from dh_grader.store.attempt_store import AttemptStore


# --- Check whether a learner's assignments allow practice


class PracticeGate:
    """Refuses practice, free hints and solutions that an assignment of the learner forbids now."""

    def __init__(self, store: "AttemptStore | None", catalogue: Catalogue) -> None:
        self._store = store
        self._catalogue = catalogue

    async def check(self, caller: Caller, exercise: str) -> None:
        """Raise ProblemError if the caller may not practise the exercise now."""
        refused = await self.refusal(caller, exercise)
        if refused is not None:
            raise refused

    async def check_hints(self, caller: Caller, exercise: Exercise) -> None:
        """Raise ProblemError if the caller may not have free hints for the exercise now."""
        await self.check(caller, exercise.plain_id)
        learner = caller.learner
        if self._store is None or learner is None:
            return
        from dh_grader.courses.gradebook import has_priced_hints

        now, alike = datetime.now(UTC), self._alike(exercise.plain_id)
        priced = await read(
            self._store,
            lambda it: has_priced_hints(it, learner, caller.course, exercise, alike, now),
        )
        if priced or (caller.course is None and exercise.attempts.hint_prices is not None):
            raise ProblemError(
                HTTPStatus.FORBIDDEN,
                say(
                    "Hints have a price at this exercise: hand it in, and take them at its report."
                ),
                "hints-have-a-price",
                say("There are no free hints"),
            )

    async def check_solution(self, caller: Caller, exercise: str) -> None:
        """Raise ProblemError if an assignment of the caller hides the solution now."""
        learner = caller.learner
        if self._store is None or learner is None:
            return
        from dh_grader.courses.gradebook import hides_solution

        now, alike = datetime.now(UTC), self._alike(exercise)
        hidden = await read(
            self._store,
            lambda it: hides_solution(it, learner, caller.course, exercise, alike, now),
        )
        if hidden:
            raise solution_not_shown(say("An assignment does not show you this solution now."))

    async def refusal(self, caller: Caller, exercise: str) -> ProblemError | None:
        """Return the error if the caller may not practise the exercise now, else None."""
        learner = caller.learner
        if self._store is None or learner is None:
            return None
        from dh_grader.courses.gradebook import closed_practice

        now, alike = datetime.now(UTC), self._alike(exercise)
        try:
            closed = await self._store.read(
                lambda it: closed_practice(it, learner, caller.course, exercise, alike, now)
            )
        except StoreDownError:
            if caller.course is None:
                # A learner of no course practises also while the database is down.
                return None
            detail = say("The database does not say whether this exercise may be practised.")
            return store_down(detail)
        if closed is None:
            return None
        terms, counted = closed
        if counted == exercise:
            detail = say(
                "This exercise counts in the assignment {assignment}: hand it in there. Answers "
                "that are not recorded are not graded.",
                assignment=terms.title,
            )
        else:
            detail = say(
                "The exercise {exercise} has the same robot, and counts in the assignment "
                "{assignment}. Answers that are not recorded are not graded.",
                exercise=counted,
                assignment=terms.title,
            )
        title = say("This exercise cannot be practised now")
        return ProblemError(HTTPStatus.FORBIDDEN, detail, "no-practice", title)

    def _alike(self, exercise: str) -> set[str]:
        # Return the ids of all exercises with the same correct table as this exercise.
        reference = getattr(self._catalogue.get(exercise), "reference", None)
        return {
            name
            for name, each in self._catalogue.items()
            if reference is not None and each.reference == reference
        }


def solution_not_shown(detail: str) -> ProblemError:
    """Return the error for a solution that the caller may not see now; ``detail`` says why."""
    return ProblemError(
        HTTPStatus.FORBIDDEN, detail, "solution-not-shown", say("The solution is not shown")
    )


# --- Find a learner's own variant of an exercise, for requests that name an assignment
#
# The query ``?course=…&assignment=…`` names the assignment; the token names the learner. The
# response has the id of the exercise, not of the variant.


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
        from dh_grader.courses.assignments import assigned

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
