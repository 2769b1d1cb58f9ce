"""The route to which platforms send signed notices that a student has handed in a file."""

# Without a login and without a browser.

import logging
from collections.abc import Mapping
from datetime import UTC, datetime
from http import HTTPStatus
from typing import Annotated, Final

from fastapi import APIRouter, Request
from pydantic import BaseModel, Field
from sqlalchemy import Connection
from starlette.responses import JSONResponse, Response

from service.access.keys import Secret
from service.api.courses.asking import read, write
from service.api.http.bodies import read_body
from service.attempts.store import AttemptStore
from service.lti.handed_files.notices import notice_in, parties_of
from service.lti.handed_files.queue import queue_files
from service.lti.linking import pseudonym
from service.lti.messages import key_id_of
from service.lti.platform_keys import PlatformKeys
from service.lti.problems import LtiError
from service.lti.registrations import find_registration, note_refusal

_log = logging.getLogger(__name__)

_MOST: Final = 50


class SignedNotice(BaseModel):
    """A signed notice from a learning platform."""

    jwt: str


class Notices(BaseModel):
    """The body of a request with several notices from a learning platform."""

    notices: Annotated[list[SignedNotice], Field(min_length=1, max_length=_MOST)]


def notice_routes(store: AttemptStore, secret: Secret, keys: PlatformKeys) -> APIRouter:
    """Return the route that accepts notices from learning platforms."""
    router = APIRouter(prefix="/lti")

    async def accept(token: str, refusals: dict[str, str]) -> None:
        # Queue the files of a notice. Raises LtiError.
        # If the notice is of a registered platform, store the name of an error in ``refusals``, at
        # the id of the registration.
        key_id, now = key_id_of(token), datetime.now(UTC)
        parties = parties_of(token)
        known = await read(store, lambda it: find_registration(it, *parties))
        try:
            notice = notice_in(token, await keys.key(known, key_id), known, now)
            if notice is not None:
                learner = pseudonym(known.id, notice.user, secret)
                await write(store, lambda it: queue_files(it, known, notice, learner, now))
        except LtiError as error:
            refusals[known.id] = error.name
            raise

    @router.post("/notices")
    async def notices(request: Request) -> Response:
        """Accept the notices in a request, even if one of them is refused."""
        body = await read_body(Notices, request)
        refused: list[dict[str, str]] = []
        refusals: dict[str, str] = {}
        for each in body.notices:
            try:
                await accept(each.jwt, refusals)
            except LtiError as error:
                _log.warning("LTI: a notice was refused (%s): %s", error.name, error)
                refused.append({"error": error.name})
        # Anybody may send what is refused: one transaction for all of it.
        if refusals:
            await write(store, lambda it: _note(it, refusals))
        if refused:
            return JSONResponse({"errors": refused}, HTTPStatus.FORBIDDEN)
        return JSONResponse({})

    return router


def _note(connection: Connection, refusals: Mapping[str, str]) -> None:
    now = datetime.now(UTC)
    for registration_id, name in refusals.items():
        note_refusal(connection, registration_id, name, now)
