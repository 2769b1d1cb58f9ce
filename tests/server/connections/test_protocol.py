"""Test raw connections to a real process."""

import contextlib
import socket
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.server.impatient import HEAD_TIMEOUT, TIMEOUT
from tests.server.raw import HEALTH, HOST, TEXT, Service, answers, preview, received, service, until
from tests.server.watching.test_metrics import asked, value

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
