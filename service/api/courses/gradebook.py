"""Routes for tutors: the gradebook, missing hand-ins, and a course as one learner sees it."""

from datetime import UTC, datetime
from http import HTTPStatus
from typing import TYPE_CHECKING, Annotated, Any, Final

from fastapi import APIRouter, Path, Query, Response

from service.api.courses.asking import AssignmentId, CourseId, course_problem, read, reading
from service.api.http.lookup import Catalogue
from service.api.recording.store import private, private_json
from service.contract.attempts import Learner
from service.contract.courses import CourseName, Gradebook, GradebookFormat, MissingList
from service.contract.own_courses import OwnCourses
from service.courses.errors import unknown_learner

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore

_CSV: Final[dict[str, Any]] = {"schema": {"type": "string"}}
_WORKBOOK: Final = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"


def routes(catalogue: Catalogue, store: "AttemptStore | None") -> APIRouter:
    """Return the routes with which tutors see the work of a class."""
    router = APIRouter(prefix="/v1/courses/{course_id}", tags=["courses"])

    @router.get(
        "/assignments/{assignment_id}/missing",
        operation_id="listMissing",
        summary="List learners who have not handed in",
        response_description="The learners, by name.",
        **reading(MissingList),
    )
    async def list_missing(course_id: CourseId, assignment_id: AssignmentId) -> Response:
        """List who has not handed in which exercises; for tutors of the course."""
        from service.courses.results.gradebook import missing

        found = await read(store, lambda it: missing(it, course_id, assignment_id))
        return private(MissingList(missing=found))

    gradebook_options = reading(Gradebook)
    gradebook_options["responses"][200] = {
        "content": {"text/csv": _CSV, _WORKBOOK: {"schema": {"type": "string", "format": "binary"}}}
    }

    @router.get(
        "/gradebook",
        operation_id="getGradebook",
        summary="Show the gradebook of a course",
        response_description="The gradebook, as JSON, CSV or a workbook.",
        **gradebook_options,
    )
    async def show_gradebook(
        course_id: CourseId,
        assignment: Annotated[CourseName | None, Query(description="Only this assignment.")] = None,
        form: Annotated[
            GradebookFormat,
            Query(
                alias="format",
                description="`json`, `csv`, CSV with the headings that `moodle` or `canvas` "
                "imports, or `xlsx`: a workbook with the points and the hand-ins.",
            ),
        ] = "json",
    ) -> Response:
        """Show the points that count, of each learner at each exercise; for tutors."""
        from service.courses.results.gradebook import gradebook, written_gradebook
        from service.courses.results.workbook import gradebook_workbook

        if form == "xlsx":
            content = await read(store, lambda it: gradebook_workbook(it, course_id, assignment))
            return Response(content, HTTPStatus.OK, _file(course_id, form), _WORKBOOK)
        book = await read(store, lambda it: gradebook(it, course_id, assignment))
        if form == "json":
            # Null means that nothing was handed in.
            return private_json(book.model_dump_json().encode())
        content = b"".join(written_gradebook(book, form))
        return Response(content, HTTPStatus.OK, _file(course_id, "csv"), "text/csv; charset=utf-8")

    @router.get(
        # An id may have a slash.
        "/learners/{learner:path}/view",
        operation_id="getLearnerView",
        summary="Show what a learner sees",
        response_description="The course as the learner sees it.",
        **reading(OwnCourses),
    )
    async def show_learner_view(
        course_id: CourseId, learner: Annotated[Learner, Path(description="The id of a learner.")]
    ) -> Response:
        """Show a course as one of its learners sees it; for tutors of the course."""
        from service.courses.learner_view import own_view

        now = datetime.now(UTC)
        view = await read(store, lambda it: own_view(it, learner, course_id, catalogue, now))
        if not view.courses:
            raise course_problem(unknown_learner(learner))
        return private(view)

    return router


def _file(course_id: str, ending: str) -> dict[str, str]:
    attachment = f'attachment; filename="gradebook-{course_id}.{ending}"'
    return {"Cache-Control": "no-store", "Content-Disposition": attachment}
