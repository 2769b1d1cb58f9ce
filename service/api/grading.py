"""The route that grades."""

from http import HTTPStatus

from fastapi import APIRouter, Request, Response

from service.api.bodies import body_as
from service.api.lookup import Catalogue, exercise_or_404, require_parts
from service.api.openapi import posting
from service.catalogue import FeedbackLevel, least
from service.formats.json import rendered
from service.grading import Report, grade
from service.submissions.body import GradeRequest


def routes(catalogue: Catalogue, feedback: FeedbackLevel) -> APIRouter:
    """The route that grades; no report tells more than ``feedback``."""
    router = APIRouter(prefix="/v1/exercises", tags=["grading"])

    # On the event loop and not in a thread: a grading is a millisecond of pure Python, which
    # threads cannot share, and a hop there and back costs a tenth of that. A body that was
    # made to be costly still takes up to a second here.
    @router.post(
        "/{exercise_id}/grade",
        **posting(GradeRequest, Report, "grade", HTTPStatus.NOT_FOUND),
    )
    async def grade_answers(exercise_id: str, request: Request) -> Response:
        """Grade answers, row by row and cell by cell. Nothing is recorded.

        Whatever a student wrote, the answer is a report: what cannot be read is `unreadable` there,
        with the reason, and everything else is graded. The same answers give the same report. It
        tells no more than the exercise and the service allow; `feedback` may ask for less.
        """
        exercise = exercise_or_404(catalogue, exercise_id)
        body = await body_as(GradeRequest, request)
        require_parts(exercise, {part: ("answers", part) for part in body.answers})
        ceiling = least(exercise.feedback, feedback)
        report = rendered(grade(exercise, body.submission(ceiling)))
        return Response(report, media_type="application/json")

    return router
