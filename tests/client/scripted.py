"""A server that answers as it is told, byte by byte, and keeps the requests that came."""

import socket
import threading
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

from tests.guards import ANSWER


@dataclass(frozen=True)
class Received:
    """A request as it came over the wire."""

    line: str
    headers: Mapping[str, str]
    body: bytes


def http(status: int, body: str | bytes = "", **headers: str) -> bytes:
    """An answer on the wire; ``retry_after`` is the header ``retry-after``."""
    content = body.encode() if isinstance(body, str) else body
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    lines = [f"{name}: {value}" for name, value in named.items()]
    head = [f"HTTP/1.1 {status} X", f"content-length: {len(content)}", "connection: close", *lines]
    return "\r\n".join(head).encode() + b"\r\n\r\n" + content


@dataclass
class Scripted:
    """The server: one answer for each request, in pieces where it is no single one."""

    answers: list[bytes | Iterable[bytes]]
    listener: socket.socket = field(default_factory=lambda: socket.create_server(("127.0.0.1", 0)))
    requests: list[Received] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.address = f"http://127.0.0.1:{self.listener.getsockname()[1]}"

    def serve(self) -> None:
        """Answer until there is no answer left, then hear nobody."""
        for answer in self.answers:
            try:
                connection, _ = self.listener.accept()
            except OSError:  # closed by the test, which sent less than was expected
                return
            with connection:
                connection.settimeout(ANSWER)
                self.requests.append(_received(connection))
                try:
                    for piece in [answer] if isinstance(answer, bytes) else answer:
                        connection.sendall(piece)
                except OSError:  # the client has heard enough
                    continue


@contextmanager
def scripted(*answers: bytes | Iterable[bytes]) -> Iterator[Scripted]:
    """A server with these answers; an empty one ends the connection without any."""
    server = Scripted(list(answers))
    thread = threading.Thread(target=server.serve)
    thread.start()
    try:
        yield server
    finally:
        # What waits for a connection is woken by its end, not by that of the file.
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
