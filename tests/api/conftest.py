import asyncio
from collections.abc import Iterator, Mapping
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.catalogue import Exercise
from fastapi import FastAPI


class InProcess(httpx.BaseTransport):
    """Connects an httpx.Client to an app in this process."""

    def __init__(self, app: FastAPI) -> None:
        self._inner = httpx.ASGITransport(app, raise_app_exceptions=False)

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        request.read()
        return asyncio.run(self._answer(request))

    async def _answer(self, request: httpx.Request) -> httpx.Response:
        response = await self._inner.handle_async_request(request)
        content = await response.aread()
        # The content is already decompressed.
        headers = [each for each in response.headers.multi_items() if each[0] != "content-encoding"]
        return httpx.Response(response.status_code, headers=headers, content=content)


@pytest.fixture(scope="session")
def app(catalogue: Mapping[str, Exercise]) -> FastAPI:
    return application(catalogue)


@pytest.fixture(scope="session")
def client(app: FastAPI) -> Iterator[httpx.Client]:
    with httpx.Client(transport=InProcess(app), base_url="http://service") as client:
        yield client


@pytest.fixture
def client_of() -> Any:
    return lambda app: httpx.Client(transport=InProcess(app), base_url="http://service")
