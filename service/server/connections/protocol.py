"""HTTP/1.1 with limits: uvicorn's protocol, fed one request at a time and only as much as it may.

uvicorn's own reads a head of any size, waits for its end for ever, and reads on while a pipeline of
requests is being answered.
"""

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
from service.server.connections.early_cors import origin_in
from service.server.connections.flow import LingeringTransport, Valve
from service.server.connections.framing import Framing
from service.server.connections.guarded_state import GuardedState
from service.server.connections.open_connections import Crowd
from service.server.limits import (
    HEAD_PATIENCE,
    HEALTH,
    LINGER,
    MAX_DISCARDED,
    MAX_UNREAD,
    PATIENCE,
)
from service.server.refusals import late, malformed, too_busy
from service.submissions.strict_json import MAX_BODY_SIZE

# A server may ignore the wish for another protocol (RFC 9110, 7.8). The parser would stop at it.
_UPGRADE: Final = re.compile(rb"\r\n(?=upgrade:)", re.IGNORECASE)
_HOST: Final = re.compile(rb"\r\nhost[ \t]*:", re.IGNORECASE)
# The parser takes zeros before a length by the thousand; int() refuses more than 4,300 digits.
_LONG_LENGTH: Final = re.compile(rb"\r\ncontent-length:[ \t]*[0-9]{20}", re.IGNORECASE)
# Whether to linger, and for how many seconds: a close is then a reset.
_AT_ONCE: Final = struct.pack("hh" if sys.platform == "win32" else "ii", 1, 0)


class GuardedProtocol(HttpToolsProtocol):
    """One connection."""

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
        self._wait(HEAD_PATIENCE)

    @property
    def crowd(self) -> Crowd:
        """All connections of this process."""
        return self.server_state.crowd

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin, or hang up at once where there is no room."""
        super().connection_made(transport)
        self._raw = transport
        transport.set_write_buffer_limits(high=MAX_UNREAD)
        self.flow = Valve(transport)
        self.transport = LingeringTransport(transport, self.finish)  # type: ignore[assignment]
        self.address = client_key(self.client[0]) if self.client else ""
        if not self.crowd.enter(self, self.loop):
            self.server_state.note_refusal("none")
            transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """End."""
        self.crowd.leave(self)
        self._finishing = True
        super().connection_lost(exc)

    def eof_received(self) -> bool:  # type: ignore[override]
        """Answer what has come whole; the client sends no more, but may listen."""
        self._ended = True
        return self._framing.whole and not self._finishing

    def data_received(self, data: bytes) -> None:
        """Take what has come."""
        if self._finishing:
            self._discarded += len(data)
            if self._discarded > MAX_DISCARDED:
                self._raw.abort()
            return
        # Empty lines before a request do not begin it.
        if not self._framing.begun and self.waiting_since is not None and data.strip(b"\r\n"):
            self._wait(HEAD_PATIENCE)
        self._framing.receive(data)
        self._advance()

    def _advance(self) -> None:
        """Give the parser what it may read now."""
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
        """Tell the crowd how many bytes are kept because the client does not get on."""
        framing = self._framing
        unfinished = 0 if framing.whole else len(framing) + framing.content
        self.crowd.hold(self, unfinished + self._unread)

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
            self.deadline = self.waiting_since + PATIENCE
        if not framing.whole and self.cycle.response_complete and framing.content > MAX_BODY_SIZE:
            self.finish()

    def _check_head(self, head: bytes) -> None:
        """Refuse a head that the parser would accept or fail on. Raises ProblemError."""
        line = head.partition(b"\r\n")[0]
        # The parser also accepts RTSP and ICE.
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
        """How long the body is by the head, which the parser has found right."""
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
        """A request has come whole. From now on, the client waits for this process."""
        if self.cycle.response_complete:
            self._go_on()
        else:
            self.waiting_since = None
            self.deadline = float("inf")

    def _wait(self, patience: float) -> None:
        """Wait for the client from now on, for so many seconds at most."""
        self.waiting_since = self.loop.time()
        self.deadline = self.waiting_since + patience

    def _go_on(self) -> None:
        """Turn to the next request of this connection."""
        self._complete = False
        self._framing.start_next()
        head_has_begun = self._framing.begun and not self.flow.write_paused
        self._wait(HEAD_PATIENCE if head_has_begun else PATIENCE)
        if self._stopping or self._ended:
            self.finish()
            return
        if len(self._framing):
            # Others come first, and whoever does not read answers gets none. Nothing more is read
            # until what has come is used up.
            self.loop.call_soon(self._advance_if_read)
        else:
            self.flow.release()

    def _advance_if_read(self) -> None:
        if self.flow.write_paused:
            self.flow.hold()
            self._note_held()
        elif not self._finishing and not self._framing.whole:
            self._advance()

    # What the parser and the answer call.

    def on_headers_complete(self) -> None:
        """Begin with the answer."""
        full = self.crowd.full and self._path() not in HEALTH
        self.app = self._no_room if full else self._answered
        super().on_headers_complete()
        # What stands behind the body says nothing to the application, which has the list before.
        self.headers = []
        if self._stopping:
            self.cycle.keep_alive = False

    def on_message_complete(self) -> None:
        """Note that the request is whole."""
        self._complete = True
        super().on_message_complete()

    def on_response_complete(self) -> None:
        """Go on, where the request has been read to its end."""
        self.server_state.total_requests += 1
        if self.transport.is_closing() or self._finishing:
            return
        if self._framing.whole:
            self._go_on()
        elif self._framing.content > MAX_BODY_SIZE:
            self.finish()
        else:
            self.flow.resume_reading()

    def pause_writing(self) -> None:
        """The client does not read its answers: from now on, this process waits for it."""
        super().pause_writing()
        self._unread = self._raw.get_write_buffer_size()
        if self.waiting_since is None:
            self._wait(PATIENCE)
        self._note_held()

    def resume_writing(self) -> None:
        """The client reads."""
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

    # Ends.

    def _refuse(self, problem: ProblemError) -> None:
        """Answer what is no request, or none that may be sent, and hang up."""
        if self._give_up() and self.cycle.response_started:
            self.reset()
            return
        path = "" if self._framing.in_head else self._path()
        origin = origin_in(framing.came) if (framing := self._framing).in_head else self._origin
        answer = self.server_state.refusal(problem, path, origin)
        date = formatdate(usegmt=True).encode()
        headers = [(b"date", date), (b"x-content-type-options", b"nosniff"), *answer.raw_headers]
        lines = [f"HTTP/1.1 {problem.status.value} {problem.status.phrase}".encode()]
        lines += [name + b": " + value for name, value in headers]
        self._raw.write(b"\r\n".join([*lines, b"", bytes(answer.body)]))
        if self.access_log:
            peer = "{}:{}".format(*self.client) if self.client else ""
            said = (peer, "-", path or "-", "1.1", problem.status.value)
            self.access_logger.info('%s - "%s %s HTTP/%s" %d', *said)
        end_request()
        self.finish()

    def finish(self) -> None:
        """Hang up as soon as the client has had the answer."""
        if self._finishing:
            return
        self._finishing = True
        now = self.loop.time()
        self.waiting_since = now
        framing = self._framing
        if not len(framing) and (framing.whole or not framing.begun):
            self.deadline = now + PATIENCE
            self._raw.close()
            return
        # A connection that is closed while it has unread bytes is reset, and the answer with it.
        self.deadline = now + LINGER
        self.flow.release()
        if self._raw.can_write_eof():
            self._raw.write_eof()

    def expire(self) -> None:
        """End what has lasted too long: a request, an answer that nobody takes, an idle line."""
        unread = self._raw.get_write_buffer_size() > 0
        if self._finishing or unread or self.waiting_since is None:
            self.reset()
        elif self._framing.begun:
            self._refuse(late())
        else:
            self._finishing = True
            self._raw.close()

    def reset(self) -> None:
        """Hang up at once; what has not been sent is lost."""
        self._finishing = True
        self.crowd.leave(self)
        connection = self._raw.get_extra_info("socket")
        if connection is not None and (self._framing.begun or self._raw.get_write_buffer_size()):
            # The client is told that it has no answer, and the system keeps nothing of it.
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _AT_ONCE)
        self._give_up()
        self._raw.abort()

    def _give_up(self) -> bool:
        """Tell the application, if it is at work on an answer, that nobody will read it."""
        # uvicorn's annotation leaves out that there is none before the first request.
        cycle: RequestResponseCycle | None = self.cycle
        if cycle is None or cycle.response_complete:
            return False
        cycle.disconnected = True
        cycle.message_event.set()
        return True

    def shutdown(self) -> None:
        """Take no further request; one whose head has come is answered."""
        self._stopping = True
        if self._framing.in_head:
            if self._raw.get_write_buffer_size():
                self.finish()
            else:
                self.reset()
        else:
            self.cycle.keep_alive = False

    async def _answered(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Have the application answer."""
        try:
            await self.config.loaded_app(scope, receive, send)
        except asyncio.CancelledError:
            # At the end of the process, when all have been hung up on: no failure of the program.
            if not self._finishing:
                raise

    async def _no_room(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer while as many connections as there is room for are being answered."""
        headers = Headers(scope=scope)
        answer = self.server_state.refusal(too_busy(1), scope["path"], self._origin, headers)
        await answer(scope, receive, send)
