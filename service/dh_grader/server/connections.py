"""uvicorn's protocol with limits: open connections, framing, flow, and early refusals.

It knows bytes and connections, and no routes but those of health checks. How complete requests
take turns is in ``turns.py``.
"""

import asyncio
import re
import socket
import struct
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from email.utils import formatdate
from enum import Enum, auto
from http import HTTPStatus
from typing import Any, Final, Protocol

import httptools
from fastapi import Response
from starlette.datastructures import Headers
from starlette.types import Receive, Scope, Send
from uvicorn.config import Config
from uvicorn.protocols.http.flow_control import FlowControl
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol, RequestResponseCycle
from uvicorn.server import ServerState

from dh_grader.access import client_key
from dh_grader.api.application import EXPOSED_HEADERS
from dh_grader.api.http import HEADER, Monitor, ProblemError, begin_request, end_request
from dh_grader.regex import regex
from dh_grader.submissions.bodies import MAX_BODY_SIZE
from dh_grader.translations import say

# --- The limits that one process sets for its clients


# Bytes of a request other than its content: the head, the sizes of chunks, the trailers. Browsers
# send 1 to 4 kB, proxies with large cookies 16.
MAX_FRAME: Final = 64 * 1024
# The longest address of this service has less than 200 characters.
MAX_URL: Final = 8 * 1024
MAX_HEADERS: Final = 100

# Seconds from the first byte of a request to its last, until the client reads an answer, and
# between two requests of a connection. 256 KiB in 30 s is 9 kB/s, which the slowest mobile line
# reaches.
TIMEOUT: Final = 30.0
# Seconds from the opening of a connection to the first byte of its first request, and from the
# first byte of a head to its last. A head is one packet or a few.
HEAD_TIMEOUT: Final = 10.0
# Seconds for a client that was refused while it was still sending to read the refusal.
LINGER: Final = 2.0
# Bytes of such a client that are read and discarded meanwhile.
MAX_DISCARDED: Final = 2 * 1024 * 1024
# Seconds between two checks for connections whose time is over.
SWEEP: Final = 0.5

# About 20 kB of memory each. Beyond this number, connections without a whole request are closed.
MAX_CONNECTIONS: Final = 1000
# Additional connections for health checks, while all others are being answered.
RESERVE: Final = 32
# Files that the program may have open besides its connections.
OTHER_FILES: Final = 64
# Unsent bytes of an answer after which the application is paused. The unsent bytes of a longer
# answer count towards the limit of unfinished requests.
MAX_UNREAD: Final = 16 * 1024
# Bytes of unfinished requests and of unread answers, in all connections together.
MAX_UNFINISHED: Final = 32 * 1024 * 1024

# Seconds from the signal to end until unfinished answers are given up.
GRACE: Final = 8.0
# Seconds after that until the process exits, even if a thread is still running.
FORCED_EXIT: Final = 1.3
# The paths of health checks, which are answered without waiting for a turn.
HEALTH: Final = frozenset({"/healthz", "/readyz"})


# --- The state that all connections of a server share


class GuardedState(ServerState):
    """The state that all connections of a server share.

    Web pages of ``origins`` may read the responses to refused requests.
    """

    def __init__(self, origins: Sequence[str] = (), monitor: Monitor | None = None) -> None:
        super().__init__()
        self.open_connections = OpenConnections(allowed_here())
        self._origins = origins
        self._monitor = monitor

    def note_refusal(self, answer: str) -> None:
        """Count a refused request; ``answer`` is the status code of the response, or "none"."""
        if self._monitor is not None:
            self._monitor.refused(answer)

    def refusal(
        self, problem: ProblemError, path: str, origin: str, headers: Headers | None = None
    ) -> Response:
        """Count a refused request from a page of ``origin``, and return the error response."""
        self.note_refusal(str(problem.status.value))
        answer = refusal_response(problem, path, headers)
        answer.headers.update(cors_headers(self._origins, origin))
        return answer


# --- uvicorn's HTTP/1.1 protocol with limits, which gets one request at a time
#
# uvicorn's own protocol reads a head of any size, waits for the end of the head without a time
# limit, and continues to read while a pipeline of requests is being answered.


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
    flow: "Valve"
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
    def open_connections(self) -> "OpenConnections":
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


# --- The open connections of one process, with limits for their number and their bytes
#
# Beyond a limit, the process closes connections that have no complete request.


# One connection in 16 is closed at once, so that choosing them costs little for each.
_CLOSED_SHARE: Final = 16


class OpenConnection(Protocol):
    """The interface of a connection that ``OpenConnections`` uses."""

    address: str
    # The time of the event loop at which the connection expires.
    deadline: float
    # The time since which it waits for its client; None while a request is being answered.
    waiting_since: float | None
    # Bytes of an unfinished request and of unread answers.
    unfinished: int

    def expire(self) -> None:
        """Close the connection because its time limit has passed."""

    def reset(self) -> None:
        """Close the connection at once."""


@dataclass(frozen=True, slots=True)
class ConnectionLimits:
    """The largest number of connections, and of bytes in their unfinished requests."""

    connections: int = MAX_CONNECTIONS
    unfinished: int = MAX_UNFINISHED


class OpenConnections:
    """The connections of one process."""

    def __init__(self, limits: ConnectionLimits) -> None:
        self._limits = limits
        self._connections: dict[OpenConnection, None] = {}
        self._unfinished = 0
        self._sweeping: asyncio.TimerHandle | None = None

    def __len__(self) -> int:
        """The number of connections."""
        return len(self._connections)

    @property
    def full(self) -> bool:
        """True if there are too many connections."""
        # The service then answers only health checks.
        return len(self._connections) > self._limits.connections

    def enter(self, connection: OpenConnection, loop: asyncio.AbstractEventLoop) -> bool:
        """Add a connection; return False if there are too many."""
        # Waiting connections are closed first.
        if len(self._connections) >= self._limits.connections:
            self._close_waiting(lambda _: 1, 1 + self._limits.connections // _CLOSED_SHARE)
        if len(self._connections) >= self._limits.connections + RESERVE:
            return False
        self._connections[connection] = None
        if self._sweeping is None:
            self._sweeping = loop.call_later(SWEEP, self._sweep, loop)
        return True

    def leave(self, connection: OpenConnection) -> None:
        """Remove a connection."""
        if connection in self._connections:
            del self._connections[connection]
            self._unfinished -= connection.unfinished
            connection.unfinished = 0

    def set_unfinished(self, connection: OpenConnection, size: int) -> None:
        """Set the size of a connection's unfinished request; limit the sum of all sizes."""
        if connection not in self._connections:
            return
        self._unfinished += size - connection.unfinished
        connection.unfinished = size
        if self._unfinished > self._limits.unfinished:
            excess = self._unfinished - self._limits.unfinished
            wanted = excess + self._limits.unfinished // 4
            self._close_waiting(lambda each: each.unfinished, wanted)

    def _close_waiting(self, weight: Callable[[OpenConnection], int], wanted: int) -> None:
        waiting = [
            each for each in self._connections if each.waiting_since is not None and weight(each)
        ]
        shares: Counter[str] = Counter()
        for connection in waiting:
            shares[connection.address] += weight(connection)
        for connection in closing_order(waiting, shares, weight):
            if wanted <= 0:
                break
            wanted -= weight(connection)
            self.leave(connection)
            connection.reset()

    def _sweep(self, loop: asyncio.AbstractEventLoop) -> None:
        now = loop.time()
        for connection in [each for each in self._connections if each.deadline < now]:
            connection.expire()
        self._sweeping = loop.call_later(SWEEP, self._sweep, loop) if self._connections else None


def closing_order(
    waiting: Iterable[OpenConnection], shares: Counter[str], weight: Callable[[OpenConnection], int]
) -> Iterable[OpenConnection]:
    """Yield waiting connections in the order in which to close them.

    The address with the most connections or bytes comes first.
    """
    queues: dict[str, list[OpenConnection]] = {}
    for connection in sorted(waiting, key=lambda each: each.waiting_since or 0.0, reverse=True):
        queues.setdefault(connection.address, []).append(connection)
    while queues:
        address = max(queues, key=shares.__getitem__)
        connection = queues[address].pop()
        shares[address] -= weight(connection)
        if not queues[address]:
            del queues[address]
        yield connection


def allowed_here() -> ConnectionLimits:
    """Raise the limit of open files, and return the connection limits that result from it."""
    try:
        import resource
    except ImportError:  # Windows, which has no such limit
        return ConnectionLimits()
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = MAX_CONNECTIONS + RESERVE + OTHER_FILES
    if soft != resource.RLIM_INFINITY and soft < wanted:
        soft = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
        return ConnectionLimits(
            connections=max(1, min(MAX_CONNECTIONS, soft - RESERVE - OTHER_FILES))
        )
    return ConnectionLimits()


# --- Cut the bytes of a connection into pieces that each belong to one request
#
# The parser gets one piece at a time. ``Framing`` only finds where the pieces end (RFC 9112); the
# parser decides whether they are valid.
#
# The parser reads all bytes that it gets, stores a head of any size, and begins the next request of
# a pipeline before the previous one is answered. So it gets only what it should read now.


_END: Final = b"\r\n"
_BARE_NEWLINE: Final = regex(rb"(?<!\r)\n")
_CHUNK_SIZE: Final = regex(rb"([0-9A-Fa-f]{1,8})[ \t]*(?:;.*)?")
# The least number of bytes that a line of a chunked body counts: even a short line costs work.
_LEAST_LINE: Final = 64
# The bytes of a body or chunk that are passed on at once; fewer only at its end. Each piece wakes
# the task of its request, which costs much more than to keep a byte of a slow client.
_PART: Final = 16 * 1024
# The most bytes of a request line besides its address: the method and the version.
_REST_OF_LINE: Final = 64


class _Expected(Enum):
    HEAD = auto()
    BODY = auto()
    CHUNK_SIZE = auto()
    CHUNK = auto()
    TRAILERS = auto()


class Framing:
    """Cuts the bytes of one connection into pieces that each belong to one request.

    ``whole`` is True after the last piece of a request.  ``content`` is the number of bytes of the
    request's body so far.
    """

    def __init__(self) -> None:
        self._buffer = bytearray()
        self._expected = _Expected.HEAD
        # Bytes still missing from the body, or from a chunk and its line end.
        self._left = 0
        # Bytes of the request that are not content.
        self._overhead = 0
        self._searched = 0
        self.content = 0
        self.whole = False

    def __len__(self) -> int:
        return len(self._buffer)

    @property
    def pending(self) -> bytes:
        """The received bytes that have not been returned yet."""
        return bytes(self._buffer)

    @property
    def begun(self) -> bool:
        """True if any byte of a request has been received."""
        return self._expected is not _Expected.HEAD or len(self._buffer) > 0

    @property
    def in_head(self) -> bool:
        """True until the head of the request has been returned."""
        return self._expected is _Expected.HEAD and not self.whole

    def receive(self, data: bytes) -> None:
        """Add received bytes."""
        self._buffer += data

    def start_next(self) -> None:
        """Begin with the next request of the connection."""
        self._expected, self._overhead, self._searched = _Expected.HEAD, 0, 0
        self.content, self.whole = 0, False

    def expect_body(self, length: int | None) -> None:
        """Set the length of the body that follows the head; None if the body is chunked."""
        if length is None:
            self._expected = _Expected.CHUNK_SIZE
        else:
            self._expected, self._left = _Expected.BODY, length
            self.whole = length == 0

    def piece(self) -> bytes | None:
        """Return the next bytes of the request, or None if more must be received first.

        Raises ProblemError.
        """
        match self._expected:
            case _Expected.HEAD:
                return self._head()
            case _Expected.BODY:
                piece = self._part_of_body()
                self.whole = self._left == 0
            case _Expected.CHUNK_SIZE:
                return self._chunk_size()
            case _Expected.CHUNK:
                piece = self._part_of_body()
                if self._left == 0:
                    self._expected = _Expected.CHUNK_SIZE
            case _:
                piece = self._line()
                self.whole = piece == _END
        return piece

    def _head(self) -> bytes | None:
        pending = self._buffer
        if not pending[:2].strip(b"\r\n"):
            # Empty lines before a request are ignored.
            self._count_overhead(len(pending) - len(pending.lstrip(b"\r\n")))
            self._buffer = pending = pending.lstrip(b"\r\n")
        if pending and not 65 <= pending[0] <= 90:
            raise malformed("The request does not begin with a method, such as GET.")
        end = pending.find(b"\r\n\r\n", max(self._searched - 3, 0))
        if _BARE_NEWLINE.search(pending, self._searched, len(pending) if end < 0 else end):
            raise malformed("A line of the head ends without a carriage return.")
        self._searched = len(pending)
        size = len(pending) if end < 0 else end + 4
        self._check_line(pending[: MAX_URL + _REST_OF_LINE + 1])
        if self._overhead + size > MAX_FRAME:
            raise large_frame("The head of a request may hold 64 kB; this one is larger.")
        if end < 0:
            return None
        if pending.count(_END, 0, end + 2) > MAX_HEADERS + 1:
            raise too_many_headers()
        self._count_overhead(size)
        return self._take(size)

    def _check_line(self, begin: bytearray) -> None:
        line, found, _ = begin.partition(_END)
        too_long = len(line) > MAX_URL + _REST_OF_LINE if not found else False
        if too_long or max(map(len, line.split(b" ")), default=0) > MAX_URL:
            raise long_address()

    def _chunk_size(self) -> bytes | None:
        line = self._line()
        if line is None:
            return None
        size = _CHUNK_SIZE.fullmatch(line[:-2])
        if size is None:
            raise malformed("The size of a chunk is no hexadecimal number.")
        self._left = int(size[1], 16)
        if self._left:
            self._left += len(_END)
            self._expected = _Expected.CHUNK
        else:
            self._expected = _Expected.TRAILERS
        return line

    def _line(self) -> bytes | None:
        end = self._buffer.find(_END, max(self._searched - 1, 0))
        size = len(self._buffer) if end < 0 else end + 2
        if self._overhead + size > MAX_FRAME:
            raise large_frame("Sizes of chunks and trailers may hold 64 kB; these are larger.")
        if end < 0:
            self._searched = size
            return None
        self._count_overhead(max(size, _LEAST_LINE))
        return self._take(size)

    def _part_of_body(self) -> bytes | None:
        if len(self._buffer) < min(self._left, _PART):
            return None
        piece = self._take(min(self._left, len(self._buffer)))
        self._left -= len(piece)
        self.content += len(piece)
        return piece or None

    def _take(self, size: int) -> bytes:
        piece = bytes(self._buffer[:size])
        del self._buffer[:size]
        self._searched = 0
        return piece

    def _count_overhead(self, size: int) -> None:
        self._overhead += size


# --- Flow control: when a connection reads, and how it closes


class LingeringTransport:
    """A transport whose ``close`` lets the client read the last response first."""

    def __init__(self, transport: asyncio.Transport, finish: Any) -> None:
        self._transport = transport
        self.close = finish

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)


class Valve(FlowControl):
    """Flow control that keeps reading paused from ``hold`` to ``release``."""

    # uvicorn cannot resume it while the next request has to wait.

    shut = False

    def resume_reading(self) -> None:
        """Resume reading, unless ``hold`` has paused it."""
        if not self.shut:
            super().resume_reading()

    def hold(self) -> None:
        """Pause reading until ``release``."""
        self.shut = True
        self.pause_reading()

    def release(self) -> None:
        """Resume reading."""
        self.shut = False
        self.resume_reading()


# --- Requests that are refused before they reach the application: errors and CORS headers


_CLOSE: Final = {"Connection": "close"}
_ORIGIN: Final = regex(rb"\r\nOrigin:[ \t]*([^\r\n]*?)[ \t]*\r\n", re.IGNORECASE)


def refusal_response(problem: ProblemError, path: str, headers: Headers | None = None) -> Response:
    """Return the error response to a request that does not reach the application.

    ``headers`` are the request's headers, or None if they have not been read.
    """
    request = begin_request(headers.get(HEADER) if headers else None)
    answer = problem.response(path)
    answer.headers[HEADER] = request.id
    return answer


def malformed(detail: str) -> ProblemError:
    """Return the error for bytes that are no HTTP request."""
    title = "This is no HTTP request"
    return ProblemError(HTTPStatus.BAD_REQUEST, detail, "malformed-request", title, headers=_CLOSE)


def late() -> ProblemError:
    """Return the error for a request that did not arrive in time."""
    detail = (
        f"The head of a request must arrive within {HEAD_TIMEOUT:.0f} seconds, and the whole "
        f"request within {TIMEOUT:.0f}."
    )
    return ProblemError(HTTPStatus.REQUEST_TIMEOUT, detail, headers=_CLOSE)


def long_address() -> ProblemError:
    """Return the error for a URL that is too long."""
    detail = f"An address may have {MAX_URL} characters; this one has more."
    return ProblemError(HTTPStatus.REQUEST_URI_TOO_LONG, detail, headers=_CLOSE)


def too_many_headers() -> ProblemError:
    """Return the error for a request with too many headers."""
    return large_frame(f"A request may have {MAX_HEADERS} headers; this one has more.")


def large_frame(detail: str) -> ProblemError:
    """Return the error for a head, chunk size or trailer that is too large."""
    return ProblemError(HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE, detail, headers=_CLOSE)


def too_many(seconds: int) -> ProblemError:
    """Return the error for a client that has too many requests waiting."""
    return ProblemError(
        HTTPStatus.TOO_MANY_REQUESTS,
        say(
            "Too many requests from this address are waiting already. Wait, then send this one "
            "again."
        ),
        headers={"Retry-After": str(seconds)},
    )


def too_busy(seconds: int) -> ProblemError:
    """Return the error for a service that has too much to do."""
    return ProblemError(
        HTTPStatus.SERVICE_UNAVAILABLE,
        say("The service has too much to do. Wait, then send this request again."),
        headers={"Retry-After": str(seconds)},
    )


def origin_in(head: bytes) -> str:
    """Return the origin in a request's head, or "". The head may be incomplete or invalid."""
    found = _ORIGIN.search(head)
    return found[1].decode("latin-1") if found else ""


def cors_headers(origins: Sequence[str], origin: str) -> Mapping[str, str]:
    """Return the headers that allow a page of ``origin`` to read the response."""
    # ``origin`` is "" if the request was refused before its head was read. In this case, the only
    # entry of ``origins`` is used, if there is only one.
    if "*" in origins:
        allowed = "*"
    elif origin in origins:
        allowed = origin
    elif not origin and len(origins) == 1:
        allowed = origins[0]
    else:
        return {}
    return {
        "Access-Control-Allow-Origin": allowed,
        "Access-Control-Expose-Headers": ", ".join(EXPOSED_HEADERS),
        "Vary": "Origin",
    }
