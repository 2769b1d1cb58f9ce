"""Routes for tutors: assignments, and extensions (changed dates for single learners)."""

from http import HTTPStatus
from typing import TYPE_CHECKING, Annotated

from fastapi import APIRouter, Query, Request, Response

from service.api.courses.asking import (
    AssignmentId,
    CourseId,
    changing,
    read,
    reading,
    write,
)
from service.api.http.bodies import read_body
from service.api.http.lookup import Catalogue, require_exercise
from service.api.recording.store import private
from service.contract.attempts import Learner
from service.contract.courses import (
    AssignmentChange,
    CourseAssignment,
    CourseAssignmentList,
    DealRequest,
    Extension,
    LearnerVariant,
    LearnerVariants,
    NewAssignment,
)

if TYPE_CHECKING:  # it loads the drivers of databases
    from sqlalchemy import Connection

    from service.attempts.store import AttemptStore


def routes(catalogue: Catalogue, store: "AttemptStore | None") -> APIRouter:
    """Return the routes with which tutors create and change assignments."""
    router = APIRouter(prefix="/v1/courses/{course_id}", tags=["courses"])

    @router.get(
        "/assignments",
        operation_id="listAssignments",
        summary="List the assignments of a course",
        response_description="The assignments, in the order in which they were added.",
        **reading(CourseAssignmentList),
    )
    async def list_assignments(course_id: CourseId) -> Response:
        """List the assignments of a course; for tutors of the course."""
        from service.courses.assignments import assignments_of

        found = await read(store, lambda it: assignments_of(it, course_id))
        return private(CourseAssignmentList(assignments=found))

    @router.post(
        "/assignments",
        operation_id="createAssignment",
        summary="Add an assignment to a course",
        response_description="The assignment.",
        **changing(
            NewAssignment, CourseAssignment, HTTPStatus.CONFLICT, success=HTTPStatus.CREATED
        ),
    )
    async def create_assignment(request: Request, course_id: CourseId) -> Response:
        """Add an assignment; for tutors of the course."""
        from service.courses.assignments import add_assignment
        from service.courses.dealing import pin_choices

        body = await read_body(NewAssignment, request)

        def add(connection: "Connection") -> CourseAssignment:
            added = add_assignment(connection, course_id, body, catalogue.keys())
            pin_choices(connection, course_id, body.id, catalogue)
            return added

        created = private(await write(store, add))
        created.status_code = HTTPStatus.CREATED
        return created

    @router.get(
        "/assignments/{assignment_id}",
        operation_id="getAssignment",
        summary="Show an assignment",
        response_description="The assignment.",
        **reading(CourseAssignment),
    )
    async def show_assignment(course_id: CourseId, assignment_id: AssignmentId) -> Response:
        """Show an assignment with its extensions; for tutors of the course."""
        from service.courses.assignments import assignment_of

        return private(await read(store, lambda it: assignment_of(it, course_id, assignment_id)))

    @router.post(
        "/assignments/{assignment_id}",
        operation_id="changeAssignment",
        summary="Change an assignment",
        response_description="The assignment.",
        **changing(AssignmentChange, CourseAssignment),
    )
    async def change_assignment(
        request: Request, course_id: CourseId, assignment_id: AssignmentId
    ) -> Response:
        """Change the given fields of an assignment; for tutors of the course.

        With a later due date, attempts that are not late any more get all their points. An
        earlier due date makes no recorded attempt late.
        """
        from service.courses import assignments
        from service.courses.dealing import pin_choices

        body = await read_body(AssignmentChange, request)

        def change(connection: "Connection") -> CourseAssignment:
            known = catalogue.keys()
            changed = assignments.change_assignment(
                connection, course_id, assignment_id, body, known
            )
            renew = body.renew_variants
            pin_choices(connection, course_id, assignment_id, catalogue, renew=renew)
            return changed

        return private(await write(store, change))

    @router.post(
        "/assignments/{assignment_id}/extensions",
        operation_id="extendAssignment",
        summary="Give a learner other dates or another limit",
        response_description="The assignment with its extensions.",
        **changing(Extension, CourseAssignment),
    )
    async def extend_assignment(
        request: Request, course_id: CourseId, assignment_id: AssignmentId
    ) -> Response:
        """Give one learner other dates or another limit; for tutors of the course.

        It replaces an earlier extension of the learner. Without dates and limit, it removes it.
        """
        from service.courses.assignments import extend

        body = await read_body(Extension, request)
        return private(await write(store, lambda it: extend(it, course_id, assignment_id, body)))

    @router.get(
        "/assignments/{assignment_id}/variants",
        operation_id="listVariants",
        summary="Show the variants of a learner",
        response_description="The variants of the learner in the assignment.",
        **reading(LearnerVariants),
    )
    async def list_variants(
        course_id: CourseId,
        assignment_id: AssignmentId,
        learner: Annotated[Learner, Query(description="The learner.")],
    ) -> Response:
        """Show which variant a learner has of each exercise; for tutors of the course."""
        from service.courses.dealing import learner_variants

        found = await read(
            store, lambda it: learner_variants(it, course_id, assignment_id, learner, catalogue)
        )
        return private(LearnerVariants(learner=learner, variants=found))

    @router.post(
        "/assignments/{assignment_id}/variants",
        operation_id="dealVariant",
        summary="Give a learner another variant",
        response_description="The new variant.",
        **changing(DealRequest, LearnerVariant),
    )
    async def deal_variant(
        request: Request, course_id: CourseId, assignment_id: AssignmentId
    ) -> Response:
        """Give a learner another variant of an exercise; for tutors of the course.

        Earlier attempts keep their points, and count as before.
        """
        from service.courses.dealing import deal_again

        body = await read_body(DealRequest, request)
        exercise = require_exercise(catalogue, body.exercise)
        dealt = await write(
            store,
            lambda it: deal_again(it, course_id, assignment_id, body.learner, exercise),
        )
        return private(dealt)

    return router
