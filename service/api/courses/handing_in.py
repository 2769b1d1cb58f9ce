"""The routes for learners: show assignments, hand in answers, and show solutions."""

from collections.abc import Collection
from datetime import UTC, datetime
from functools import partial
from http import HTTPStatus
from typing import TYPE_CHECKING, Annotated

from fastapi import APIRouter, Request, Response

from service.access.caller import Caller
from service.api.courses.asking import (
    AssignmentId,
    CourseId,
    changing,
    course_problem,
    read,
    reading,
    write,
)
from service.api.http.bodies import read_body
from service.api.http.language import language_of
from service.api.http.lookup import Catalogue, ExerciseId, exercise_or_404, require_parts
from service.api.http.problems import ProblemError
from service.api.http.told_answer import in_languages, told_json
from service.api.monitor import Monitor
from service.api.permissions.access import Access
from service.api.permissions.access_problems import access_problem
from service.api.recording.attempting import AttemptTerms, Recorder
from service.api.recording.new_attempts import IDEMPOTENCY_KEY, not_recorded
from service.api.recording.store import NO_STORE
from service.api.routes.solutions import SolvedExercises
from service.api.turns import arrived_at
from service.catalogue import Exercise, FeedbackLevel
from service.contract.attempts import AttemptRequest, AttemptResponse
from service.contract.own_courses import HandInRequest, OwnCourses
from service.courses.errors import CourseError
from service.solutions import ModelSolution
from service.submissions.body import GradeRequest
from service.translations import say

if TYPE_CHECKING:  # they load the drivers of databases
    from sqlalchemy import Connection

    from service.attempts.attempt import Standing
    from service.attempts.store import AttemptStore
    from service.courses.terms import LearnerTerms


def routes(
    catalogue: Catalogue,
    feedback: FeedbackLevel,
    store: "AttemptStore | None",
    access: Access,
    monitor: Monitor | None = None,
    origins: Collection[str] = (),
) -> APIRouter:
    """Return the routes for learners; ``feedback`` is the highest feedback level of reports."""
    router = APIRouter(prefix="/v1", tags=["courses"])
    solutions = SolvedExercises()

    @router.get(
        "/me",
        operation_id="getOwnView",
        summary="Show a learner's own courses",
        response_description="The assignments, the attempts that are left, and the points.",
        **in_languages(reading(OwnCourses)),
    )
    async def show_own_view(request: Request) -> Response:
        """Show the assignments and attempts of the learner with this link or token.

        The titles of exercises are in the reader's language.
        """
        from service.courses.learner_view import own_view

        caller = access.caller(request)
        learner, now = _learner(caller, None), datetime.now(UTC)
        language = language_of(request)
        view = await read(
            store, lambda it: own_view(it, learner, caller.course, catalogue, now, language)
        )
        content = view.model_dump_json(exclude_none=True)
        return told_json(content, language, headers=NO_STORE)

    @router.post(
        "/courses/{course_id}/assignments/{assignment_id}/attempts",
        operation_id="handIn",
        summary="Hand in an exercise of an assignment",
        response_description="The recorded attempt and its report.",
        **in_languages(changing(HandInRequest, AttemptResponse, success=HTTPStatus.CREATED)),
    )
    async def hand_in(
        request: Request,
        course_id: CourseId,
        assignment_id: AssignmentId,
        idempotency_key: Annotated[str, IDEMPOTENCY_KEY],
    ) -> Response:
        """Grade answers and record them in an assignment, once for each idempotency key.

        The assignment says how attempts are limited and how much their reports say. An attempt
        that is answered with 201 is not lost, whatever happens to the service.
        """
        access.require_allowed_origin(request, origins)
        if store is None:
            raise not_recorded()
        body = await read_body(HandInRequest, request)
        caller = access.caller(request)
        learner = _learner(caller, body.learner)
        named = exercise_or_404(catalogue, body.exercise)
        require_parts(named, ((part, ("answers", part)) for part in body.answers))
        now = arrived_at(request)
        place = (course_id, assignment_id, named)
        begun = partial(_begun, place, learner, caller.owner, idempotency_key)
        # Not by the threads that read: there a hand-in would wait for the queries of tutors.
        found = await write(store, begun)
        if isinstance(found, CourseError):
            raise course_problem(found)
        terms, own, seed, before = found
        exercise = _variant(own, seed)
        # Its fields have been validated.
        attempt = AttemptRequest.model_construct(
            (body.model_fields_set - {"exercise"}) | {"learner"},
            **{name: getattr(body, name) for name in GradeRequest.model_fields},
            learner=learner,
        )
        level = partial(terms.feedback_at, exercise)
        return await Recorder(store, feedback, monitor).answer(
            request,
            exercise,
            attempt,
            AttemptTerms(terms.rules, level, terms.number),
            caller.owner,
            idempotency_key,
            (now, before),
        )

    @router.get(
        "/courses/{course_id}/assignments/{assignment_id}/solutions/{exercise_id}",
        operation_id="getAssignedSolution",
        summary="Show a learner the solution of an exercise",
        response_description="The model solution.",
        **reading(ModelSolution),
    )
    async def show_assigned_solution(
        request: Request,
        course_id: CourseId,
        assignment_id: AssignmentId,
        exercise_id: ExerciseId,
    ) -> Response:
        """Show a learner the model solution, once the assignment allows it."""
        from service.courses.dealing import assigned
        from service.courses.learner_view import has_full_marks

        learner = _learner(access.caller(request), None)
        named = exercise_or_404(catalogue, exercise_id)
        terms, exercise = await read(
            store, lambda it: assigned(it, course_id, assignment_id, learner, named)
        )
        is_full = await read(
            store, lambda it: has_full_marks(it, learner, terms.number, exercise.id)
        )
        if not terms.shows_solution(datetime.now(UTC), is_full=is_full):
            raise ProblemError(
                HTTPStatus.FORBIDDEN,
                say("The assignment does not show you this solution now."),
                "solution-not-shown",
                say("The solution is not shown"),
            )
        return await solutions.answer(exercise)

    return router


def _begun(
    place: tuple[str, str, Exercise],
    learner: str,
    owner: str,
    idempotency_key: str,
    connection: "Connection",
) -> "tuple[LearnerTerms, Exercise, str | None, Standing] | CourseError":
    # A CourseError is returned, not raised, because the transaction contains the work of other
    # requests, too.
    from service.attempts.recording import standing
    from service.courses.dealing import assigned_seed, needs_choices, pin_choices

    course, assignment, exercise = place
    try:
        terms, own, seed = assigned_seed(connection, course, assignment, learner, exercise)
        if needs_choices(terms, exercise):
            pin_choices(connection, course, assignment, {exercise.id: exercise})
    except CourseError as error:
        return error
    number = terms.number
    counted = standing(connection, exercise.id, learner, owner, idempotency_key, number)
    return terms, own, seed, counted


def _variant(exercise: Exercise, seed: str | None) -> Exercise:
    from service.courses.dealing import variant_for

    try:
        return variant_for(exercise, seed)
    except CourseError as error:
        raise course_problem(error) from None


def _learner(caller: Caller, named: str | None) -> str:
    if caller.learner is not None:
        if named not in (None, caller.learner):
            raise access_problem("other-learner")
        return caller.learner
    if named is None:
        raise access_problem("learner-needed")
    return named
