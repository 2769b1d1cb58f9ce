"""Cutting what comes in over a connection into pieces that never reach beyond one request.

The parser reads on as long as it is given bytes, remembers a head of any size, and begins the next
request of a pipeline before the last is answered. So it is given no more than it should read. It
alone judges whether the pieces are right: this only looks for where they end (RFC 9112).
"""

import re
from enum import Enum, auto
from typing import Final

from service.server.limits import MAX_FRAME, MAX_HEADERS, MAX_URL
from service.server.refusals import large_frame, long_address, malformed, many_headers

_END: Final = b"\r\n"
_BARE_NEWLINE: Final = re.compile(rb"(?<!\r)\n")
_CHUNK_SIZE: Final = re.compile(rb"([0-9A-Fa-f]{1,8})[ \t]*(?:;.*)?")
# A line of a chunked body counts as this many bytes at least: each costs work, however short it is.
_LEAST_LINE: Final = 64
# Method and version beside the address.
_REST_OF_LINE: Final = 64


class _Expected(Enum):
    HEAD = auto()
    BODY = auto()
    CHUNK_SIZE = auto()
    CHUNK = auto()
    TRAILERS = auto()


class Framing:
    """The requests of one connection, piece by piece; ``whole`` once the last piece is out."""

    def __init__(self) -> None:
        self._came = bytearray()
        self._expected = _Expected.HEAD
        # Bytes that are still to come of the body, or of a chunk and its line end.
        self._left = 0
        # Bytes of the request that are no content.
        self._frame = 0
        self._searched = 0
        self.content = 0
        self.whole = False

    def __len__(self) -> int:
        """How many bytes have come and are in no piece yet."""
        return len(self._came)

    @property
    def came(self) -> bytes:
        """What has come and is in no piece yet."""
        return bytes(self._came)

    @property
    def begun(self) -> bool:
        """Whether anything of a request has come."""
        return self._expected is not _Expected.HEAD or len(self._came) > 0

    @property
    def in_head(self) -> bool:
        """Whether the head is still incomplete."""
        return self._expected is _Expected.HEAD and not self.whole

    def receive(self, data: bytes) -> None:
        """Take what has come."""
        self._came += data

    def start_next(self) -> None:
        """Go on to the next request of the connection."""
        self._expected, self._frame, self._searched = _Expected.HEAD, 0, 0
        self.content, self.whole = 0, False

    def expect_body(self, length: int | None) -> None:
        """Say, after the head, how long the body is; None where it comes in chunks."""
        if length is None:
            self._expected = _Expected.CHUNK_SIZE
        else:
            self._expected, self._left = _Expected.BODY, length
            self.whole = length == 0

    def piece(self) -> bytes | None:
        """The next piece for the parser, or None where more has to come first.

        Raises ProblemError where the frame is too large, or is none.
        """
        match self._expected:
            case _Expected.HEAD:
                return self._head()
            case _Expected.BODY:
                piece = self._some()
                self.whole = self._left == 0
            case _Expected.CHUNK_SIZE:
                return self._chunk_size()
            case _Expected.CHUNK:
                piece = self._some()
                if self._left == 0:
                    self._expected = _Expected.CHUNK_SIZE
            case _:
                piece = self._line()
                self.whole = piece == _END
        return piece

    def _head(self) -> bytes | None:
        came = self._came
        if not came[:2].strip(b"\r\n"):
            # An empty line before a request is to be ignored.
            self._spend(len(came) - len(came.lstrip(b"\r\n")))
            self._came = came = came.lstrip(b"\r\n")
        if came and not 65 <= came[0] <= 90:
            raise malformed("The request does not begin with a method, such as GET.")
        end = came.find(b"\r\n\r\n", max(self._searched - 3, 0))
        if _BARE_NEWLINE.search(came, self._searched, len(came) if end < 0 else end):
            raise malformed("A line of the head ends without a carriage return.")
        self._searched = len(came)
        size = len(came) if end < 0 else end + 4
        self._check_line(came[: MAX_URL + _REST_OF_LINE + 1])
        if self._frame + size > MAX_FRAME:
            raise large_frame("The head of a request may hold 64 kB; this one is larger.")
        if end < 0:
            return None
        if came.count(_END, 0, end + 2) > MAX_HEADERS + 1:
            raise many_headers()
        self._spend(size)
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
        end = self._came.find(_END, max(self._searched - 1, 0))
        size = len(self._came) if end < 0 else end + 2
        if self._frame + size > MAX_FRAME:
            raise large_frame("Sizes of chunks and trailers may hold 64 kB; these are larger.")
        if end < 0:
            self._searched = size
            return None
        self._spend(max(size, _LEAST_LINE))
        return self._take(size)

    def _some(self) -> bytes | None:
        piece = self._take(min(self._left, len(self._came)))
        self._left -= len(piece)
        self.content += len(piece)
        return piece or None

    def _take(self, size: int) -> bytes:
        piece = bytes(self._came[:size])
        del self._came[:size]
        self._searched = 0
        return piece

    def _spend(self, size: int) -> None:
        self._frame += size
