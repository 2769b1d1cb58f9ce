"""Test connections: framing, limits, and those that stay open."""

import asyncio
import contextlib
import resource
import socket
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from http import HTTPStatus
from pathlib import Path
from typing import Any

import pytest
import uvicorn
from dh_grader.api.http import ProblemError
from dh_grader.server import connections as module
from dh_grader.server.connections import (
    MAX_FRAME,
    MAX_HEADERS,
    MAX_URL,
    RESERVE,
    ConnectionLimits,
    Framing,
    GuardedProtocol,
    GuardedState,
    OpenConnections,
    allowed_here,
    cors_headers,
    origin_in,
    too_busy,
)
from dh_grader.server.metrics import Metrics
from hypothesis import given
from hypothesis import strategies as st

from tests.server.impatient import HEAD_TIMEOUT, TIMEOUT
from tests.server.raw import HEALTH, HOST, TEXT, Service, answers, preview, received, service, until
from tests.server.test_watching import asked, value

# --- Test raw connections to a real process

COURSE = "https://course.example.edu"
CHUNKED = b"POST /v1/preview HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n"


@pytest.fixture(scope="session")
def impatient(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    folder = tmp_path_factory.mktemp("server")
    settings = {"DH_GRADER_CORS_ORIGINS": COURSE, "DH_GRADER_METRICS": "local"}
    with service(folder, module="tests.server.impatient", **settings) as running:
        yield running
        assert running.end() == 0


@pytest.mark.sampled(5)
@pytest.mark.parametrize(
    ("sent", "status"),
    [
        (b"GET /" + b"x" * 9000 + b" HTTP/1.1\r\n" + HOST + b"\r\n", 414),
        (b"GET / HTTP/1.1\r\nCookie: " + b"x" * 70_000, 431),
        (b"GET / HTTP/1.1\r\n" + b"A: b\r\n" * 101 + b"\r\n", 431),
        (CHUNKED + b"2\r\n{}\r\n0\r\nTrailer: " + b"x" * 70_000, 431),
        (CHUNKED + b"2;" + b"x" * 70_000, 431),
        (CHUNKED + b"1\r\n \r\n" * 10_000, 431),
        (b"NONSENSE\r\n\r\n", 400),
        (b"GET / HTTP/3.7\r\n\r\n", 400),
        (b"GET /\r\n\r\n", 400),
        (b"DESCRIBE / RTSP/1.0\r\n\r\n", 400),
        (b"SOURCE / ICE/1.0\r\n\r\n", 400),
        (b"GET / HTTP/1.1\r\nno colon\r\n\r\n", 400),
        (b"GET /healthz HTTP/1.1\n\n", 400),
        (b"GET /healthz HTTP/1.1\r\nHosts: x\r\n\r\n", 400),
        (b"GET /healthz HTTP/1.1\r\n" + HOST + b"HOST: y\r\n\r\n", 400),
        (b"GET /\xff HTTP/1.1\r\n\r\n", 400),
        (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 400),
        (b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", 400),
        (b"CONNECT x:1 HTTP/1.1\r\n\r\n", 400),
        (CHUNKED + b"two\r\n{}\r\n0\r\n\r\n", 400),
        (CHUNKED + b"2\r\n{}}\r\n0\r\n\r\n", 400),
        (b"POST /v1/preview HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n{}", 400),
        (b"POST /v1/preview HTTP/1.1\r\nContent-Length: -1\r\n\r\n", 400),
        (b"POST /v1/preview HTTP/1.1\r\nContent-Length: " + b"9" * 30 + b"\r\n\r\n", 400),
        (preview().replace(b"Length: ", b"Length: " + b"0" * 5000), 400),
        (preview().replace(b"Length: ", b"LENGTH:\t" + b"0" * 18), 400),
        (HEALTH.replace(b"\r\n\r\n", b"\r\nContent-Length: " + b"0" * 60_000 + b"\r\n\r\n"), 400),
        (CHUNKED + b"0" * 5000 + b"2a\r\n" + TEXT + b"\r\n0\r\n\r\n", 400),
        (CHUNKED.replace(b"\r\n\r\n", b"\r\nContent-Length: 2\r\n\r\n") + b"0\r\n\r\n", 400),
        (CHUNKED.replace(b"chunked", b"chunked, gzip") + b"0\r\n\r\n", 400),
    ],
)
def test_an_invalid_request_is_answered_with_a_problem(
    impatient: Service, sent: bytes, status: int
) -> None:
    # Nothing more is sent, but the sending end stays open: the server must refuse by itself.
    with impatient.connect(sent) as connection:
        (answer,) = answers(connection)
    assert answer.status == status
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.headers["connection"] == "close"
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert "date" in answer.headers
    assert "server" not in answer.headers
    # A page may read it, even if only half of the address has been received.
    assert answer.headers["access-control-allow-origin"] == COURSE
    problem = answer.json()
    assert problem["status"] == status
    assert {"type", "title", "detail", "instance"} <= problem.keys()


@pytest.mark.parametrize(
    "sent",
    [
        preview(),
        preview(TEXT, b"Upgrade: h2c", b"Connection: Upgrade, HTTP2-Settings"),
        preview(TEXT, b"Expect: 100-continue").replace(b"Expect: 100-continue\r\n", b""),
        CHUNKED + b"%x\r\n" % len(TEXT) + TEXT + b"\r\n0\r\n\r\n",
        CHUNKED + b"".join(b"1\r\n%c\r\n" % c for c in TEXT) + b"0\r\nDigest: x\r\n\r\n",
        b"\r\n" + preview(),
    ],
    ids=["sized", "upgrade", "plain", "chunked", "tiny chunks and a trailer", "an empty line"],
)
def test_a_valid_request_and_the_next_one_are_answered(impatient: Service, sent: bytes) -> None:
    first, second = impatient.ask(sent + HEALTH)
    assert (first.status, second.status) == (200, 200)
    assert first.json()["ok"] is True
    assert second.json() == {"status": "ok"}


def test_a_request_may_come_byte_by_byte(impatient: Service) -> None:
    with impatient.connect() as connection:
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for byte in preview() + HEALTH:
            connection.sendall(bytes([byte]))
        connection.shutdown(socket.SHUT_WR)
        assert [answer.status for answer in answers(connection)] == [200, 200]


def test_a_client_that_waits_for_100_continue_receives_it(impatient: Service) -> None:
    with impatient.connect(preview(b"", b"Expect: 100-continue").replace(b": 0", b": 42")) as line:
        assert line.recv(100) == b"HTTP/1.1 100 Continue\r\n\r\n"
        line.sendall(TEXT)
        line.shutdown(socket.SHUT_WR)
        assert received(line).startswith(b"HTTP/1.1 200 OK\r\n")


def test_an_http_1_0_client_is_answered_and_its_connection_is_closed(impatient: Service) -> None:
    with impatient.connect(b"GET http://x/healthz HTTP/1.0\r\n\r\n") as connection:
        (answer,) = answers(connection)
    assert (answer.status, answer.headers["connection"]) == (200, "close")


def test_a_long_pipeline_is_answered_in_order(impatient: Service) -> None:
    texts = [f"l1*{i}" for i in range(200)]
    bodies = [b'{"text": "%s", "exercise": "planar-rrr"}' % text.encode() for text in texts]
    found = impatient.ask(b"".join(map(preview, bodies)))
    assert [answer.json()["text"].replace(" ", "") for answer in found] == texts


def test_the_rest_of_a_refused_body_is_no_request(impatient: Service) -> None:
    smuggled = HEALTH * 3
    head = b"POST /v1/preview HTTP/1.1\r\nHost: x\r\nContent-Length: 9000000\r\n\r\n"
    with impatient.connect(head + smuggled) as connection:
        (answer,) = answers(connection)
    assert answer.status == 413


def test_an_early_answer_does_not_end_the_connection(impatient: Service) -> None:
    head = b"POST /nowhere HTTP/1.1\r\nHost: x\r\nContent-Length: 8\r\n\r\n"
    with impatient.connect(head + b"1234") as connection:
        time.sleep(0.05)
        connection.sendall(b"5678" + HEALTH)
        connection.shutdown(socket.SHUT_WR)
        assert [answer.status for answer in answers(connection)] == [404, 200]


# Timeouts of the server. The tests check their lower bounds; upper bounds are only guards.


def seconds_until_closed(connection: socket.socket) -> tuple[float, bytes]:
    began = time.monotonic()
    said = received(connection)
    return time.monotonic() - began, said


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    "sent",
    [b"GET /healthz HTTP/1.1\r\nHost:", preview()[:-5], CHUNKED + b"5\r\n{}"],
    ids=["head", "body", "chunks"],
)
def test_an_unfinished_request_is_given_up(impatient: Service, sent: bytes) -> None:
    with impatient.connect(sent) as connection:
        (answer,) = answers(connection)
    assert answer.status == 408
    assert answer.headers["content-type"] == "application/problem+json"


def test_refusals_before_the_application_are_counted(impatient: Service) -> None:
    begun = (b"GET / HTTP/1.1\r\nHost: x\r\n", 408)
    broken = (CHUNKED + b"two\r\n", 400)
    long = (b"GET /" + b"x" * 9000, 414)
    large = (b"GET / HTTP/1.1\r\nCookie: " + b"x" * 70_000, 431)
    # The application refuses this one itself.
    heavy = (preview(b" " * 300_000), 413)
    before = asked(impatient)
    for sent, status in (begun, broken, long, long, large, heavy):
        with impatient.connect(sent) as connection:
            assert [answer.status for answer in answers(connection)] == [status]
    after = asked(impatient)

    def more(name: str, *labels: str) -> float:
        return value(after, name, *labels) - value(before, name, *labels)

    counted = [more("refusals_total", str(status)) for status in (408, 400, 414, 431, 413)]
    assert counted == [1, 1, 2, 1, 0]
    assert more("requests_total", "POST", "/v1/preview", "413") == 1


@pytest.mark.long
def test_a_body_that_comes_too_slowly_is_given_up(impatient: Service) -> None:
    with impatient.connect(preview(b" " * 1000)[:-1000]) as connection:
        connection.settimeout(0.05)
        began = time.monotonic()
        said = b""
        while not said:
            connection.sendall(b" ")
            try:
                said = connection.recv(1000)
            except TimeoutError:
                continue
    assert said.startswith(b"HTTP/1.1 408 ")
    assert time.monotonic() - began >= TIMEOUT * 0.9


@pytest.mark.long
@pytest.mark.parametrize(
    ("sent", "timeout"),
    [(b"", HEAD_TIMEOUT), (HEALTH, TIMEOUT)],
    ids=["nothing", "an answered request"],
)
def test_an_idle_connection_is_closed_without_an_answer(
    impatient: Service, sent: bytes, timeout: float
) -> None:
    with impatient.connect(sent) as connection:
        seconds, said = seconds_until_closed(connection)
    assert seconds >= timeout * 0.9
    assert said.count(b"HTTP/1.1") == (1 if sent else 0)


@pytest.mark.long
def test_a_head_has_less_time_than_a_body(tmp_path: Path) -> None:
    head = b"GET /healthz HTTP/1.1\r\n"
    with (
        service(tmp_path, module="tests.server.impatient", TIMEOUT="600") as running,
        running.connect(preview()[:-5]) as body,
        running.connect(b"") as silent,
        running.connect(head) as first_head,
        running.connect(HEALTH + head) as second_head,
    ):
        assert received(silent) == b""
        assert b"HTTP/1.1 408 " in received(first_head)
        assert b"HTTP/1.1 408 " in received(second_head)
        body.settimeout(0.1)
        with pytest.raises(TimeoutError):
            body.recv(100)


def test_empty_lines_do_not_keep_a_connection_open(impatient: Service) -> None:
    with impatient.connect(b"\r\n") as connection:
        connection.settimeout(TIMEOUT / 5)
        end = time.monotonic() + 5 * TIMEOUT
        with pytest.raises((ConnectionResetError, BrokenPipeError)):  # noqa: PT012 - until closed
            while time.monotonic() < end:
                connection.sendall(b"\r\n")
                with contextlib.suppress(TimeoutError):
                    assert connection.recv(100) == b""


def test_a_client_that_reads_no_answers_is_not_read_any_further(impatient: Service) -> None:
    # Each answer has 5 kB; soon no further request of a client that reads none is begun.
    request = b"GET /v1/exercises HTTP/1.1\r\nHost: x\r\n\r\n" * 1000
    line = socket.socket()
    line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    with line:
        line.connect(("127.0.0.1", impatient.port))
        line.settimeout(TIMEOUT / 2)
        sent = 0
        with contextlib.suppress(TimeoutError, ConnectionResetError, BrokenPipeError):
            while sent < 10**9:
                sent += line.send(request)
    # About the size of the system's buffers; the answers would have a hundred times as many bytes.
    assert sent < 20_000_000
    (answer,) = impatient.ask(HEALTH)
    assert answer.status == 200


@pytest.mark.parametrize("sent", [b"", b"GET /heal", preview()[:-3]], ids=["", "head", "body"])
def test_a_connection_that_the_client_closes_early_is_closed_at_once(
    impatient: Service, sent: bytes
) -> None:
    assert impatient.ask(sent) == []


def test_a_client_that_closes_its_sending_end_gets_its_answer(impatient: Service) -> None:
    (answer,) = impatient.ask(preview())
    assert answer.json()["ok"] is True


def test_the_log_has_no_query_strings(impatient: Service) -> None:
    impatient.ask(b"GET /healthz?name=Ada HTTP/1.1\r\nHost: x\r\n\r\n")
    # A line may come later than its answer.
    until(lambda: '"GET /healthz HTTP/1.1" 200' in impatient.log)
    assert "127.0.0.1:" in impatient.log
    assert "Ada" not in impatient.log


# --- Find the end of each request in a stream of bytes

GET = b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n"
SIZED = b"POST /v1/preview HTTP/1.1\r\nContent-Length: 5\r\n\r\n"
FRAMING_CHUNKED = b"POST /v1/preview HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"
# Each: the head, the length of the body by the head, and all bytes after the head.
REQUESTS: list[tuple[bytes, int | None, bytes]] = [
    (GET, 0, b""),
    (SIZED, 5, b"{}\r\n\r"),
    (FRAMING_CHUNKED, None, b"5\r\n{\r\n\r\n\r\n0\r\n\r\n"),
    (FRAMING_CHUNKED, None, b'2;name="v"\r\n{}\r\n00\r\nDigest: x\r\nB: y\r\n\r\n'),
    (FRAMING_CHUNKED, None, b"0\r\n\r\n"),
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
    assert refused(FRAMING_CHUNKED + rest, None) is HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE


def test_chunks_of_a_usual_size_are_read() -> None:
    assert refused(FRAMING_CHUNKED + b"400\r\n" + b"x" * 1024 + b"\r\n", None) is None
    assert refused(FRAMING_CHUNKED + (b"400\r\n" + b"x" * 1024 + b"\r\n") * 250, None) is None


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
    assert refused(FRAMING_CHUNKED + size + b"\r\n", None) is HTTPStatus.BAD_REQUEST


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


# --- Test which connections are closed when there are too many


@dataclass(eq=False)
class FakeConnection:
    """A connection that has been waiting since ``waiting_since``."""

    address: str
    waiting_since: float | None
    deadline: float = float("inf")
    unfinished: int = 0
    ended: list[str] = field(default_factory=list)

    def expire(self) -> None:
        self.ended.append("expired")

    def reset(self) -> None:
        self.ended.append("reset")


@pytest.fixture
def loop() -> Iterator[asyncio.AbstractEventLoop]:
    loop = asyncio.new_event_loop()
    try:
        yield loop
    finally:
        loop.close()


def closed(lines: list[FakeConnection]) -> list[int]:
    return [i for i, line in enumerate(lines) if line.ended]


def test_the_address_with_most_connections_loses_its_longest_waiting_ones(
    loop: asyncio.AbstractEventLoop,
) -> None:
    connections = OpenConnections(ConnectionLimits(connections=16))
    honest = [FakeConnection("a", 0.0), FakeConnection("b", 25.0)]
    many = [FakeConnection("c", float(20 - i)) for i in range(14)]
    for line in [*honest, *many]:
        assert connections.enter(line, loop)
    assert closed([*honest, *many]) == []
    assert connections.enter(FakeConnection("d", 30.0), loop)
    # One more than needed is closed; the last two of the many have waited longest.
    assert (closed(honest), closed(many)) == ([], [12, 13])
    assert len(connections) == 15


def test_complete_requests_are_not_dropped_and_the_reserve_is_for_health_checks(
    loop: asyncio.AbstractEventLoop,
) -> None:
    connections = OpenConnections(ConnectionLimits(connections=4))
    lines = [FakeConnection("a", None) for _ in range(4 + RESERVE)]
    for i, line in enumerate(lines):
        assert connections.enter(line, loop)
        assert connections.full == (i >= 4)
    assert not connections.enter(FakeConnection("b", 0.0), loop)
    assert closed(lines) == []
    connections.leave(lines[0])
    assert connections.enter(FakeConnection("b", 0.0), loop)


def test_the_address_that_holds_most_bytes_loses_its_longest_waiting_connection(
    loop: asyncio.AbstractEventLoop,
) -> None:
    connections = OpenConnections(ConnectionLimits(unfinished=1000))
    large = [FakeConnection("a", 1.0), FakeConnection("a", 2.0), FakeConnection("a", None)]
    small = FakeConnection("b", 0.0)
    idle = FakeConnection("a", 0.0)
    for line in [*large, small, idle]:
        connections.enter(line, loop)
    for line, size in [(large[0], 400), (large[1], 300), (small, 200), (large[2], 0)]:
        connections.set_unfinished(line, size)
    assert closed([*large, small, idle]) == []
    connections.set_unfinished(small, 301)
    assert closed([*large, small, idle]) == [0]
    # A closed connection holds no bytes: 601 bytes are left.
    connections.set_unfinished(large[1], 699)
    assert closed([*large, small, idle]) == [0]
    connections.set_unfinished(large[1], 700)
    assert closed([*large, small, idle]) == [0, 1]


def test_a_connection_expires_at_its_deadline(
    loop: asyncio.AbstractEventLoop, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "SWEEP", 0.001)
    connections = OpenConnections(ConnectionLimits())
    late, early = (
        FakeConnection("a", 0.0, deadline=loop.time()),
        FakeConnection("a", 0.0, deadline=loop.time() + 99),
    )
    for line in (late, early):
        connections.enter(line, loop)

    async def until_expired() -> None:
        while not late.ended:
            await asyncio.sleep(0.001)

    loop.run_until_complete(until_expired())
    assert (late.ended[0], early.ended) == ("expired", [])


def test_the_limit_of_connections_follows_the_limit_of_open_files(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    limits = [256, 1024]
    monkeypatch.setattr(resource, "getrlimit", lambda _: tuple(limits))
    monkeypatch.setattr(resource, "setrlimit", lambda _, new: limits.__setitem__(0, new[0]))
    assert (allowed_here().connections, limits[0]) == (1024 - 96, 1024)
    limits[:] = [256, resource.RLIM_INFINITY]
    assert (allowed_here().connections, limits[0]) == (1000, 1096)
    limits[:] = [20000, 20000]
    assert (allowed_here().connections, limits[0]) == (1000, 20000)


# --- Web pages of allowed origins can read the responses that refuse their requests

EARLY_CORS_COURSE, OTHER = "https://course.example.edu", "https://other.example.edu"


@pytest.mark.parametrize(
    ("origins", "origin", "allowed"),
    [
        ((), EARLY_CORS_COURSE, None),
        ((EARLY_CORS_COURSE,), EARLY_CORS_COURSE, EARLY_CORS_COURSE),
        ((EARLY_CORS_COURSE,), OTHER, None),
        ((EARLY_CORS_COURSE,), "", EARLY_CORS_COURSE),
        ((EARLY_CORS_COURSE, OTHER), OTHER, OTHER),
        ((EARLY_CORS_COURSE, OTHER), "", None),
        (("*",), OTHER, "*"),
    ],
)
def test_only_configured_origins_are_allowed(
    origins: tuple[str, ...], origin: str, allowed: str | None
) -> None:
    assert cors_headers(origins, origin).get("Access-Control-Allow-Origin") == allowed


@pytest.mark.parametrize(
    ("head", "origin"),
    [
        (b"GET / HTTP/1.1\r\norigin:  https://a.example \r\n\r\n", "https://a.example"),
        (b"GET / HTTP/1.1\r\nOrigin: https://a.exam", ""),
        (b"GET / HTTP/1.1\r\nX-Origin: https://a.example\r\n", ""),
        (b"", ""),
    ],
)
def test_the_origin_is_found_in_an_incomplete_head(head: bytes, origin: str) -> None:
    assert origin_in(head) == origin


# --- Guarded state


def test_a_refusal_is_counted_and_a_page_may_read_it() -> None:
    metrics = Metrics()
    state = GuardedState(["https://course.example.edu"], metrics)
    answer = state.refusal(too_busy(1), "/v1/preview", "https://course.example.edu")
    state.note_refusal("none")
    state.note_refusal("none")
    assert answer.status_code == 503
    assert answer.headers["Access-Control-Allow-Origin"] == "https://course.example.edu"
    counted = {
        sample.labels["status"]: sample.value
        for family in metrics._refusals.collect()
        for sample in family.samples
        if sample.name.endswith("_total")
    }
    assert counted == {"503": 1, "none": 2}


# --- Unread responses count towards the byte limit of their connection

MB = 1024 * 1024
ANSWER = 8 * MB
LIMIT = 24 * MB


async def large(_scope: Any, _receive: Any, send: Any) -> None:
    """Send a large response in one piece."""
    length = (b"content-length", str(ANSWER).encode())
    await send({"type": "http.response.start", "status": 200, "headers": [length]})
    await send({"type": "http.response.body", "body": bytes(ANSWER)})


async def unsent_to(clients: int, *, reading: bool) -> tuple[int, int]:
    loop = asyncio.get_running_loop()
    config = uvicorn.Config(large, http=GuardedProtocol, ws="none", log_level="critical")
    config.load()
    state = GuardedState()
    state.open_connections = OpenConnections(ConnectionLimits(unfinished=LIMIT))
    server = await loop.create_server(lambda: GuardedProtocol(config, state, {}), "127.0.0.1", 0)
    address = server.sockets[0].getsockname()
    lines = [socket.socket() for _ in range(clients)]
    try:
        for line in lines:
            line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096 if not reading else MB)
            line.setblocking(False)
            await loop.sock_connect(line, address)
            await loop.sock_sendall(line, HEALTH)
            got = 0
            while reading and got < ANSWER:
                got += len(await loop.sock_recv(line, MB))
            await asyncio.sleep(0.02)
        connections: Any = list(state.connections)
        unsent = sum(each._raw.get_write_buffer_size() for each in connections)
        return unsent, len(connections)
    finally:
        server.close()
        for line in lines:
            line.close()
        for each in list(state.connections):
            with contextlib.suppress(AttributeError):
                each.reset()  # type: ignore[union-attr]
        await asyncio.sleep(0)


def test_the_bytes_of_unread_answers_are_bounded() -> None:
    unsent, _ = asyncio.run(unsent_to(12, reading=False))
    # The last answer may exceed the limit until other connections have been closed.
    assert ANSWER // 4 < unsent <= LIMIT + ANSWER


def test_clients_that_read_their_answers_stay_connected() -> None:
    assert asyncio.run(unsent_to(12, reading=True)) == (0, 12)
