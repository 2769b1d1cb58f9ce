"""An LTI platform built with the library lti1p3platform."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Final
from urllib.parse import parse_qsl

import jwt
from cryptography.hazmat.primitives.serialization import (
    Encoding,
    NoEncryption,
    PrivateFormat,
    PublicFormat,
)
from fastapi import FastAPI
from fastapi import Request as HttpRequest
from fastapi.responses import JSONResponse
from fastapi.responses import Response as HttpResponse
from lti1p3platform.exceptions import LineItemNotFoundException
from lti1p3platform.ltiplatform import LTI1P3PlatformConfAbstract
from lti1p3platform.membership import Context
from lti1p3platform.message_launch import LTIAdvantageMessageLaunchAbstract
from lti1p3platform.registration import Registration
from lti1p3platform.request import Request
from lti1p3platform.response import Response, generate_next_link
from lti1p3platform.score import UpdateScoreStatus
from lti1p3platform.service_connector import AssignmentsGradesService, NamesRoleProvisioningService

from tests.lti.platform import CLIENT, DEPLOYMENT

# The library checks and makes tokens and messages. This module has the parts that the library
# leaves to its users: the storage, and the routes that call the library's handlers.

_FORM: Final = "application/x-www-form-urlencoded"


class Configuration(LTI1P3PlatformConfAbstract):  # type: ignore[misc]
    """The registration of the service at a platform that is built with lti1p3platform."""

    def init_platform_config(self, **kwargs: Any) -> None:
        platform = kwargs["platform"]
        made = Registration().set_iss(platform.address).set_client_id(CLIENT)
        made.set_deployment_id(DEPLOYMENT).set_launch_url(f"{platform.tool}/lti/launch")
        made.set_oidc_login_url(f"{platform.tool}/lti/login")
        self._registration = made
        self.sign_with(platform.key)

    def sign_with(self, key: Any) -> None:
        private = key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())
        public = key.public_key().public_bytes(Encoding.PEM, PublicFormat.SubjectPublicKeyInfo)
        self._registration.set_platform_public_key(public.decode())
        self._registration.set_platform_private_key(private.decode())

    def get_registration_by_params(self, **_: Any) -> Registration:
        raise NotImplementedError


class Launch(LTIAdvantageMessageLaunchAbstract):  # type: ignore[misc]
    """An LTI launch that returns form fields instead of a page."""

    def render_launch_form(self, launch_data: dict[str, Any], **_: Any) -> Any:
        return launch_data


class Preflight(Request):  # type: ignore[misc]
    """The login request that our service sends to the platform."""

    def build_metadata(self, request: Any) -> Any:
        return {"get_data": request, "form_data": {}}


class Called(Request):  # type: ignore[misc]
    """A request to a service of the platform, and the JSON in its body."""

    def build_metadata(self, request: Any) -> Any:
        asked, body = request
        query = dict(asked.query_params)
        pages = {name: int(query[name]) for name in ("page", "limit") if name in query}
        fields = {"method": asked.method, "headers": asked.headers, "get_data": query | pages}
        return {**fields, "json": body}


@dataclass
class OtherPlatform:
    """A fake learning platform with gradebook columns, scores and members."""

    # `makes_items` is true if our service may make line items.
    configuration: Configuration
    port: int = 0
    makes_items: bool = True
    items: dict[str, dict[str, Any]] = field(default_factory=dict)
    scores: dict[str, dict[str, dict[str, Any]]] = field(default_factory=dict)
    members: list[dict[str, Any]] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def app(self) -> FastAPI:
        app = FastAPI()

        @app.post("/token")
        async def token(request: HttpRequest) -> Any:
            self.asked.append("token")
            assert request.headers["content-type"] == _FORM
            return self.configuration.get_access_token(
                dict(parse_qsl((await request.body()).decode()))
            )

        @app.get("/items")
        async def items(request: HttpRequest) -> HttpResponse:
            grades = Grades(self, Called((request, None)))
            return self._answer("items", grades, grades.handle_get_lineitems)

        @app.post("/items")
        async def new_item(request: HttpRequest) -> HttpResponse:
            grades = Grades(self, Called((request, await request.json())))
            return self._answer("new item", grades, grades.handle_create_lineitem)

        @app.post("/items/{item}/scores")
        async def score(request: HttpRequest, item: str) -> HttpResponse:
            grades = Grades(self, Called((request, await request.json())))
            handle = grades.handle_update_score
            return self._answer("score", grades, handle, line_item_id=item)

        @app.get("/members")
        async def members(request: HttpRequest) -> HttpResponse:
            roster = Roster(self, Called((request, None)))
            return self._answer("members", roster, roster.handle_get_members)

        return app

    def _answer(
        self, kind: str, service: Any, handle: Callable[..., Response], **more: str
    ) -> HttpResponse:
        self.asked.append(kind)
        try:
            response = service.handle_resp(handle, **more)
        except jwt.InvalidTokenError:
            self.asked[-1] += " refused"
            return HttpResponse(status_code=401)
        result = response.result
        if result is None:
            return HttpResponse(status_code=response.code)
        # The library has the address of the next page in the result; the standard, in a header.
        following = result.pop("next", None)
        headers = {"link": generate_next_link(following)} if following else {}
        content = result.get("content", result)
        return JSONResponse(content, response.code, headers, response.media_type)


class Grades(AssignmentsGradesService):  # type: ignore[misc]
    """The platform's gradebook (the LTI service AGS)."""

    def __init__(self, platform: OtherPlatform, request: Called) -> None:
        items, makes_items = f"{platform.address}/items", platform.makes_items
        super().__init__(
            request, platform.configuration, items, allow_creating_lineitems=makes_items
        )
        self._platform = platform

    def find_lineitems(
        self, page: int = 1, resource_link_id: str = "", limit: int | None = None
    ) -> Any:
        # Return the line item on this page: pages have one line item each.
        del limit
        listed = list(self._platform.items.values())[page - 1 :]
        mine = [each for each in listed[:1] if each["resourceLinkId"] == resource_link_id]
        return {"content": mine, "has_next": len(listed) > 1}

    def create_lineitem(self, creation_data: Any) -> Any:
        name = f"i{len(self._platform.items)}"
        made = {**creation_data, "id": f"{self._platform.address}/items/{name}"}
        self._platform.items[name] = made
        return made

    def update_score(self, line_item_id: str, score: Any) -> UpdateScoreStatus:
        if line_item_id not in self._platform.items:
            raise LineItemNotFoundException
        known = self._platform.scores.setdefault(line_item_id, {})
        before = known.get(score["userId"])
        if before is not None and score["timestamp"] <= before["timestamp"]:
            return UpdateScoreStatus.OLD_TIMESTAMP
        known[score["userId"]] = score
        return UpdateScoreStatus.SUCCESS

    def find_lineitem(self, line_item_id: str) -> Any:
        raise NotImplementedError

    def update_lineitem(self, update_data: Any) -> Any:
        raise NotImplementedError

    def delete_lineitem(self, line_item_id: str) -> None:
        raise NotImplementedError

    def get_results(self, line_item_id: str, *_: Any, **__: Any) -> Any:
        raise NotImplementedError


class Roster(NamesRoleProvisioningService):  # type: ignore[misc]
    """The platform's class list (the LTI service NRPS)."""

    def __init__(self, platform: OtherPlatform, request: Called) -> None:
        url = f"{platform.address}/members"
        super().__init__(request, platform.configuration, url)
        self._platform = platform

    def get_member_data_page(self, page: int = 1, limit: int = 1) -> Any:
        end = page * limit
        listed = self._platform.members
        return {"content": listed[end - limit : end], "has_next": end < len(listed)}

    def get_context_by_id(self) -> Context:
        return Context("course-9", "R", "Robots")
