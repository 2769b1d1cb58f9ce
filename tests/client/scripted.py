"""A server that sends prepared responses, and records the requests."""

import socket
import threading
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

from tests.guards import ANSWER


@dataclass(frozen=True)
class Received:
    """A received request."""

    line: str
    headers: Mapping[str, str]
    body: bytes


def http(status: int, body: str | bytes = "", **headers: str) -> bytes:
    """Return the bytes of an HTTP response."""
    content = body.encode() if isinstance(body, str) else body
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    lines = [f"{name}: {value}" for name, value in named.items()]
    head = [f"HTTP/1.1 {status} X", f"content-length: {len(content)}", "connection: close", *lines]
    return "\r\n".join(head).encode() + b"\r\n\r\n" + content


@dataclass
class Scripted:
    """A server that sends one prepared response to each request."""

    answers: list[bytes | Iterable[bytes]]
    listener: socket.socket = field(default_factory=lambda: socket.create_server(("127.0.0.1", 0)))
    requests: list[Received] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.address = f"http://127.0.0.1:{self.listener.getsockname()[1]}"

    def serve(self) -> None:
        for answer in self.answers:
            try:
                connection, _ = self.listener.accept()
            except OSError:  # closed by the test, which sent fewer requests than expected
                return
            with connection:
                connection.settimeout(ANSWER)
                self.requests.append(_received(connection))
                try:
                    for piece in [answer] if isinstance(answer, bytes) else answer:
                        connection.sendall(piece)
                except OSError:  # the client has closed the connection
                    continue


@contextmanager
def scripted(*answers: bytes | Iterable[bytes]) -> Iterator[Scripted]:
    """Run a server that sends these responses in order."""
    server = Scripted(list(answers))
    thread = threading.Thread(target=server.serve)
    thread.start()
    try:
        yield server
    finally:
        # Only a shutdown wakes the thread that waits for a connection; close does not.
        server.listener.shutdown(socket.SHUT_RDWR)
        server.listener.close()
        thread.join(ANSWER)


def _received(connection: socket.socket) -> Received:
    content = b""
    while b"\r\n\r\n" not in content:
        content += connection.recv(65536)
    head, _, body = content.partition(b"\r\n\r\n")
    line, *fields = head.decode().split("\r\n")
    headers = {name.lower(): value for name, _, value in (each.partition(": ") for each in fields)}
    while len(body) < int(headers.get("content-length", 0)):
        body += connection.recv(65536)
    return Received(line, headers, body)
