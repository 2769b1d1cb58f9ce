"""Files that students submit at the test platform (LTI Asset Processor)."""

import base64
import hashlib
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from fastapi import APIRouter, Request
from fastapi.responses import JSONResponse, RedirectResponse, Response

if TYPE_CHECKING:
    from tests.lti.platform import Platform


SCOPE: Final = "https://purl.imsglobal.org/spec/lti/scope/"
LTI: Final = "https://purl.imsglobal.org/spec/lti/claim/"


@dataclass
class FileStore:
    """The files that students submit at the test platform, and the reports on them."""

    # If `other_host` is set, the files are on that host, and the platform redirects requests to it.
    platform: "Platform"
    files: dict[str, bytes] = field(default_factory=dict)
    handlers: dict[str, str] = field(default_factory=dict)
    reports: list[dict[str, Any]] = field(default_factory=list)
    other_host: Callable[[str], str] | None = None
    elsewhere: list[str | None] = field(default_factory=list)
    # Statuses with which the next requests are refused, by their kind.
    trouble: dict[str, list[int]] = field(default_factory=dict)

    def reset(self) -> None:
        self.__dict__.update(FileStore(self.platform).__dict__)

    def routes(self) -> APIRouter:
        router = APIRouter()

        @router.put("/handlers")
        async def handler(request: Request) -> Response:
            if refused := self._refused(request, "noticehandlers"):
                return refused
            body = await request.json()
            self.handlers[body["notice_type"]] = body["handler"]
            return JSONResponse(body)

        @router.get("/assets/{name}")
        async def asset(request: Request, name: str) -> Response:
            if refused := self._refused(request, "asset.readonly"):
                return refused
            if self.other_host is not None:
                return RedirectResponse(self.other_host(name), 302)
            if name not in self.files:
                return Response(status_code=404)
            return Response(self.files[name], media_type="application/octet-stream")

        self._further_routes(router)
        return router

    def _further_routes(self, router: APIRouter) -> None:
        @router.get("/storage/{name}")
        async def storage(request: Request, name: str) -> Response:
            self.elsewhere.append(request.headers.get("authorization"))
            return Response(self.files[name])

        @router.post("/reports")
        async def report(request: Request) -> Response:
            if refused := self._refused(request, "report"):
                return refused
            body = await request.json()
            same = [x for x in self.reports if x["assetId"] == body["assetId"]]
            if any(x["timestamp"] > body["timestamp"] for x in same):
                return Response(status_code=409)
            self.reports.append(body)
            return JSONResponse(body, 201)

    def _refused(self, request: Request, scope: str) -> Response | None:
        if waiting := self.trouble.get(scope):
            return Response(status_code=waiting.pop(0))
        text = request.headers.get("authorization", "").removeprefix("Bearer ")
        known, until = self.platform.gradebook.tokens.get(text, (set(), None))
        if f"{SCOPE}{scope}" not in known or (until and until <= self.platform.gradebook.now()):
            return Response(status_code=401)
        return None

    def notice(self, *names: str, user: str = "ada", notice: str = "notice-1") -> dict[str, Any]:
        from tests.lti.platform import CLIENT, DEPLOYMENT

        address, now = self.platform.address, int(time.time())
        return {
            "iss": address,
            "aud": CLIENT,
            "azp": CLIENT,
            "iat": now,
            "exp": now + 3600,
            "nonce": f"nonce of {notice}",
            f"{LTI}version": "1.3.0",
            f"{LTI}deployment_id": DEPLOYMENT,
            f"{LTI}notice": {
                "id": notice,
                "timestamp": "2026-11-27T08:00:00Z",
                "type": "LtiAssetProcessorSubmissionNotice",
            },
            f"{LTI}custom": {"exercise": "planar-rr=10", "locale": "de"},
            f"{LTI}context": {"id": "course-1"},
            f"{LTI}for_user": {"user_id": f"user {user}"},
            f"{LTI}activity": {"id": "activity-1"},
            f"{LTI}submission": {"id": f"submission of {user}"},
            f"{LTI}assetreport": {"scope": [f"{SCOPE}report"], "report_url": f"{address}/reports"},
            f"{LTI}assetservice": {
                "scope": [f"{SCOPE}asset.readonly"],
                "assets": [self._asset(name) for name in names],
            },
        }

    def _asset(self, name: str) -> dict[str, Any]:
        data = self.files.get(name, b"")
        digest = hashlib.sha256(data).digest()
        return {
            "asset_id": f"id of {name}",
            "url": f"{self.platform.address}/assets/{name}",
            "sha256_checksum": base64.b64encode(digest).decode(),
            "timestamp": "2026-11-27T07:59:59Z",
            "size": len(data),
            "content_type": "text/csv",
            "title": "Homework",
            "filename": name,
        }
