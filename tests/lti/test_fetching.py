"""The service fetches only data of limited size from public addresses."""

import gzip
import json
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from http import HTTPStatus
from ipaddress import ip_address
from typing import Any

import pytest
from dh_grader.lti import fetching, unusable
from dh_grader.lti.fetching import TIMEOUT, FetchError, answer, fetch_json, is_public
from fastapi import FastAPI, Response

from tests.guards import ANSWER
from tests.lti.platform import running

# By the registries of special-purpose addresses of IANA: the first and last address of each block
# that is not globally reachable, of blocks that were taken back, and of multicast.
PRIVATE = (
    "0.0.0.0", "0.255.255.255", "10.0.0.0", "10.255.255.255", "100.64.0.0", "100.127.255.255",
    "127.0.0.1", "127.255.255.255", "169.254.0.0", "169.254.169.254", "172.16.0.0",
    "172.31.255.255", "192.0.0.0", "192.0.0.8", "192.0.0.170", "192.0.0.255", "192.0.2.0",
    "192.0.2.255", "192.88.99.1", "192.168.0.0", "192.168.255.255", "198.18.0.0",
    "198.19.255.255", "198.51.100.0", "198.51.100.255", "203.0.113.0", "203.0.113.255",
    "224.0.0.0", "239.255.255.255", "240.0.0.0", "255.255.255.255",
    "::", "::1", "::127.0.0.1", "::8.8.8.8", "::ffff:10.0.0.1", "::ffff:127.0.0.1",
    "64:ff9b::10.0.0.1", "64:ff9b::127.0.0.1", "64:ff9b::192.0.0.1", "64:ff9b:1::",
    "64:ff9b:1::8.8.8.8",
    "64:ff9b:1:ffff:ffff:ffff:ffff:ffff", "100::", "100::1", "100:0:0:1::1", "2001::",
    "2001:0:a00:1::", "2001:0:808:808::", "2001:2::1", "2001:10::1", "2001:20::1", "2001:db8::",
    "2001:db8:ffff:ffff:ffff:ffff:ffff:ffff", "2002::", "2002:a00:1::", "2002:808:808::",
    "2002:ffff:ffff:ffff:ffff:ffff:ffff:ffff", "3fff::", "3fff:fff:ffff:ffff:ffff:ffff:ffff:ffff",
    "4000::1", "5f00::1", "fc00::", "fc00::1", "fdff:ffff:ffff:ffff:ffff:ffff:ffff:ffff",
    "fe80::", "fe80::1", "fe80::1%lo", "febf:ffff:ffff:ffff:ffff:ffff:ffff:ffff", "fec0::",
    "fec0::1", "feff:ffff:ffff:ffff:ffff:ffff:ffff:ffff", "ff02::1", "ff0e::1",
)  # fmt: skip
# The neighbours of these blocks, and well-known hosts.
PUBLIC = (
    "1.0.0.0", "8.8.8.8", "9.255.255.255", "11.0.0.0", "100.63.255.255", "100.128.0.0",
    "126.255.255.255", "128.0.0.0", "169.253.255.255", "169.255.0.0", "172.15.255.255",
    "172.32.0.0", "191.255.255.255", "192.0.1.0", "192.0.3.0", "192.167.255.255", "192.169.0.0",
    "193.0.6.139", "198.17.255.255", "198.20.0.0", "203.0.112.255", "203.0.114.0",
    "223.255.255.255", "64:ff9b::8.8.8.8", "2001:200::", "2001:4860:4860::8888", "2001:db7::1",
    "2001:db9::1", "2003::1", "2606:4700:4700::1111", "2a00:1450:4001:800::200e", "3ffe::1",
)  # fmt: skip


@pytest.fixture(scope="module")
def site() -> Iterator[str]:
    app = FastAPI()
    app.state.asked = []

    @app.get("/{name}")
    async def answer(name: str) -> Response:
        there = {"location": "/right"}
        away = {"location": "http://localhost:1/right"}
        answers: dict[str, Any] = {
            "right": Response('{"keys": []}'),
            "near": Response(None, HTTPStatus.FOUND, there),
            "away": Response(None, HTTPStatus.FOUND, away),
            "circle": Response(None, HTTPStatus.FOUND, {"location": "/circle"}),
            "large": Response(json.dumps("x" * 65_536)),
            "compressed": Response(gzip.compress(b"{}"), headers={"content-encoding": "gzip"}),
            "failed": Response("{}", HTTPStatus.INTERNAL_SERVER_ERROR),
            "nested": Response("[" * 60_000),
            "words": Response("no JSON"),
        }
        return answers[name]  # type: ignore[no-any-return]

    with running(app) as port:
        yield f"http://127.0.0.1:{port}"


def reason(url: str, *, local: bool = True) -> str:
    with pytest.raises(FetchError) as refused:
        fetch_json(url, local=local)
    return str(refused.value)


def test_only_public_addresses_are_fetched() -> None:
    assert [each for each in PRIVATE if is_public(ip_address(each))] == []
    assert [each for each in PUBLIC if not is_public(ip_address(each))] == []
    for host in (
        "127.0.0.1",
        "localhost",
        "[::1]",
        "10.0.0.1",
        "169.254.169.254",
        "2130706433",
        "[fec0::1]",
        "192.0.0.8",
    ):
        said = reason(f"https://{host}/jwks.json", local=False)
        assert said == "the host has a private address", host


def test_plain_http_is_for_this_machine_in_development(site: str) -> None:
    assert fetch_json(f"{site}/right", local=True) == {"keys": []}
    assert reason(f"{site}/right", local=False) == "the address must begin with https://"
    assert reason("http://10.0.0.1/right") == "the address must begin with https://"


def test_answers_are_bounded(site: str) -> None:
    assert fetch_json(f"{site}/near", local=True) == {"keys": []}
    told = {
        name: reason(f"{site}/{name}")
        for name in ("away", "circle", "large", "compressed", "failed", "nested", "words")
    }
    assert told == {
        "away": "the answer is a redirect to another host",
        "circle": "the answers are too many redirects",
        "large": "the answer is larger than 64 KiB",
        "compressed": "the answer is compressed",
        "failed": "the status is 500",
        "nested": "the answer is not JSON",
        "words": "the answer is not JSON",
    }


def test_unusable_addresses_are_refused() -> None:
    for address in (
        "javascript:alert(1)", "ftp://a.example/", "https://", "https://a b.example/",
        "https://user@a.example/", "https://a.example/#x", "https://a.example;script-src *",
        "https://a.example:port/", "http://a.example/", "http://localhost/",
    ):  # fmt: skip
        assert unusable(address), address
    assert not unusable("https://moodle.example.edu:8443/mod/lti/certs.php?x=1")


# How long an exchange may take in these tests, and the pause after which a slow platform sends its
# next bytes. Each wait for bytes is short, but a platform never comes to an end.
SHORT = 1.0
PAUSE = 0.02

Talk = Callable[[socket.socket, threading.Event], None]


@contextmanager
def slow_platform(talk: Talk) -> Iterator[int]:
    """Run a server whose connections are handled by ``talk``; yield its port."""
    # ``talk`` ends when the client has gone, or the event is set.
    over = threading.Event()
    threads: list[threading.Thread] = []

    def serve(connection: socket.socket) -> None:
        # The client may have gone.
        with connection, suppress(OSError):
            talk(connection, over)

    def accept() -> None:
        while True:
            try:
                connection, _ = listening.accept()
            except OSError:
                return
            threads.append(threading.Thread(target=serve, args=(connection,), daemon=True))
            threads[-1].start()

    with socket.create_server(("127.0.0.1", 0)) as listening:
        accepting = threading.Thread(target=accept, daemon=True)
        accepting.start()
        yield listening.getsockname()[1]
        over.set()
        listening.shutdown(socket.SHUT_RDWR)
    for each in (accepting, *threads):
        each.join(ANSWER)


def endless(piece: bytes, before: bytes = b"", *, pause: float = PAUSE) -> Talk:
    """Read the request, send ``before``, and then ``piece`` again and again."""

    def talk(connection: socket.socket, over: threading.Event) -> None:
        connection.recv(65_536)
        connection.sendall(before)
        while not over.wait(pause):
            connection.sendall(piece)

    return talk


def deaf(connection: socket.socket, over: threading.Event) -> None:
    """Accept the connection, and neither read nor send."""
    over.wait(ANSWER)


def slowly_elsewhere(connection: socket.socket, over: threading.Event) -> None:
    """Redirect to the same address, each time after half the time of an exchange."""
    connection.recv(65_536)
    over.wait(SHORT / 2)
    connection.sendall(b"HTTP/1.1 302 Found\r\nLocation: /\r\nContent-Length: 0\r\n\r\n")


_HEAD = b"HTTP/1.1 200 OK\r\n"
SLOW: dict[str, tuple[str, Talk]] = {
    "a head byte by byte": ("http", endless(b"x", _HEAD + b"X-Long: ")),
    "a head line by line": ("http", endless(b"X-More: 1\r\n", _HEAD)),
    "interim responses": ("http", endless(b"HTTP/1.1 102 Processing\r\n\r\n")),
    "early hints": ("http", endless(b"HTTP/1.1 103 Early Hints\r\nLink: </a>\r\n\r\n")),
    "a body byte by byte": ("http", endless(b" ", _HEAD + b"Content-Length: 60000\r\n\r\n")),
    "chunks": (
        "http",
        endless(b"1\r\n \r\n", _HEAD + b"Transfer-Encoding: chunked\r\n\r\n"),
    ),
    "the extension of a chunk": (
        "http",
        endless(b"x", _HEAD + b"Transfer-Encoding: chunked\r\n\r\n1;"),
    ),
    "redirects": ("http", slowly_elsewhere),
    "no answer": ("http", deaf),
    "no TLS handshake": ("https", deaf),
    # The head of a TLS record with 16 KiB, and its content.
    "a TLS handshake byte by byte": ("https", endless(b"\x00", b"\x16\x03\x03\x40\x00\x02")),
}


@pytest.mark.parametrize("case", SLOW)
@pytest.mark.long
def test_an_exchange_ends_in_time(case: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert TIMEOUT == 5.0
    monkeypatch.setattr(fetching, "TIMEOUT", SHORT)
    scheme, talk = SLOW[case]
    with slow_platform(talk) as port:
        begun = time.monotonic()
        assert reason(f"{scheme}://127.0.0.1:{port}/") == "the answer takes too long"
        assert time.monotonic() - begun >= SHORT * 0.99


@pytest.mark.long
def test_a_request_that_nobody_reads_ends_in_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fetching, "TIMEOUT", SHORT)
    large = bytes(32 * 1024 * 1024)
    with (
        slow_platform(deaf) as port,
        pytest.raises(FetchError, match="takes too long"),
        answer(f"http://127.0.0.1:{port}/", "POST", local=True, content=large),
    ):
        pass


@pytest.mark.long
def test_a_connection_that_is_not_accepted_ends_in_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fetching, "TIMEOUT", SHORT)
    with socket.create_server(("127.0.0.1", 0), backlog=0) as listening:
        port = listening.getsockname()[1]
        # The queue of connections is full after the first ones.
        waiting = [socket.socket() for _ in range(3)]
        for each in waiting:
            each.setblocking(False)
            each.connect_ex(("127.0.0.1", port))
        assert reason(f"http://127.0.0.1:{port}/") == "the answer takes too long"
        for each in waiting:
            each.close()


@pytest.mark.long
def test_a_slow_name_ends_in_time_and_holds_up_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fetching, "TIMEOUT", SHORT)
    asked: list[str] = []
    over, known = threading.Event(), socket.getaddrinfo

    def slow(host: str, *more: Any, **options: Any) -> Any:
        asked.append(host)
        if host.startswith("slow"):
            over.wait(ANSWER)
            raise OSError
        return known(host, *more, **options)

    monkeypatch.setattr(socket, "getaddrinfo", slow)
    for _ in range(2):
        assert reason("https://slow.example.edu/") == "the answer takes too long"
    # The second request has waited for the first one's lookup.
    assert asked == ["slow.example.edu"]
    assert reason("https://127.0.0.1/", local=False) == "the host has a private address"
    over.set()


def test_endless_interim_responses_are_bounded() -> None:
    flood = endless(b"HTTP/1.1 102 Processing\r\n\r\n" * 1000, pause=0)
    with slow_platform(flood) as port:
        assert reason(f"http://127.0.0.1:{port}/") == "the answer is larger than 128 KiB"


def test_an_address_that_refuses_leaves_the_next_one(
    site: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    known = socket.getaddrinfo

    def two(host: str, *more: Any, **options: Any) -> Any:
        if host != "localhost":
            return known(host, *more, **options)
        return [(0, 0, 0, "", (each, 0)) for each in ("127.0.0.9", "127.0.0.1")]

    monkeypatch.setattr(socket, "getaddrinfo", two)
    there = site.replace("127.0.0.1", "localhost")
    assert fetch_json(f"{there}/right", local=True) == {"keys": []}
