"""A response that is in memory and sent piece by piece."""

from typing import Final

from starlette.responses import Response
from starlette.types import Receive, Scope, Send

# Bytes that are handed to the server at once.
_PIECE: Final = 16 * 1024


class PiecewiseResponse(Response):
    """A file that is in memory, sent piece by piece: whoever does not read it holds one piece."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:  # noqa: ARG002
        """Serve one ASGI connection."""
        start = {"status": self.status_code, "headers": self.raw_headers}
        await send({"type": "http.response.start", **start})
        for i in range(0, max(1, len(self.body)), _PIECE):
            piece, more = self.body[i : i + _PIECE], i + _PIECE < len(self.body)
            await send({"type": "http.response.body", "body": piece, "more_body": more})
