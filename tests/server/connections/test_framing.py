"""Find the end of each request in a stream of bytes."""

from http import HTTPStatus

import pytest
from dh_grader.api.http import ProblemError
from dh_grader.server.connections import MAX_FRAME, MAX_HEADERS, MAX_URL, Framing
from hypothesis import given
from hypothesis import strategies as st

GET = b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n"
SIZED = b"POST /v1/preview HTTP/1.1\r\nContent-Length: 5\r\n\r\n"
CHUNKED = b"POST /v1/preview HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"
# Each: the head, the length of the body by the head, and all bytes after the head.
REQUESTS: list[tuple[bytes, int | None, bytes]] = [
    (GET, 0, b""),
    (SIZED, 5, b"{}\r\n\r"),
    (CHUNKED, None, b"5\r\n{\r\n\r\n\r\n0\r\n\r\n"),
    (CHUNKED, None, b'2;name="v"\r\n{}\r\n00\r\nDigest: x\r\nB: y\r\n\r\n'),
    (CHUNKED, None, b"0\r\n\r\n"),
]


def read(framing: Framing, data: bytes, lengths: list[int | None]) -> list[bytes]:
    requests: list[bytes] = []
    taken = b""
    framing.receive(data)
    while True:
        in_head = framing.in_head
        piece = framing.piece()
        if piece is None:
            return [*requests, taken] if taken else requests
        taken += piece
        if in_head:
            framing.expect_body(lengths.pop(0))
        if framing.whole:
            requests.append(taken)
            taken = b""
            framing.start_next()


@given(
    st.lists(st.sampled_from(REQUESTS), min_size=1, max_size=5),
    st.lists(st.integers(1, 40), min_size=1, max_size=20),
)
def test_a_request_ends_at_the_same_place_however_it_is_cut(
    requests: list[tuple[bytes, int | None, bytes]], cuts: list[int]
) -> None:
    stream = b"".join(head + rest for head, _, rest in requests)
    lengths = [length for _, length, _ in requests]
    framing = Framing()
    found: list[bytes] = []
    open_end = b""
    position = turn = 0
    while position < len(stream):
        size = cuts[turn % len(cuts)]
        turn += 1
        for part in read(framing, stream[position : position + size], lengths):
            open_end += part
            head, _, rest = requests[len(found)]
            if open_end == head + rest:
                found.append(open_end)
                open_end = b""
        position += size
    assert found == [head + rest for head, _, rest in requests]
    assert (open_end, len(framing), framing.begun) == (b"", 0, False)


def refused(data: bytes, length: int | None = 0) -> HTTPStatus | None:
    statuses: set[HTTPStatus | None] = set()
    for step in (len(data), 997):
        framing = Framing()
        try:
            for begin in range(0, len(data), step):
                read(framing, data[begin : begin + step], [length] * 3)
            statuses.add(None)
        except ProblemError as problem:
            statuses.add(problem.status)
    (status,) = statuses
    return status


def head(size: int) -> bytes:
    begin, end = b"GET / HTTP/1.1\r\nCookie: ", b"\r\n\r\n"
    return begin + b"x" * (size - len(begin) - len(end)) + end


def test_a_head_may_hold_64_kb() -> None:
    assert MAX_FRAME == 65536
    assert refused(head(MAX_FRAME)) is None
    assert refused(head(MAX_FRAME + 1)) is HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE


def test_a_head_without_an_end_is_refused_at_its_limit() -> None:
    endless = head(MAX_FRAME + 10)[: MAX_FRAME + 1]
    assert refused(endless[:-1]) is None
    assert refused(endless) is HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE


@pytest.mark.parametrize("end", [b" HTTP/1.1\r\n\r\n", b""])
def test_an_address_may_have_8_kb(end: bytes) -> None:
    assert MAX_URL == 8192
    address = b"/" + b"x" * (MAX_URL - 1)
    assert refused(b"GET " + address + end) is None
    assert refused(b"GET " + address + b"x" + end) is HTTPStatus.REQUEST_URI_TOO_LONG


def test_a_request_may_have_100_headers() -> None:
    headers = b"A: b\r\n" * MAX_HEADERS
    assert MAX_HEADERS == 100
    assert refused(b"GET / HTTP/1.1\r\n" + headers + b"\r\n") is None
    more = b"GET / HTTP/1.1\r\nC: d\r\n" + headers + b"\r\n"
    assert refused(more) is HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE


@pytest.mark.parametrize(
    "rest",
    [
        b"5;" + b"x" * MAX_FRAME,
        b"0\r\nTrailer: " + b"x" * MAX_FRAME,
        b"0\r\n" + b"T: x\r\n" * 5000,
        b"1\r\nx\r\n" * 5000,
    ],
    ids=["an extension", "a trailer", "many trailers", "tiny chunks"],
)
def test_chunk_sizes_and_trailers_count_with_the_head(rest: bytes) -> None:
    assert refused(CHUNKED + rest, None) is HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE


def test_chunks_of_a_usual_size_are_read() -> None:
    assert refused(CHUNKED + b"400\r\n" + b"x" * 1024 + b"\r\n", None) is None
    assert refused(CHUNKED + (b"400\r\n" + b"x" * 1024 + b"\r\n") * 250, None) is None


@pytest.mark.parametrize(
    "data",
    [
        b"\x16\x03\x01\x02\x00\x01\x00",
        b"{}",
        b"get / HTTP/1.1\r\n",
        b"GET / HTTP/1.1\nHost: x\n\n",
        b"GET / HTTP/1.1\r\nHost: x\nA: b\r\n",
    ],
    ids=["TLS", "no method", "small letters", "newlines", "one newline"],
)
def test_bytes_that_are_no_request_are_refused_at_once(data: bytes) -> None:
    assert refused(data) is HTTPStatus.BAD_REQUEST


@pytest.mark.parametrize("size", [b"x", b"", b"-1", b"+5", b"1_0", b" 5", b"0x5", b"123456789"])
def test_the_size_of_a_chunk_is_a_number(size: bytes) -> None:
    assert refused(CHUNKED + size + b"\r\n", None) is HTTPStatus.BAD_REQUEST


def test_empty_lines_before_a_request_are_ignored() -> None:
    assert read(Framing(), b"\r\n\r\n" + GET, [0]) == [GET]
    assert refused(b"\r\n" * MAX_FRAME) is HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE


@pytest.mark.parametrize("length", [None, 40_000])
def test_a_body_that_comes_byte_by_byte_is_passed_on_in_few_pieces(length: int | None) -> None:
    framing = Framing()
    framing.receive(SIZED)
    framing.piece()
    framing.expect_body(length)
    pieces = []
    for byte in (b"" if length else b"9C40\r\n") + b"x" * 40_000:
        framing.receive(bytes([byte]))
        if piece := framing.piece():
            pieces.append(piece)
    # Every byte is counted, whether it has been passed on or not.
    assert len(framing) + framing.content >= 40_000 - 2
    assert len(pieces) <= 4
    if length:
        assert b"".join(pieces) == b"x" * length
        assert framing.whole
