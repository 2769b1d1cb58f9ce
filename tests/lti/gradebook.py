"""The gradebook of the test platform (the LTI service AGS)."""

import asyncio
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from typing import Any, Final
from urllib.parse import parse_qsl

import jwt
from fastapi import APIRouter, Request
from fastapi.responses import JSONResponse, Response

AGS: Final = "https://purl.imsglobal.org/spec/lti-ags/scope/"
SCORE: Final = "application/vnd.ims.lis.v1.score+json"
CANVAS: Final = "https://canvas.instructure.com/lti/submission"
# Moodle demands all of them.
DEMANDED: Final = ("userId", "timestamp", "activityProgress", "gradingProgress")
# The answer of an hour of trouble: a status, and headers.
Trouble = tuple[int, dict[str, str]]


@dataclass
class Item:
    """A column of the test platform's gradebook (an LTI line item)."""

    link: str
    label: str = ""
    grades: dict[str, float | None] = field(default_factory=dict)
    stamps: dict[str, datetime] = field(default_factory=dict)


@dataclass
class Gradebook:
    """The test platform's gradebook, with its access tokens and scores."""

    # `received` are the accepted scores in the order of arrival; `asked` are the kinds of all
    # requests, `refused` the refusals.
    address: Callable[[], str]
    # Answers requests for tokens that read the roster.
    roster_token: Callable[[Mapping[str, str]], Response]
    now: Callable[[], datetime] = lambda: datetime.now(UTC)
    own_keys: Callable[[], Any] = lambda: {"keys": []}
    items: dict[str, Item] = field(default_factory=dict)
    tokens: dict[str, tuple[set[str], datetime]] = field(default_factory=dict)
    received: list[dict[str, Any]] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)
    # Line items have a query string, without which nobody is answered.
    query: str = "type=1"
    # The audience of assertions; None for the token address.
    audience: str | None = None
    lifetime: int = 3600
    enrolled: set[str] | None = None
    # The status for users that are not enrolled: 400 (Moodle), 422 (Canvas), 403, 404.
    not_enrolled: int = 400
    trouble: Trouble | None = None
    token_trouble: Trouble | None = None
    # The most scores in a window of seconds.
    pace: tuple[int, int] | None = None
    window: tuple[int, int] = (0, 0)
    # What the list of line items is instead, if there is one.
    listed: list[Any] = field(default_factory=list)
    before_answer: Callable[[], None] = lambda: None
    before_item: Callable[[], None] = lambda: None

    def __post_init__(self) -> None:
        self.items["1"] = Item("link-1")

    def reset(self) -> None:
        self.__dict__.update(Gradebook(self.address, self.roster_token).__dict__)

    def url(self, item: str) -> str:
        """Return the address of a line item."""
        return f"{self.address()}/items/{item}" + (f"?{self.query}" if self.query else "")

    def grades(self, item: str = "1") -> dict[str, float | None]:
        found = self.items[item].grades
        return {user.removeprefix("user "): grade for user, grade in found.items()}

    def routes(self) -> APIRouter:
        router = APIRouter()

        @router.post("/token")
        async def token(request: Request) -> Response:
            self.asked.append("token")
            form = dict(parse_qsl((await request.body()).decode()))
            if form["scope"].endswith("contextmembership.readonly"):
                return self.roster_token(form)
            if self.token_trouble is not None:
                return Response(status_code=self.token_trouble[0], headers=self.token_trouble[1])
            return await asyncio.to_thread(self._token, form)

        @router.get("/items")
        async def items(request: Request) -> Response:
            self.asked.append("items")
            if (refused := self._refused(request, {"lineitem", "lineitem.readonly"})) is not None:
                return refused
            if self.listed:
                return JSONResponse(self.listed[0])
            link = request.query_params.get("resource_link_id")
            # Two pages: the line item of the link is on the second one.
            if request.query_params.get("page") is None:
                following = f'<{self.address()}/items?{request.url.query}&page=2>; rel="next"'
                return JSONResponse([], headers={"Link": following})
            return JSONResponse(
                [
                    {"id": self.url(name), "resourceLinkId": each.link, "label": each.label}
                    for name, each in self.items.items()
                    if link in (None, each.link)
                ]
            )

        @router.post("/items")
        async def new_item(request: Request) -> Response:
            self.asked.append("new item")
            if (refused := self._refused(request, {"lineitem"})) is not None:
                return refused
            await asyncio.to_thread(self.before_item)
            body = await request.json()
            assert body["scoreMaximum"] > 0
            name = str(len(self.items) + 101)
            self.items[name] = Item(body["resourceLinkId"], body["label"])
            return JSONResponse({**body, "id": self.url(name)}, 201)

        self._scores_route(router)
        return router

    def _scores_route(self, router: APIRouter) -> None:
        @router.post("/items/{name}/scores")
        async def score(request: Request, name: str) -> Response:
            self.asked.append("score")
            answer = await self._scored(request, name)
            if answer.status_code >= 400:
                self.refused.append(f"{answer.status_code}")
            await asyncio.to_thread(self.before_answer)
            return answer

    def _token(self, form: dict[str, Any]) -> Response:
        assert form["grant_type"] == "client_credentials"
        keys = {each["kid"]: jwt.PyJWK(each) for each in self.own_keys()["keys"]}
        assertion = form["client_assertion"]
        key = keys[jwt.get_unverified_header(assertion)["kid"]]
        audience = self.audience or f"{self.address()}/token"
        options: Any = {"verify_exp": False, "verify_iat": False}
        try:
            claims = jwt.decode(assertion, key, ["RS256"], audience=audience, options=options)
        except jwt.InvalidTokenError as error:
            return JSONResponse({"error": "invalid_client", "said": str(error)}, 400)
        now = self.now().timestamp()
        assert claims["iss"] == claims["sub"] == "client-1"
        assert claims["iat"] <= now < claims["exp"]
        text = f"token-{len(self.tokens)}-{claims['jti']}"
        until = self.now() + timedelta(seconds=self.lifetime)
        self.tokens[text] = ({each.removeprefix(AGS) for each in form["scope"].split()}, until)
        answer = {"access_token": text, "token_type": "Bearer", "expires_in": self.lifetime}
        return JSONResponse(answer)

    def _refused(self, request: Request, scopes: set[str]) -> Response | None:
        text = request.headers.get("authorization", "").removeprefix("Bearer ")
        known, until = self.tokens.get(text, (set(), self.now()))
        if not scopes & known or until <= self.now():
            return JSONResponse({"error": "unauthorised"}, 401)
        # Moodle refuses requests without a name.
        if not request.headers.get("user-agent", "").startswith("dh-grader/"):
            return Response(status_code=403)
        if self.query and self.query not in request.url.query:
            return Response(status_code=404)
        return None

    async def _scored(self, request: Request, name: str) -> Response:
        if self.trouble is not None:
            return Response(status_code=self.trouble[0], headers=self.trouble[1])
        if (refused := self._refused(request, {"score"})) is not None:
            return refused
        if self.pace is not None:
            most, seconds = self.pace
            number, left = divmod(int(self.now().timestamp()), seconds)
            self.window = number, self.window[1] + 1 if self.window[0] == number else 1
            if self.window[1] > most:
                return Response(status_code=429, headers={"Retry-After": str(seconds - left)})
        return self._graded(await request.body(), request, name)

    def _graded(self, content: bytes, request: Request, name: str) -> Response:
        if request.headers["content-type"] != SCORE:
            return Response(status_code=400)
        body = json.loads(content)
        if name not in self.items:
            return Response(status_code=404)
        if not all(body.get(each) for each in DEMANDED):
            return Response(status_code=400)
        user, item = body["userId"], self.items[name]
        if self.enrolled is not None and user not in self.enrolled:
            return JSONResponse({"errors": {"type": "unprocessable"}}, self.not_enrolled)
        stamp = datetime.fromisoformat(body["timestamp"])
        before = item.stamps.get(user)
        # As Moodle does, in whole seconds; and not from the future.
        if before is not None and int(stamp.timestamp()) <= int(before.timestamp()):
            return Response(status_code=409)
        if stamp > self.now() or "." not in body["timestamp"]:
            return Response(status_code=400)
        # A score is not from before what it is for.
        handed_in = body.get("submission", {}).get("submittedAt", body["timestamp"])
        if stamp < datetime.fromisoformat(handed_in):
            return Response(status_code=400)
        self._note(body, item, stamp)
        return Response(status_code=200)

    def _note(self, body: dict[str, Any], item: Item, stamp: datetime) -> None:
        user = body["userId"]
        item.stamps[user] = stamp
        self.received.append(body)
        if "scoreGiven" not in body:
            item.grades[user] = None
        elif body["gradingProgress"] == "FullyGraded":
            assert body[CANVAS]["new_submission"] is False
            item.grades[user] = body["scoreGiven"] / body["scoreMaximum"] * 100
