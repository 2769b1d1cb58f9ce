"""uvicorn's HTTP/1.1 protocol with limits, which gets one request at a time."""

# uvicorn's own protocol reads a head of any size, waits for the end of the head without a time
# limit, and continues to read while a pipeline of requests is being answered.

import asyncio
import re
import socket
import struct
import sys
from email.utils import formatdate
from typing import Any, Final

import httptools
from starlette.datastructures import Headers
from starlette.types import Receive, Scope, Send
from uvicorn.config import Config
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol, RequestResponseCycle
from uvicorn.server import ServerState

from service.access.client_key import client_key
from service.api.http.problems import ProblemError
from service.api.http.request_context import end_request
from service.regex import regex
from service.server.connections.early_cors import origin_in
from service.server.connections.flow import LingeringTransport, Valve
from service.server.connections.framing import Framing
from service.server.connections.guarded_state import GuardedState
from service.server.connections.open_connections import OpenConnections
from service.server.limits import (
    HEAD_TIMEOUT,
    HEALTH,
    LINGER,
    MAX_DISCARDED,
    MAX_UNREAD,
    TIMEOUT,
)
from service.server.refusals import late, malformed, too_busy
from service.submissions.strict_json import MAX_BODY_SIZE

# A server may ignore an Upgrade header (RFC 9110, 7.8). The parser would stop at it.
_UPGRADE: Final = regex(rb"\r\n(?=upgrade:)", re.IGNORECASE)
_HOST: Final = regex(rb"\r\nhost[ \t]*:", re.IGNORECASE)
# The parser accepts thousands of leading zeros; int() refuses more than 4,300 digits.
_LONG_LENGTH: Final = regex(rb"\r\ncontent-length:[ \t]*[0-9]{20}", re.IGNORECASE)
# The value of SO_LINGER with which closing a socket resets the connection: on, for 0 seconds.
_NO_LINGER: Final = struct.pack("hh" if sys.platform == "win32" else "ii", 1, 0)


class GuardedProtocol(HttpToolsProtocol):
    """One connection of a client."""

    server_state: GuardedState
    flow: Valve
    waiting_since: float | None

    def __init__(
        self,
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        _loop: asyncio.AbstractEventLoop | None = None,
    ) -> None:
        super().__init__(config, server_state, app_state, _loop)
        self._framing = Framing()
        self._complete = False
        self._ended = False
        self._finishing = False
        self._stopping = False
        self._discarded = 0
        self._unread = 0
        self._origin = ""
        self.url = b""
        self.address = ""
        self.unfinished = 0
        self._wait(HEAD_TIMEOUT)

    @property
    def open_connections(self) -> OpenConnections:
        """The open connections of this process."""
        return self.server_state.open_connections

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Register the connection, or close it at once if there are too many."""
        super().connection_made(transport)
        self._raw = transport
        transport.set_write_buffer_limits(high=MAX_UNREAD)
        self.flow = Valve(transport)
        self.transport = LingeringTransport(transport, self.finish)  # type: ignore[assignment]
        self.address = client_key(self.client[0]) if self.client else ""
        if not self.open_connections.enter(self, self.loop):
            self.server_state.note_refusal("none")
            transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """Unregister the connection."""
        self.open_connections.leave(self)
        self._finishing = True
        super().connection_lost(exc)

    def eof_received(self) -> bool:  # type: ignore[override]
        """Keep the connection open if a complete request is still to be answered."""
        self._ended = True
        return self._framing.whole and not self._finishing

    def data_received(self, data: bytes) -> None:
        """Take received bytes, and parse those that may be parsed now."""
        if self._finishing:
            self._discarded += len(data)
            if self._discarded > MAX_DISCARDED:
                self._raw.abort()
            return
        # Empty lines before a request do not count as its beginning.
        if not self._framing.begun and self.waiting_since is not None and data.strip(b"\r\n"):
            self._wait(HEAD_TIMEOUT)
        self._framing.receive(data)
        self._advance()

    def _advance(self) -> None:
        framing = self._framing
        try:
            while not framing.whole and not self._finishing:
                piece = framing.piece()
                if piece is None:
                    break
                self._parse(piece)
        except ProblemError as problem:
            self._refuse(problem)
        if self._finishing:
            return
        if not framing.whole:
            self._note_held()
            if self.flow.shut:
                self.flow.release()
            return
        self._note_held()
        if len(framing):
            # The next request of a pipeline waits until this one is answered.
            self.flow.hold()

    def _note_held(self) -> None:
        framing = self._framing
        unfinished = 0 if framing.whole else len(framing) + framing.content
        self.open_connections.set_unfinished(self, unfinished + self._unread)

    def _parse(self, piece: bytes) -> None:
        framing = self._framing
        head = framing.in_head
        if head:
            self._check_head(piece)
        try:
            self.parser.feed_data(_UPGRADE.sub(b"\r\nignored-", piece) if head else piece)
        except (httptools.HttpParserError, httptools.HttpParserUpgrade) as error:
            raise malformed("The request does not follow the rules of HTTP/1.1.") from error
        if head:
            framing.expect_body(self._length())
        if framing.whole != self._complete:
            raise malformed("The end of the request is not clear.")
        if framing.whole and not self._finishing:
            self._arrived()
        elif head and self.waiting_since is not None:
            self.deadline = self.waiting_since + TIMEOUT
        if not framing.whole and self.cycle.response_complete and framing.content > MAX_BODY_SIZE:
            self.finish()

    def _check_head(self, head: bytes) -> None:
        line = head.partition(b"\r\n")[0]
        # The parser also accepts the protocols RTSP and ICE.
        if not line.endswith((b" HTTP/1.0", b" HTTP/1.1")):
            raise malformed("The request line does not end with HTTP/1.1.")
        self._origin = origin_in(head)
        hosts = len(_HOST.findall(head))
        # RFC 9112, 3.2.
        if hosts > 1 or not (hosts or line.endswith(b"0")):
            raise malformed("A request names its host once, in a header Host.")
        if _LONG_LENGTH.search(head):
            raise malformed("The Content-Length has more than 19 digits.")

    def _length(self) -> int | None:
        length = 0
        for name, value in self.scope["headers"]:
            if name == b"transfer-encoding":
                return None
            if name == b"content-length":
                length = int(value)
        return length

    def _path(self) -> str:
        return self.url.partition(b"?")[0].decode("latin-1")

    def _arrived(self) -> None:
        if self.cycle.response_complete:
            self._start_next()
        else:
            self.waiting_since = None
            self.deadline = float("inf")

    def _wait(self, timeout: float) -> None:
        self.waiting_since = self.loop.time()
        self.deadline = self.waiting_since + timeout

    def _start_next(self) -> None:
        self._complete = False
        self._framing.start_next()
        head_has_begun = self._framing.begun and not self.flow.write_paused
        self._wait(HEAD_TIMEOUT if head_has_begun else TIMEOUT)
        if self._stopping or self._ended:
            self.finish()
            return
        if len(self._framing):
            # Other connections come first, and a client that does not read its answers gets no
            # more. The socket is read again when all received bytes have been parsed.
            self.loop.call_soon(self._advance_if_read)
        else:
            self.flow.release()

    def _advance_if_read(self) -> None:
        if self.flow.write_paused:
            self.flow.hold()
            self._note_held()
        elif not self._finishing and not self._framing.whole:
            self._advance()

    # Callbacks of the parser and of the answer.

    def on_headers_complete(self) -> None:
        """Start the application when the head of the request is complete."""
        full = self.open_connections.full and self._path() not in HEALTH
        self.app = self._answer_busy if full else self._answer
        super().on_headers_complete()
        # The application has the list of headers already; trailers are not added to it.
        self.headers = []
        if self._stopping:
            self.cycle.keep_alive = False

    def on_message_complete(self) -> None:
        """Note that the request is complete."""
        self._complete = True
        super().on_message_complete()

    def on_response_complete(self) -> None:
        """Begin with the next request if the answered request is complete."""
        self.server_state.total_requests += 1
        if self.transport.is_closing() or self._finishing:
            return
        if self._framing.whole:
            self._start_next()
        elif self._framing.content > MAX_BODY_SIZE:
            self.finish()
        else:
            self.flow.resume_reading()

    def pause_writing(self) -> None:
        """Start a time limit, because the client does not read responses."""
        super().pause_writing()
        self._unread = self._raw.get_write_buffer_size()
        if self.waiting_since is None:
            self._wait(TIMEOUT)
        self._note_held()

    def resume_writing(self) -> None:
        """Stop the time limit, because the client reads responses again."""
        super().resume_writing()
        self._unread = 0
        self._note_held()
        if self._finishing:
            return
        if self._framing.whole:
            self.waiting_since = None
            self.deadline = float("inf")
        elif len(self._framing):
            self.loop.call_soon(self._advance_if_read)

    # Closing.

    def _refuse(self, problem: ProblemError) -> None:
        if self._give_up() and self.cycle.response_started:
            self.reset()
            return
        path = "" if self._framing.in_head else self._path()
        origin = origin_in(framing.pending) if (framing := self._framing).in_head else self._origin
        answer = self.server_state.refusal(problem, path, origin)
        date = formatdate(usegmt=True).encode()
        headers = [(b"date", date), (b"x-content-type-options", b"nosniff"), *answer.raw_headers]
        lines = [f"HTTP/1.1 {problem.status.value} {problem.status.phrase}".encode()]
        lines += [name + b": " + value for name, value in headers]
        self._raw.write(b"\r\n".join([*lines, b"", bytes(answer.body)]))
        if self.access_log:
            peer = "{}:{}".format(*self.client) if self.client else ""
            values = (peer, "-", path or "-", "1.1", problem.status.value)
            self.access_logger.info('%s - "%s %s HTTP/%s" %d', *values)
        end_request()
        self.finish()

    def finish(self) -> None:
        """Close the connection as soon as the client has received the response."""
        if self._finishing:
            return
        self._finishing = True
        now = self.loop.time()
        self.waiting_since = now
        framing = self._framing
        if not len(framing) and (framing.whole or not framing.begun):
            self.deadline = now + TIMEOUT
            self._raw.close()
            return
        # Closing a connection that has unread bytes resets it, and the client loses the answer.
        self.deadline = now + LINGER
        self.flow.release()
        if self._raw.can_write_eof():
            self._raw.write_eof()

    def expire(self) -> None:
        """Close the connection because a time limit has passed."""
        unread = self._raw.get_write_buffer_size() > 0
        if self._finishing or unread or self.waiting_since is None:
            self.reset()
        elif self._framing.begun:
            self._refuse(late())
        else:
            self._finishing = True
            self._raw.close()

    def reset(self) -> None:
        """Close the connection at once; unsent bytes are lost."""
        self._finishing = True
        self.open_connections.leave(self)
        connection = self._raw.get_extra_info("socket")
        if connection is not None and (self._framing.begun or self._raw.get_write_buffer_size()):
            # A reset tells the client that no answer comes, and the system frees its buffers.
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _NO_LINGER)
        self._give_up()
        self._raw.abort()

    def _give_up(self) -> bool:
        # uvicorn's annotation omits that this is None before the first request.
        cycle: RequestResponseCycle | None = self.cycle
        if cycle is None or cycle.response_complete:
            return False
        cycle.disconnected = True
        cycle.message_event.set()
        return True

    def shutdown(self) -> None:
        """Accept no further request, but answer a request whose head has been read."""
        self._stopping = True
        if self._framing.in_head:
            if self._raw.get_write_buffer_size():
                self.finish()
            else:
                self.reset()
        else:
            self.cycle.keep_alive = False

    async def _answer(self, scope: Scope, receive: Receive, send: Send) -> None:
        try:
            await self.config.loaded_app(scope, receive, send)
        except asyncio.CancelledError:
            # The process ends, and all connections have been closed: this is no error.
            if not self._finishing:
                raise

    async def _answer_busy(self, scope: Scope, receive: Receive, send: Send) -> None:
        headers = Headers(scope=scope)
        answer = self.server_state.refusal(too_busy(1), scope["path"], self._origin, headers)
        await answer(scope, receive, send)
