"""Routes for tutors: the personal links with which learners open their courses."""

from datetime import UTC, datetime
from typing import TYPE_CHECKING

from fastapi import APIRouter, Request, Response

from service.api.courses.asking import (
    CourseId,
    changing,
    course_problem,
    service_address,
    write,
)
from service.api.http.bodies import read_body
from service.api.permissions.access import Access
from service.api.recording.store import private
from service.contract.courses import LinkList, LinksRequest, RevokedLinks, RevokeLinksRequest
from service.courses.errors import links_need_a_secret

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore


def routes(store: "AttemptStore | None", access: Access) -> APIRouter:
    """Return the routes with which tutors create and revoke personal links."""
    router = APIRouter(prefix="/v1/courses", tags=["courses"])

    @router.post(
        "/{course_id}/links",
        operation_id="createLinks",
        summary="Make personal links",
        response_description="The links, by the names of the learners.",
        **changing(LinksRequest, LinkList),
    )
    async def create_links(request: Request, course_id: CourseId) -> Response:
        """Return the personal links of learners; for tutors of the course.

        A learner without a valid link gets a new one, and so does every learner with `renew`. The
        links begin with the setting `DH_GRADER_PUBLIC_URL`, or else with the address of this
        request.
        The part after `#` is a key: the learner's page sends it in the header
        `Authorization: Bearer`, and browsers never send it otherwise.
        """
        from service.courses.links import issue_links

        body = await read_body(LinksRequest, request)
        secret = None if access.keys is None else access.keys.secret
        if secret is None:
            raise course_problem(links_need_a_secret())
        known, address, now = secret, service_address(request), datetime.now(UTC)
        return private(
            LinkList(
                links=await write(
                    store, lambda it: issue_links(it, course_id, body, known, address, now)
                )
            )
        )

    @router.post(
        "/{course_id}/links/revoke",
        operation_id="revokeLinks",
        summary="End personal links",
        response_description="The number of ended links.",
        **changing(RevokeLinksRequest, RevokedLinks),
    )
    async def end_links(request: Request, course_id: CourseId) -> Response:
        """End the personal links of learners, within seconds; for tutors of the course."""
        from service.courses.links import revoke_links

        body = await read_body(RevokeLinksRequest, request)
        now = datetime.now(UTC)
        count = await write(store, lambda it: revoke_links(it, course_id, body.learners, now))
        return private(RevokedLinks(revoked=count))

    return router
