"""Routes for tutors: courses and their learners."""

from datetime import UTC, datetime
from functools import partial
from http import HTTPStatus
from typing import TYPE_CHECKING

from fastapi import APIRouter, Request, Response

from service.api.courses.asking import CourseId, changing, course_problem, read, reading, write
from service.api.http.bodies import read_body
from service.api.http.problems import invalid
from service.api.permissions.access import Access
from service.api.recording.store import private
from service.contract.courses import (
    AddedLearners,
    Course,
    CourseChange,
    CourseList,
    LearnerList,
    LearnersRequest,
    NewCourse,
    NewLearner,
)
from service.courses.errors import CourseError
from service.translations import say

if TYPE_CHECKING:  # they load the drivers of databases
    from sqlalchemy import Connection

    from service.attempts.store import AttemptStore


def routes(store: "AttemptStore | None", access: Access) -> APIRouter:
    """Return the routes with which tutors set up courses."""
    router = APIRouter(prefix="/v1/courses", tags=["courses"])

    @router.get(
        "",
        operation_id="listCourses",
        summary="List the courses",
        response_description="The courses, the newest first.",
        **reading(CourseList),
    )
    async def list_courses(request: Request) -> Response:
        """List all courses, or, with a key of a course, this one; for tutors."""
        from service.courses import roll

        only = access.caller(request).course
        return private(CourseList(courses=await read(store, lambda it: roll.all_courses(it, only))))

    @router.post(
        "",
        operation_id="createCourse",
        summary="Create a course",
        response_description="The course.",
        **changing(NewCourse, Course, HTTPStatus.CONFLICT, success=HTTPStatus.CREATED),
    )
    async def create_course(request: Request) -> Response:
        """Create a course; for tutors of all courses."""
        from service.courses import roll

        body = await read_body(NewCourse, request)
        now = datetime.now(UTC)
        created = private(await write(store, lambda it: roll.add_course(it, body, now)))
        created.status_code = HTTPStatus.CREATED
        return created

    @router.get(
        "/{course_id}",
        operation_id="getCourse",
        summary="Show a course",
        response_description="The course.",
        **reading(Course),
    )
    async def show_course(course_id: CourseId) -> Response:
        """Show a course; for tutors of the course."""
        from service.courses import roll

        return private(await read(store, lambda it: roll.course(it, course_id)))

    @router.post(
        "/{course_id}",
        operation_id="changeCourse",
        summary="Change a course",
        response_description="The course.",
        **changing(CourseChange, Course),
    )
    async def change_course(request: Request, course_id: CourseId) -> Response:
        """Change the title or the time zone of a course; for tutors of the course."""
        from service.courses import roll

        body = await read_body(CourseChange, request)
        return private(await write(store, lambda it: roll.change_course(it, course_id, body)))

    @router.get(
        "/{course_id}/learners",
        operation_id="listLearners",
        summary="List the learners of a course",
        response_description="The learners, by name.",
        **reading(LearnerList),
    )
    async def list_learners(course_id: CourseId) -> Response:
        """List the learners of a course; for tutors of the course."""
        return private(await read(store, partial(_learners, course_id)))

    @router.post(
        "/{course_id}/learners",
        operation_id="addLearners",
        summary="Add learners to a course",
        response_description="All learners of the course, by name.",
        **changing(LearnersRequest, AddedLearners),
    )
    async def add_learners(request: Request, course_id: CourseId) -> Response:
        """Add learners, or a class list in CSV; for tutors of the course.

        A learner who is there already gets the new name and e-mail address. Nobody is removed.
        """
        from service.courses import roll

        new = _new_learners(await read_body(LearnersRequest, request))

        def work(connection: "Connection") -> AddedLearners:
            added = roll.add_learners(connection, course_id, new)
            learners = _learners(course_id, connection).learners
            return AddedLearners(learners=learners, listed=len(new), added=added)

        return private(await write(store, work))

    return router


def _learners(course_id: str, connection: "Connection") -> LearnerList:
    from service.courses import roll

    return LearnerList(learners=roll.learners(connection, course_id, datetime.now(UTC)))


def _new_learners(body: LearnersRequest) -> list[NewLearner]:
    if (body.learners is None) == (body.csv is None):
        message = say("Send either learners or csv.")
        raise invalid([{"type": "either", "loc": (), "msg": message}])
    if body.csv is None:
        return body.learners or []
    from service.courses.class_list import read_class_list

    try:
        return read_class_list(body.csv)
    except CourseError as error:
        raise course_problem(error) from error
