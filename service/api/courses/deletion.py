"""Routes for tutors: delete courses and assignments, and remove learners."""

from datetime import UTC, datetime
from http import HTTPStatus
from typing import TYPE_CHECKING

from fastapi import APIRouter, Request, Response

from service.api.courses.asking import AssignmentId, CourseId, changing, write
from service.api.http.bodies import read_body
from service.api.recording.store import private
from service.contract.courses import DeletedData, DeletionRequest, RemovalRequest

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore


def routes(store: "AttemptStore | None") -> APIRouter:
    """Return the routes that delete courses, assignments and learners."""
    router = APIRouter(prefix="/v1/courses/{course_id}", tags=["courses"])

    @router.post(
        "/delete",
        operation_id="deleteCourse",
        summary="Delete a course",
        response_description="What is deleted, or would be.",
        **changing(DeletionRequest, DeletedData, HTTPStatus.CONFLICT),
    )
    async def delete_course(request: Request, course_id: CourseId) -> Response:
        """Delete a course, and end its keys and links; for tutors of all courses.

        A course with recorded attempts is deleted only with `with_attempts`.
        """
        from service.courses import deletion

        body, now = await read_body(DeletionRequest, request), datetime.now(UTC)
        return private(
            await write(store, lambda it: deletion.delete_course(it, course_id, body, now))
        )

    @router.post(
        "/assignments/{assignment_id}/delete",
        operation_id="deleteAssignment",
        summary="Delete an assignment",
        response_description="What is deleted, or would be.",
        **changing(DeletionRequest, DeletedData, HTTPStatus.CONFLICT),
    )
    async def delete_assignment(
        request: Request, course_id: CourseId, assignment_id: AssignmentId
    ) -> Response:
        """Delete an assignment and its extensions; for tutors of the course.

        An assignment with recorded attempts is deleted only with `with_attempts`.
        """
        from service.courses import deletion

        body = await read_body(DeletionRequest, request)
        return private(
            await write(
                store, lambda it: deletion.delete_assignment(it, course_id, assignment_id, body)
            )
        )

    @router.post(
        "/learners/remove",
        operation_id="removeLearner",
        summary="Remove a learner from a course",
        response_description="What is deleted, or would be.",
        **changing(RemovalRequest, DeletedData),
    )
    async def remove_learner(request: Request, course_id: CourseId) -> Response:
        """Remove a learner, and end the learner's links; for tutors of the course.

        Without `with_attempts` the attempts stay, and count again if the learner comes back.
        """
        from service.courses import deletion

        body, now = await read_body(RemovalRequest, request), datetime.now(UTC)
        return private(
            await write(store, lambda it: deletion.remove_learner(it, course_id, body, now))
        )

    return router
