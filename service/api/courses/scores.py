"""Routes for tutors: list the scores sent to learning platforms, and send them again."""

from datetime import UTC, datetime
from typing import TYPE_CHECKING, Annotated

from fastapi import APIRouter, Query, Request, Response

from service.api.courses.asking import CourseId, changing, read, reading, write
from service.api.http.bodies import read_body
from service.api.http.language import language_of
from service.api.http.told_answer import in_languages, told_json
from service.api.recording.store import NO_STORE, private
from service.contract.attempts import Learner
from service.contract.courses import CourseName
from service.contract.scores import PlatformScores, SendAgainRequest, SentAgain

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore


def routes(store: "AttemptStore | None") -> APIRouter:
    """Return the routes for scores at learning platforms."""
    router = APIRouter(prefix="/v1/courses/{course_id}/scores", tags=["courses"])

    @router.get(
        "",
        operation_id="listScores",
        summary="List the scores that go to platforms",
        response_description="The scores, by assignment and name.",
        **in_languages(reading(PlatformScores)),
    )
    async def list_scores(
        request: Request,
        course_id: CourseId,
        assignment: Annotated[
            CourseName | None, Query(description="Only those of this assignment.")
        ] = None,
        learner: Annotated[Learner | None, Query(description="Only those of this learner.")] = None,
        failed: Annotated[
            bool, Query(description="Only those that were refused, or tried in vain.")
        ] = False,
    ) -> Response:
        """List what was sent to the platforms from which the course is launched; for tutors."""
        from service.lti.scores.overview import scores_of

        wanted = SendAgainRequest(assignment=assignment, learner=learner, failed=failed)
        language = language_of(request)
        found = await read(store, lambda it: scores_of(it, course_id, wanted, language))
        content = PlatformScores(scores=found).model_dump_json(exclude_none=True)
        return told_json(content, language, headers=NO_STORE)

    @router.post(
        "/send",
        operation_id="sendScores",
        summary="Send scores to platforms again",
        response_description="How many scores are sent again.",
        **changing(SendAgainRequest, SentAgain),
    )
    async def send_scores(request: Request, course_id: CourseId) -> Response:
        """Send scores again, also those that the platforms have already; for tutors."""
        from service.lti.scores.overview import send_again

        body, now = await read_body(SendAgainRequest, request), datetime.now(UTC)
        queued = await write(store, lambda it: send_again(it, course_id, body, now))
        return private(SentAgain(queued=queued))

    return router
