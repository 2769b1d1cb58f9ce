"""The page of the registered learning platforms, with a self-test for each platform."""

# It also shows their last launches and our keys.

from datetime import UTC, datetime
from http import HTTPStatus
from typing import TYPE_CHECKING, Annotated, NamedTuple

from fastapi import APIRouter, Path, Request
from starlette.responses import Response

from service.api.courses.asking import read, write
from service.api.http.language import language_of
from service.api.http.problems import ProblemError, message_of
from service.contract.courses import CourseName
from service.lti.checking import check_registration, last_refusal
from service.lti.own_keys import SigningKey, ensure_key, own_key_list, signing_key
from service.lti.problems import LtiError
from service.lti.registrations import (
    Registration,
    RegistrationError,
    all_registrations,
    deployments_of,
    registration,
)
from service.web.lti.landing import Landings
from service.web.page_answer import page_answer
from service.web.page_headers import FORM_HEADERS
from service.web.pages import page

if TYPE_CHECKING:
    from sqlalchemy import Connection

    from service.lti.checking import CheckLine

# Registrations are named as courses are.
_RegistrationId = Annotated[CourseName, Path(description="The id of a registration.")]


class _Shown(NamedTuple):
    # A registered platform, with the data that the page shows about it.
    registration: Registration
    deployments: list[str]
    refusal: str
    missing_reports: int


def platform_routes(landings: Landings) -> APIRouter:
    """Return the routes of the page with the registered learning platforms."""
    router = APIRouter(prefix="/tutor/platforms")

    async def answer(
        request: Request, tested: str = "", lines: "tuple[CheckLine, ...]" = ()
    ) -> Response:
        found, keys = await read(landings.store, lambda it: (_shown(it), own_key_list(it)))
        root = "../../../" if tested else "../"
        content = page(
            "web/lti/templates/platforms.html",
            landings.assets,
            root,
            ["page.js"],
            styles=["tutor.css", "records.css"],
            language=language_of(request),
            tutor=True,
            platforms=found,
            keys=keys,
            now=datetime.now(UTC),
            tested=tested,
            lines=lines,
        )
        return page_answer(request, content, FORM_HEADERS)

    @router.get("")
    async def platforms(request: Request) -> Response:
        """Return the page with the registered learning platforms and our keys."""
        return await answer(request)

    @router.post("/{registration_id}/check")
    async def check(request: Request, registration_id: _RegistrationId) -> Response:
        """Test the registration of a platform, and return the page with the results."""
        secret, now = landings.secret, datetime.now(UTC)

        def known(connection: "Connection") -> tuple[Registration, SigningKey]:
            found = registration(connection, registration_id)
            ensure_key(connection, secret, now)
            return found, signing_key(connection, secret, now)

        try:
            found, key = await write(landings.store, known)
        except RegistrationError as error:
            raise ProblemError(HTTPStatus.NOT_FOUND, message_of(error)) from error
        except LtiError as error:
            raise ProblemError(HTTPStatus.SERVICE_UNAVAILABLE, message_of(error)) from error
        lines = await landings.platforms.run(
            found.id, lambda: tuple(check_registration(found, key))
        )
        return await answer(request, found.id, lines)

    return router


def _shown(connection: "Connection") -> list[_Shown]:
    from service.lti.handed_files.overview import missing_counts

    missing = missing_counts(connection)
    return [
        _Shown(
            each,
            deployments_of(connection, each.id),
            last_refusal(each),
            missing.get(each.id, 0),
        )
        for each in all_registrations(connection)
    ]
