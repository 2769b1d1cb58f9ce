"""Call the routes of the service in this process, without a socket."""

import asyncio
import sys
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from dh_grader.api.application import application
from dh_grader.catalogue import Exercise

from tests.shipped import shipped_exercises


class Post(NamedTuple):
    """A POST request: its path and its body."""

    path: str
    body: bytes


class Reply(NamedTuple):
    """The status and the body of a response."""

    status: int
    body: bytes


class InProcess:
    """Calls the application in this process, on an event loop of its own."""

    def __init__(self) -> None:
        self.catalogue = shipped_exercises()
        self._app = application(self.catalogue)
        self._loop = asyncio.new_event_loop()

    def close(self) -> None:
        self._loop.close()

    def post(self, post: Post) -> Reply:
        return self._loop.run_until_complete(self._answer(post))

    async def _answer(self, post: Post) -> Reply:
        scope = {
            "type": "http",
            "asgi": {"version": "3.0"},
            "http_version": "1.1",
            "method": "POST",
            "scheme": "http",
            "path": post.path,
            "raw_path": post.path.encode(),
            "query_string": b"",
            "root_path": "",
            "headers": [
                (b"host", b"localhost"),
                (b"content-type", b"application/json"),
                (b"content-length", str(len(post.body)).encode()),
            ],
            "client": ("127.0.0.1", 1),
            "server": ("127.0.0.1", 80),
        }
        messages = [{"type": "http.request", "body": post.body, "more_body": False}]
        status, parts = 0, []

        async def receive() -> dict[str, Any]:
            return messages.pop() if messages else {"type": "http.disconnect"}

        async def send(message: Any) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
            else:
                parts.append(message.get("body", b""))

        await self._app(scope, receive, send)
        return Reply(status, b"".join(parts))


def caches() -> Iterator[Callable[[], None]]:
    known = set()
    for name, module in sorted(sys.modules.items()):
        if name.startswith("dh_grader."):
            for found in vars(module).values():
                for value in found if isinstance(found, list) else [found]:
                    clear = getattr(value, "cache_clear", None)
                    if clear is not None and id(value) not in known:
                        known.add(id(value))
                        yield clear


def grade_path(exercise: Exercise) -> str:
    """Return the path at which answers to an exercise are graded."""
    return f"/v1/exercises/{exercise.id}/grade"
