"""Cut the bytes of a connection into pieces that each belong to one request.

The parser gets one piece at a time. This module only finds where the pieces end (RFC 9112); the
parser decides whether they are valid.
"""

# The parser reads all bytes that it gets, stores a head of any size, and begins the next request of
# a pipeline before the previous one is answered. So it gets only what it should read now.

from enum import Enum, auto
from typing import Final

from service.regex import regex
from service.server.limits import MAX_FRAME, MAX_HEADERS, MAX_URL
from service.server.refusals import large_frame, long_address, malformed, too_many_headers

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
