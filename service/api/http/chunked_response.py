"""A response whose content is in memory and is sent in chunks."""

from typing import Final

from starlette.responses import Response
from starlette.types import Receive, Scope, Send

# Bytes of a chunk.
_PIECE: Final = 16 * 1024


class ChunkedResponse(Response):
    """A response that is sent in chunks; at most one chunk is buffered."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:  # noqa: ARG002
        """Serve one ASGI connection."""
        start = {"status": self.status_code, "headers": self.raw_headers}
        await send({"type": "http.response.start", **start})
        for i in range(0, max(1, len(self.body)), _PIECE):
            piece, more = self.body[i : i + _PIECE], i + _PIECE < len(self.body)
            await send({"type": "http.response.body", "body": piece, "more_body": more})
