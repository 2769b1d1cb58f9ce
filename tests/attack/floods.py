"""What an attacker sends. Each goes on until its time is over, and keeps what it has opened."""

import itertools
import json
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress

from tests.attack.honest import GRADE
from tests.benchmarks.server import request
from tests.server.raw import Service

HEAD = b"POST /v1/preview HTTP/1.1\r\nHost: x\r\n"
CHUNKED = HEAD + b"Transfer-Encoding: chunked\r\n\r\n"
SOURCE = "127.0.0.3"

Flood = Callable[[Service, ExitStack, float], str]


def half_open(heads: int) -> Flood:
    """So many connections with half a head, each opened again as soon as it is closed."""

    def flood(running: Service, opened: ExitStack, until: float) -> str:
        lines = [opened.enter_context(running.connect(HEAD, SOURCE)) for _ in range(heads)]
        while time.monotonic() < until:
            time.sleep(0.05)
        return f"{len(lines)} connections opened"

    return flood


def half_bodies(bodies: int) -> Flood:
    """So many connections with all of a large body but its end."""

    def flood(running: Service, opened: ExitStack, until: float) -> str:
        sent = HEAD + b"Content-Length: 260000\r\n\r\n" + b" " * 250_000
        whole = 0
        while whole < bodies and time.monotonic() < until:
            with suppress(OSError):
                opened.enter_context(running.connect(sent, SOURCE))
                whole += 1
        return f"{whole * 0.25:.0f} MB sent"

    return flood


def endless(begin: bytes, piece: bytes, megabytes: float) -> Flood:
    """The same piece again and again behind a beginning, until so much is sent or refused."""

    def flood(running: Service, opened: ExitStack, until: float) -> str:
        sent = tries = 0
        while time.monotonic() < until and sent < megabytes * 1e6:
            tries += 1
            line = opened.enter_context(running.connect(begin, SOURCE))
            line.settimeout(1.0)
            with suppress(OSError):
                while time.monotonic() < until and sent < megabytes * 1e6:
                    sent += line.send(piece)
            line.close()
        return f"{sent / 1e6:.0f} MB taken on {tries} connections"

    return flood


def dripping(lines: int) -> Flood:
    """So many bodies of which a byte comes each second."""

    def flood(running: Service, opened: ExitStack, until: float) -> str:
        sent = HEAD + b"Content-Length: 1000\r\n\r\n"
        dripping = [opened.enter_context(running.connect(sent, SOURCE)) for _ in range(lines)]
        closed: set[socket.socket] = set()
        while time.monotonic() < until:
            for line in dripping:
                try:
                    line.send(b" ")
                except OSError:
                    closed.add(line)
            time.sleep(1.0)
        return f"{len(closed)} of {lines} closed"

    return flood


def costly_bodies() -> Iterator[bytes]:
    """Submissions that each take as much work as one may, no two alike."""
    for number in itertools.count():
        cells = [
            ["//".join(["½"] * 78) + str(16 * number + 4 * i + j) for j in range(4)]
            for i in range(4)
        ]
        yield json.dumps({"answers": {"pose": cells}}).encode()


def costly(connections: int, source: str = SOURCE) -> Flood:
    """Costly submissions on so many connections, each sent as soon as the last is answered."""

    def flood(running: Service, opened: ExitStack, until: float) -> str:
        bodies, lock, answered = costly_bodies(), threading.Lock(), itertools.count()

        def attack() -> None:
            while time.monotonic() < until:
                with suppress(OSError), running.connect(b"", source) as line:
                    line.settimeout(30.0)
                    while time.monotonic() < until:
                        with lock:
                            body = next(bodies)
                        line.sendall(request(GRADE, body))
                        if not line.recv(10**6):
                            break
                        next(answered)

        threads = [threading.Thread(target=attack) for _ in range(connections)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        return f"{next(answered)} costly submissions answered"

    return flood
